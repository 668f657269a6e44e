"""Extensions of the ontology, in YAML, tables or OWL: read, checked, and made into statements.

What others use of it stands here. A file's way: `yaml_*`, `table_rows` or `owl_reading` read it,
`defaults` fills what it leaves out, `*_check` check it, `stack` stacks it on the files before.
"""

from afkb.extensions.sheet_graph import sheet_graph
from afkb.extensions.stack import extension_graph, extension_homes, files_behind, read_stack

__all__ = ["extension_graph", "extension_homes", "files_behind", "read_stack", "sheet_graph"]

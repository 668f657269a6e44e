"""The ontology as one page to browse, made from the ontology and its extensions."""

from afkb.reference.page import reference_page

__all__ = ["reference_page"]

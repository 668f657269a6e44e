"""The pitfalls of ontologies that can be computed, with their numbers in the OOPS! catalogue.

After Poveda-Villalón, Gómez-Pérez and Suárez-Figueroa, "OOPS! (OntOlogy Pitfall Scanner!)", 2014.
What the catalogue has no number for is marked with a dash.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from afkb.quality import pitfalls_header as header
from afkb.quality import pitfalls_hierarchy as hierarchy
from afkb.quality import pitfalls_naming as naming
from afkb.quality import pitfalls_properties as properties
from afkb.quality import pitfalls_use as use
from afkb.quality.checked import Checked
from afkb.quality.findings import Finding
from afkb.quality.pitfall import Found


@dataclass(frozen=True, slots=True)
class Pitfall:
    """A mistake that ontologies are known to have.

    `grave`: it is refused in a user's extension, too, where the others are advice.
    """

    number: str
    name: str
    grave: bool
    find: Callable[[Checked], Iterator[Found]]


PITFALLS = (
    Pitfall("P03", "a property called `is`", False, naming.is_relations),
    Pitfall("P04", "a term that nothing uses", False, use.orphans),
    Pitfall("P05", "inverse properties whose domain and range do not match", True,
            properties.wrong_inverses),
    Pitfall("P06", "a cycle in a hierarchy", True, hierarchy.cycles),
    Pitfall("P08", "no label, definition or example", False, naming.missing_annotations),
    Pitfall("P10", "no disjointness", False, hierarchy.no_disjointness),
    Pitfall("P11", "a property without domain or range", False, properties.no_domain_or_range),
    Pitfall("P12", "two properties of one label", False, naming.equal_property_labels),
    Pitfall("P19", "several domains or ranges, which all hold at once", True,
            properties.several_domains_or_ranges),
    Pitfall("P20", "label and definition mixed up", False, naming.mixed_up_annotations),
    Pitfall("P22", "a name of another style", False, naming.other_styles),
    Pitfall("P24", "a definition that defines by the term itself", False, naming.circular),
    Pitfall("P25", "a property that is its own inverse", True, properties.own_inverses),
    Pitfall("P26", "a symmetric property with an inverse", False, properties.symmetric_inverses),
    Pitfall("P32", "two terms of one label", False, naming.equal_labels),
    Pitfall("P33", "a property chain of one property", False, properties.short_chains),
    Pitfall("P34", "a class that is not declared", True, use.undeclared_classes),
    Pitfall("P35", "a property that is not declared", True, use.undeclared_properties),
    Pitfall("P36", "a file's suffix in an IRI", False, naming.file_suffixes),
    Pitfall("P38", "no ontology header", False, header.no_header),
    Pitfall("P39", "an ontology without an IRI", False, header.nameless),
    Pitfall("P40", "statements about others' terms", False, use.hijacked),
    Pitfall("P41", "no licence", False, header.no_licence),
    Pitfall("-", "no version, title, description, author or date", False, header.no_metadata),
    Pitfall("-", "a class that is disjoint with itself or with a broader one", True,
            hierarchy.self_disjoint),
    Pitfall("-", "a term that is named and not stated", True, use.unknown_terms),
    Pitfall("-", "an individual without a class", True, use.untyped),
    Pitfall("-", "a property that is never used", False, use.unused_properties),
)  # fmt: skip
"""All that are looked for, in order of number."""


def check_pitfalls(checked: Checked) -> list[Finding]:
    """What the pitfalls find about the checked terms, in order of place."""
    return sorted({f for pitfall in PITFALLS for f in findings_of(pitfall, checked)})


def findings_of(pitfall: Pitfall, checked: Checked) -> Iterator[Finding]:
    """What one pitfall finds; its number stands before what is wrong."""
    advice = not pitfall.grave and not checked.bundled
    number = f"{pitfall.number} " if pitfall.number != "-" else ""
    for found in pitfall.find(checked):
        yield checked.finding(found.term, number + found.what, found.mend, advice)

"""The knowledge base: what the ontology and its extensions state, typed and read once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

from afkb.errors import KnowledgeError
from afkb.knowledge.cache import cached, content_key, ontology_key
from afkb.knowledge.content import Content, read_content
from afkb.knowledge.facts import Facts, read_facts
from afkb.knowledge.model import (
    Afbit,
    Category,
    CoOccurrence,
    Dual,
    EvidenceClass,
    Feature,
    Measure,
    RoomCategory,
    Scale,
)
from afkb.knowledge.stated_figures import ObjectInRoom, ObjectOnSupport, ObjectWithObject
from afkb.ontology.bundled import bundled_ontology
from afkb.ontology.names import UNKNOWN_ROOM, fragment
from afkb.ontology.subjects import kinds_of

if TYPE_CHECKING:
    from afkb.figures import Figures


class AfNet:
    """AfNet/AfRob as the rest of the program sees it (paper §II.A to §II.D).

    Lazy: nothing is read before the first question; then all is, once, from a cache where the
    same files were read before. Threads may share it. `ontology` replaces the bundled file;
    `extensions` are files whose statements are added: YAML, tables, RDF/XML or Turtle. Every bad
    file, missing term or contradiction is a `KnowledgeError` that names file and line.
    """

    def __init__(self, ontology: Path | None = None, extensions: Sequence[Path] = ()) -> None:
        self._ontology = Path(ontology) if ontology is not None else None
        self._extensions = tuple(Path(p) for p in extensions)
        self._reading = Lock()

    @classmethod
    def load(cls, ontology: Path | None = None, extensions: Sequence[Path] = ()) -> AfNet:
        """The knowledge base, read and checked now rather than at the first question.

        >>> AfNet.load().categories["Mug"].scale
        'Small'
        """
        base = cls(ontology, extensions)
        _ = base._content
        return base

    def extended(self, paths: Sequence[Path]) -> AfNet:
        """A knowledge base with these files added."""
        return AfNet(self._ontology, (*self._extensions, *paths))

    @cached_property
    def files(self) -> tuple[Path, ...]:
        """The ontology file and its extensions, in the order in which they are read."""
        return (self._ontology or bundled_ontology(), *self._extensions)

    @property
    def _content(self) -> Content:
        with self._reading:
            return self._read

    @cached_property
    def _read(self) -> Content:
        return cached("content", self._key, lambda: read_content(self.files))

    @cached_property
    def _key(self) -> str:
        return ontology_key(self.files)

    @cached_property
    def _facts(self) -> Facts:
        return cached("facts", self._key, lambda: read_facts(self.files))

    @property
    def features(self) -> Mapping[str, Feature]:
        """Affordance features by name."""
        return self._content.features

    @property
    def measures(self) -> Mapping[str, Measure]:
        """What the groundings of features may measure, by the name that fuzzy ranges use."""
        return {measure.measure_name: measure for measure in self._content.measures.values()}

    @property
    def categories(self) -> Mapping[str, Category]:
        """Object categories by name, `SomethingElse` among them."""
        return self._content.categories

    @property
    def afbits(self) -> tuple[Afbit, ...]:
        """Every afbit, by category, part and feature."""
        return self._content.afbits

    @cached_property
    def rooms(self) -> Mapping[str, RoomCategory]:
        """Room categories by name, `UnknownRoom` among them; refitted to homes of extensions."""
        homes = self._homes()
        if homes is None:
            return self._content.rooms
        from afkb.knowledge.own_homes import classes_of, refitted_rooms

        counted_for = {
            name: classes_of(category, self.evidence_classes, self.features)
            for name, category in self.categories.items()
        }
        return refitted_rooms(self._content.rooms, homes, counted_for)

    @property
    def duals(self) -> tuple[Dual, ...]:
        """Affordance duals, each direction by itself, by name."""
        return self._content.duals

    @property
    def co_occurrences(self) -> tuple[CoOccurrence, ...]:
        """Co-occurrence rules and listed pairs, by name."""
        return self._content.co_occurrences

    @property
    def objects_in_rooms(self) -> tuple[ObjectInRoom, ...]:
        """How often rooms hold things, as stated, by name."""
        return self._content.objects_in_rooms

    @property
    def objects_with_objects(self) -> tuple[ObjectWithObject, ...]:
        """How often things are in a room with others, as stated, by name."""
        return self._content.objects_with_objects

    @property
    def objects_on_supports(self) -> tuple[ObjectOnSupport, ...]:
        """What things are put on, as stated, by name."""
        return self._content.objects_on_supports

    @property
    def evidence_classes(self) -> Mapping[str, EvidenceClass]:
        """What is counted to tell rooms apart, by name."""
        return self._content.evidence_classes

    @property
    def scales(self) -> Mapping[str, Scale]:
        """Scales by name, from small to large."""
        return self._content.scales

    @property
    def parameters(self) -> Mapping[str, float]:
        """Numbers that the network takes from the ontology, by name."""
        return self._content.parameters

    @cached_property
    def figures(self) -> Figures:
        """What was counted in homes: the bundled counts, and homes that extensions bring."""
        from afkb.figures import Figures

        bundled = bundled_ontology().parent / "counts"
        counts = sorted(bundled.glob("*.csv"))
        figures = cached("figures", content_key(counts), lambda: Figures.load(bundled))
        homes = self._homes()
        return figures.plus(homes) if homes else figures

    def _homes(self) -> Figures | None:
        """The figures of the homes that extensions bring, whose terms they may name."""
        from afkb.extensions import extension_homes
        from afkb.figures import Figures, Names, count_rooms

        tables = [table for file in self._extensions for table in extension_homes(file)]
        if not tables:
            return None
        tables = list(dict.fromkeys(table.resolve() for table in tables))
        names = Names.load(bundled_ontology().parent / "tables").with_labels(
            {c.name: c.label for c in self.categories.values()},
            {r.name: r.label for r in self._content.rooms.values() if r.name != UNKNOWN_ROOM},
        )
        return Figures(count_rooms(tables, names)[0])

    def scale_of(self, size_xyz: tuple[float, float, float]) -> str:
        """Name of the scale of a thing of that size, m: by its largest extent."""
        largest = max(size_xyz)
        for scale in self.scales.values():
            if scale.extent_m[0] <= largest < scale.extent_m[1]:
                return scale.name
        raise KnowledgeError(f"{self.files[0]}: no scale covers an extent of {largest} m; add one")

    def kinds_of(self, category: str) -> list[str]:
        """The category and everything broader than it, groups among them, nearest first."""
        return kinds_of(category, self._broader)

    @cached_property
    def _broader(self) -> dict[str, str]:
        return {name: category.broader or "" for name, category in self.categories.items()}

    def iri(self, name: str) -> str:
        """The full IRI of a term by its name; `KnowledgeError` for a name that nothing has."""
        found = self._content.iris.get(name)
        if found is None:
            raise KnowledgeError(f"no term named {name!r} in {', '.join(map(str, self.files))}")
        return found

    def statements_about(self, name: str) -> dict[str, list[str]]:
        """Everything stated of a term, by property: IRIs and literals as text, sorted."""
        values = self._facts.values
        subject = next((iri for iri in values if fragment(iri) == name), None)
        stated = values[subject if subject is not None else self.iri(name)]
        return {prop: sorted(values) for prop, values in sorted(stated.items())}

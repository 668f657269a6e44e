"""A small ontology in which nothing is to mend, to be broken one place at a time."""

from __future__ import annotations

from pathlib import Path

from afkb.quality.checked import Checked
from afkb.quality.findings import Finding

_PREFIXES = """@prefix : <https://w3id.org/afkb/afnet#> .
@prefix dcterms: <http://purl.org/dc/terms/> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix skos: <http://www.w3.org/2004/02/skos/core#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
<https://w3id.org/afkb/afnet> a owl:Ontology ; owl:versionIRI <https://w3id.org/afkb/afnet/1> ;
  dcterms:title "sample" ; dcterms:description "a sample" ; dcterms:creator "nobody" ;
  dcterms:created "2026-01-01" ; dcterms:modified "2026-01-01" ; rdfs:label "sample" ;
  dcterms:license <https://creativecommons.org/licenses/by/4.0/> .
skos:broader a owl:ObjectProperty .
"""
_FOREIGN = "skos:definition skos:example dcterms:source dcterms:title dcterms:description " \
    "dcterms:creator dcterms:created dcterms:modified dcterms:license"  # fmt: skip
_CLASSES = {
    "Affordance": "", "StructuralAffordance": "Affordance", "GraspAffordance": "Affordance",
    "ObjectCategory": "", "CategoryGroup": "", "RoomCategory": "", "Scale": "", "Shape": "",
    "Material": "", "Trait": "", "ObjectPart": "", "Pose": "", "Movability": "", "MovingHabit": "",
    "Trapezoid": "", "Afbit": "", "AfbitRule": "", "Relationship": "", "Dual": "Relationship",
    "CoOccurrence": "Relationship", "EvidenceClass": "", "RoomEvidence": "", "Figure": "",
    "ObjectInRoom": "Figure", "ObjectWithObject": "Figure", "ObjectOnSupport": "Figure",
    "ReportRate": "", "NetworkParameter": "", "MugEntity": "", "Measure": "",
}  # fmt: skip
_OBJECTS = """ofFeature Affordance|ofCategory ObjectCategory|ofRoom RoomCategory|scale Scale
predictedScale Scale|shape Shape|madeOf Material|hasTrait Trait|ofPart ObjectPart|pose Pose
movability Movability|moved MovingHabit|byRule AfbitRule|evidence Affordance|predicted Affordance
evidenceClass EvidenceClass|predictedClass EvidenceClass|ofEvidenceClass EvidenceClass
givenCategory ObjectCategory"""
_NUMBERS = """lengthMin lengthMax widthMin widthMax heightMin heightMax topMin topMax
massMin massMax extentMin extentMax z1 n1 n2 z2 strength distanceMean distanceSd sizeXTypical
sizeYTypical matchingWeight expectedNumber expectedCount dispersion value probability successes
trials rate evidenceBottomMin groundingStrength"""
_TEXTS = "standsOn relation parameterName groundedBy groundedOn measureName measureOf primitive"
_ANNOTATIONS = "status grounding groundingStatus observability entityClass fromRow"
_SAYS = 'rdfs:label "%s"@en ; skos:definition "What it is, said well."@en ; skos:example "one"@en'
_FROM = ':status "proposed" ; dcterms:source "nobody"@en'
_INDIVIDUALS = """
:ContainAbility a :StructuralAffordance ; SAYS ; FROM ; :grounding "a concavity"@en ;
  :groundingStatus "stated" ; :observability "direct" ; :groundedBy "detector" ;
  :groundedOn "opening" ; :groundingStrength 8.0e-1 .
:SupportAbility a :StructuralAffordance ; SAYS ; FROM ; :grounding "a flat top"@en .
:HookGrasp a :GraspAffordance ; SAYS ; FROM ; :grounding "a bar"@en ; skos:broader :SupportAbility .
:ContainAbility.depth_m a :Trapezoid ; LABEL ; FROM ; :ofFeature :ContainAbility ;
  :parameterName "depth_m" ; :z1 0.0e0 ; :n1 1.0e0 ; :n2 2.0e0 ; :z2 3.0e0 .
:DepthMeasure a :Measure ; SAYS ; FROM ; :measureName "depth_m" ; :measureOf "opening" ;
  :primitive "concavity" .
:Small a :Scale ; SAYS ; FROM ; :extentMin 0.0e0 ; :extentMax 3.5e-1 .
:Large a :Scale ; SAYS ; FROM ; :extentMin 3.5e-1 .
:RoundShape a :Shape ; SAYS ; FROM .
:Clay a :Material ; SAYS ; FROM .
:OpenTop a :Trait ; SAYS ; FROM .
:TopPart a :ObjectPart ; SAYS ; FROM ; :whole true .
:UprightPose a :Pose ; SAYS ; FROM .
:Dynamic a :Movability ; SAYS .
:Carried a :MovingHabit ; SAYS .
:Tableware a :CategoryGroup ; SAYS ; FROM .
:Mug a :ObjectCategory ; SAYS ; FROM ; :fromRow "categories/cups.csv, line 7" ;
  skos:broader :Tableware ; :entityClass :MugEntity ; :scale :Small ; :standsOn "Support" ;
  :lengthMin 8.0e-2 ; :lengthMax 1.5e-1 ; :widthMin 7.0e-2 ; :widthMax 1.1e-1 ;
  :heightMin 8.0e-2 ; :heightMax 1.2e-1 ; :topMin 1.0e-1 ; :topMax 2.0e-1 ;
  :massMin 1.0e-1 ; :massMax 5.0e-1 ; :movability :Dynamic ; :moved :Carried ;
  :matchingWeight 3.0e-1 ; :expectedNumber 4.0e0 ; :shape :RoundShape ; :madeOf :Clay ;
  :hasTrait :OpenTop .
:OpenTopContains a :AfbitRule ; SAYS ; FROM ; :ofFeature :ContainAbility ; :strength 9.0e-1 ;
  :ofPart :TopPart ; :pose :UprightPose .
:Mug.ContainAbility a :Afbit ; LABEL ; FROM ; :ofCategory :Mug ; :ofFeature :ContainAbility ;
  :strength 9.5e-1 ; :ofPart :TopPart ; :pose :UprightPose ; :scale :Small ;
  :byRule :OpenTopContains ; :reviewed false ; :independentSources 2 .
:ContainBelow a :Dual ; SAYS ; FROM ; :evidence :ContainAbility ; :predicted :SupportAbility ;
  :relation "below" ; :strength 7.0e-1 ; :evidenceBottomMin 1.5e-1 ; :distanceMean 0.0e0 ;
  :distanceSd 2.0e-1 ; :sizeXTypical 1.2e0 ; :sizeYTypical 8.0e-1 ; :predictedScale :Large ;
  :paperStrength 7.0e-1 ; :dataSuccesses 3.0e0 ; :dataTrials 4.0e0 .
:LargerNear a :CoOccurrence ; SAYS ; FROM ; :ofFeature :SupportAbility ; :strength 6.0e-1 ;
  :evidenceClass :Seats ; :predictedClass :Seats ; :predictedScale :Large .
:Seats a :EvidenceClass ; SAYS ; FROM ; :ofFeature :SupportAbility ; :topMin 3.0e-1 ;
  :topMax 5.0e-1 ; :dispersion 2.0e0 .
:Kitchen a :RoomCategory ; SAYS ; FROM ; :expectedNumber 1.0e0 .
:Kitchen.Seats a :RoomEvidence ; LABEL ; FROM ; :ofRoom :Kitchen ; :ofEvidenceClass :Seats ;
  :expectedCount 4.0e0 .
:Leak a :NetworkParameter ; SAYS ; FROM ; :value 3.0e-2 .
:Mug.Kitchen a :ObjectInRoom ; LABEL ; FROM ; :ofCategory :Mug ; :ofRoom :Kitchen ; COUNTED ;
  :meanNumber 1.5e0 .
:Mug.Mug a :ObjectWithObject ; LABEL ; FROM ; :ofCategory :Mug ; :givenCategory :Mug ; COUNTED .
:Mug.On a :ObjectOnSupport ; LABEL ; FROM ; :ofCategory :Mug ; :givenCategory :Mug ; COUNTED .
:Mug.Rate a :ReportRate ; LABEL ; FROM ; :ofCategory :Mug ; :ofFeature :HookGrasp ; :rate 1.0e-1 .
"""
_COUNTED = ":probability 5.0e-1 ; :successes 2.0e0 ; :trials 4.0e0 ; :buildings 3"


def sound() -> str:
    """The ontology as Turtle, a term a line or more, each beginning with its name."""
    lines = [_PREFIXES]
    lines += [f"{name} a owl:AnnotationProperty ." for name in _FOREIGN.split()]
    for name, parent in _CLASSES.items():
        above = f" ; rdfs:subClassOf :{parent}" if parent else ""
        lines.append(_term(name, "owl:Class", above))
    lines.append(":Affordance owl:disjointWith :ObjectCategory .")
    for name, reach in (pair.split() for pair in _OBJECTS.replace("\n", "|").split("|")):
        lines.append(_property(name, "owl:ObjectProperty", f":{reach}"))
    more = dict.fromkeys(f"{_NUMBERS} meanNumber paperStrength".split(), "xsd:double")
    more |= {"dataSuccesses": "xsd:double", "dataTrials": "xsd:double"}
    more |= dict.fromkeys(_TEXTS.split(), "xsd:string")
    more |= {"whole": "xsd:boolean", "reviewed": "xsd:boolean"}
    more |= {"independentSources": "xsd:integer", "buildings": "xsd:integer"}
    lines += [_property(name, "owl:DatatypeProperty", reach) for name, reach in more.items()]
    lines += [_term(name, "owl:AnnotationProperty", "") for name in _ANNOTATIONS.split()]
    return "\n".join(lines) + _individuals()


def _individuals() -> str:
    lines = []
    for line in _INDIVIDUALS.splitlines():
        name = line.split(" ", 1)[0].removeprefix(":")
        text = line.replace("SAYS", _SAYS % f"{name} as such").replace("FROM", _FROM)
        text = text.replace("LABEL", f'rdfs:label "{name} as such"@en')
        lines.append(text.replace("COUNTED", _COUNTED))
    return "\n".join(lines) + "\n"


def _term(name: str, kind: str, more: str) -> str:
    return f":{name} a {kind}{more} ; {_SAYS % name} ."


def _property(name: str, kind: str, reach: str) -> str:
    return _term(name, kind, f" ; rdfs:domain owl:Thing ; rdfs:range {reach}")


def broken(folder: Path, old: str, new: str) -> Checked:
    """The ontology with one place changed; an empty `old` adds `new` at the end."""
    text = sound()
    assert not old or text.count(old) == 1, f"{old!r} is there {text.count(old)} times"
    path = folder / "sample.ttl"
    path.write_text(text.replace(old, new) if old else f"{text}{new}\n", encoding="utf-8")
    return Checked.of_files([path])


def told(findings: list[Finding]) -> str:
    """The findings as the command prints them, a line each."""
    return "\n".join(map(str, findings))

"""A feature that an extension adds, with a grounding and no code, is seen and mapped."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from running import ROOT, run_afkb, run_document

pytestmark = pytest.mark.xdist_group("examples")
FOLDER = ROOT / "examples" / "own_feature"
STEPS = ("--ontology", str(FOLDER / "steps.yaml"))
STOOL_XYZ = (2.6 - 0.6, 2.4 - 1.7, 0.24)
"""In the world file; the map's origin is the first base pose (0.6, 1.7)."""


def test_only_what_is_low_and_level_affords_a_step(tmp_path: Path) -> None:
    run_document("examples/own_feature/README.md", tmp_path)
    asked = ("--file", str(FOLDER / "steps.rq"), *STEPS, "--format", "json")
    (row,) = json.loads(run_afkb("query", "pantry", *asked, cwd=tmp_path))["results"]["bindings"]
    found = tuple(float(row[axis]["value"]) for axis in "xyz")
    assert found == pytest.approx(STOOL_XYZ, abs=0.06)


def test_its_grounding_is_shown() -> None:
    shown = json.loads(run_afkb("ontology", "show", "StepAbility", *STEPS, "--json", cwd=FOLDER))
    assert "height_m: 0 up to 0.08, 1 from 0.12 to 0.3, 0 from 0.4 m" in shown["measures"]

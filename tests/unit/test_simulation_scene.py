"""Whole places from mesh files: scene graphs, axes, units, and what is no place at all.

The files are written by trimesh's exporters.
"""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from afkb.errors import SourceError
from afkb.flow import View
from afkb.testing import check_source
from afkb_simulation.source import open_world

WORLD = """
name: scanned
scene: {{file: {file}{more}}}
robot:
  camera: {{width: 64, height: 48, height_m: 1.0, pitch_down_deg: 0}}
  laser: {{beams: 36}}
sensor_noise: {{axial_m: 0, axial_per_m2: 0, disparity_step_px: 0, edge_dropout: 0, laser_m: 0}}
tour:
  waypoints:
    - {{name: here, at: [0.5, 0], yaw_deg: {yaw}}}
"""
Z_TO_Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def room(unit: float = 1.0, y_up: bool = True) -> trimesh.Scene:
    """A room 6 m (x) by 4 m (y) by 2.5 m around the origin, as a graph.

    A box by its x = 3 wall, whose node is moved by a parent node; a low bench; a post 0.3 m thick.
    """
    scene = trimesh.Scene()
    shell = trimesh.creation.box((6, 4, 2.5))
    shell.apply_translation((0, 0, 1.25))
    box = trimesh.creation.box((1, 1, 1.6))
    up = Z_TO_Y_UP if y_up else np.eye(4)
    up = up @ np.diag([1 / unit, 1 / unit, 1 / unit, 1.0])
    scene.graph.update(frame_to="furniture", matrix=up @ _moved(2.5, 0, 0.8))
    scene.add_geometry(shell, node_name="shell", transform=up)
    scene.add_geometry(box, node_name="box", parent_node_name="furniture")
    for size, at in (((1, 1, 0.45), (2.5, -1.4, 0.225)), ((0.3, 0.3, 2), (0, 1.5, 1))):
        scene.add_geometry(trimesh.creation.box(size), transform=up @ _moved(*at))
    return scene


def _moved(x: float, y: float, z: float) -> np.ndarray:
    T = np.eye(4)
    T[:3, 3] = x, y, z
    return T


def world(folder: Path, file: str, more: str = "", yaw: float = 0) -> str:
    path = folder / "place.world.yaml"
    path.write_text(WORLD.format(file=file, more=more, yaw=yaw))
    return str(path)


def refusal(uri: str) -> str:
    with pytest.raises(SourceError) as refused:
        open_world(uri)
    assert "\n" not in str(refused.value)
    return str(refused.value)


def ahead(uri: str) -> float:
    """Depth at the image's middle from (0.5, 0), 0.1 m before the robot's middle."""
    (view,) = list(open_world(uri).views())[-1:]
    assert isinstance(view, View)
    assert view.depth_m is not None
    return float(view.depth_m[24, 32])


@pytest.mark.parametrize(
    ("file", "more", "unit", "y_up"),
    [
        ("place.glb", "", 1.0, True),
        ("place.gltf", "", 1.0, True),
        ("place.glb", ", up: z", 1.0, False),
        ("place.obj", "", 1.0, False),
        ("place.obj", ", up: y, unit_m: 0.01", 0.01, True),
        ("place.ply", ", unit_m: 0.0254", 0.0254, False),
        ("place.stl", "", 1.0, False),
    ],
)
def test_scene_is_where_its_graph_puts_it(
    tmp_path: Path, file: str, more: str, unit: float, y_up: bool
) -> None:
    """The box's face is at x = 2, the wall behind the robot at x = -3."""
    scene = room(unit, y_up)
    if file.endswith(".gltf"):
        for name, data in trimesh.exchange.gltf.export_gltf(scene).items():
            (tmp_path / name.replace("model.gltf", file)).write_bytes(data)
    elif file.endswith((".ply", ".stl")):
        scene.to_mesh().export(tmp_path / file)
    else:
        scene.export(tmp_path / file)
    assert ahead(world(tmp_path, file, more)) == pytest.approx(2 - 0.6, abs=0.01)
    assert ahead(world(tmp_path, file, more, yaw=180)) == pytest.approx(0.4 + 3, abs=0.01)


def test_scene_can_be_turned_moved_and_lowered(tmp_path: Path) -> None:
    raised = room()
    raised.apply_transform(_moved(0, 0.7, 0))  # y is up
    raised.export(tmp_path / "place.glb")
    uri = world(tmp_path, "place.glb", ", floor_m: 0.7, yaw_deg: 90, at: [0.5, 1.0]", yaw=90)
    assert ahead(uri) == pytest.approx(1 + 2 - 0.1, abs=0.01)


def test_scene_keeps_the_contract_of_a_source(tmp_path: Path) -> None:
    room().export(tmp_path / "place.glb")
    check_source(open_world(world(tmp_path, "place.glb")))


def test_things_stand_in_a_scene(tmp_path: Path) -> None:
    room().export(tmp_path / "place.glb")
    uri = world(tmp_path, "place.glb")
    things = (
        "things: [{name: screen, shape: block, category: Box, at: [1.5, 0], size: [0.2, 1, 2]}]"
    )
    Path(uri).write_text(Path(uri).read_text() + things)
    assert ahead(uri) == pytest.approx(1.4 - 0.6, abs=0.01)


@pytest.mark.parametrize(
    ("more", "yaw", "why"),
    [
        (", unit_m: 0.001", 0, "measures 0.006 x 0.004 x 0.0025 m; set scene.unit_m"),
        (", unit_m: 100", 0, "measures 600 x 400 x 250 m"),
        (", up: z", 0, "the floor is at"),
        (", floor_m: 1.2", 0, "the floor is at -1.20 m under (0.50, 0.00)"),
        (", at: [50, 0]", 0, "there is no floor under (0.50, 0.00)"),
        (", at: [-2, 1.4]", 0, "the floor is at 0.45 m under (0.50, 0.00)"),
        (", at: [0.5, -1.5]", 0, "runs into the mesh at (0.50, 0.00)"),
        (", size: 3", 0, "scene.size: no such key"),
        (", up: x", 0, "scene.up"),
    ],
)
def test_what_is_no_place_for_the_robot_is_refused(
    tmp_path: Path, more: str, yaw: float, why: str
) -> None:
    room().export(tmp_path / "place.glb")
    assert why in refusal(world(tmp_path, "place.glb", more, yaw))


def test_unreadable_files_are_refused(tmp_path: Path) -> None:
    assert "no mesh file" in refusal(world(tmp_path, "absent.glb"))
    for name, content in (("bad.glb", b"glTF"), ("bad.obj", b"v 0 0 0\n"), ("bad.xyzzy", b"1 2 3")):
        (tmp_path / name).write_bytes(content)
        refused = refusal(world(tmp_path, name))
        assert name in refused
        assert "scene.file" in refused


def test_compressed_meshes_are_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Draco's corners are none that trimesh can read without its decoder."""
    name = "KHR_draco_mesh_compression"
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    compressed = {name: {"bufferView": 0, "attributes": {"POSITION": 0}}}
    data = "data:application/octet-stream;base64,RFJBQ08CAgEBAAAAAAAAAAAA"
    content = {
        "asset": {"version": "2.0"},
        "extensionsUsed": [name],
        "extensionsRequired": [name],
        "buffers": [{"uri": data, "byteLength": 18}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 18}],
        "accessors": [
            {"componentType": 5126, "count": 3, "type": "VEC3"},
            {"componentType": 5123, "count": 3, "type": "SCALAR"},
        ],
        "meshes": [{"primitives": [primitive | {"extensions": compressed}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    (tmp_path / "small.gltf").write_text(json.dumps(content))
    assert "export it without compression" in refusal(world(tmp_path, "small.gltf"))
    assert not capsys.readouterr().err


def test_a_world_is_somewhere(tmp_path: Path) -> None:
    path = tmp_path / "no.world.yaml"
    path.write_text("name: no\ntour: {waypoints: [{name: a, at: [0, 0], yaw_deg: 0}]}\n")
    assert "a world needs rooms, or a scene" in refusal(str(path))


def test_a_gltf_thing_stands_upright(tmp_path: Path) -> None:
    """glTF's y is up: a thing 0.4 m wide and 1.6 m tall stays so."""
    tall = trimesh.creation.box((0.4, 1.6, 0.4))
    tall.export(tmp_path / "tall.glb")
    path = tmp_path / "home.world.yaml"
    path.write_text(
        "name: home\nrooms: [{name: r, category: Kitchen, rectangle: [0, 0, 4, 4]}]\n"
        "things: [{name: it, shape: mesh, file: tall.glb, category: It, at: [3, 2]}]\n"
        "tour: {waypoints: [{name: a, at: [1, 2], yaw_deg: 0}]}\n"
    )
    from afkb_simulation.truth import load_truth

    assert load_truth(str(path)).things["it"].box.size_xyz == pytest.approx((0.4, 0.4, 1.6))

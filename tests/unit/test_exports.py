"""Each format, read back by the tool that it is for."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import cv2
import networkx as nx
import numpy as np
import pytest
import yaml
from typer.testing import CliRunner, Result

from afkb.cli.app import build_cli
from afkb.errors import MapError, PluginError
from afkb.flow import NodeKind
from afkb.plugins.host import PluginHost
from afkb.store import load, write_map
from afkb_geojson.anchor import Anchor
from afkb_mapping.exporting.export import export_map, formats
from afkb_mapping.grid.map_server import IMAGE, SETTINGS
from afkb_nav2.exporter import Nav2Exporter
from store_samples import Names, entity, sample_map

HOST = PluginHost()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The sample home as a map folder."""
    out = tmp_path_factory.mktemp("maps") / "home"
    return write_map(out, sample_map(), {"parameters": {"stride": 1}}, [Nav2Exporter()], Names())


def exported(folder: Path, out: Path, to: str, **options: str) -> list[Path]:
    return export_map(folder, to, out, options, host=HOST)


def test_graphml_is_read_by_networkx_with_every_node_and_edge(folder: Path, tmp_path: Path) -> None:
    (file,) = exported(folder, tmp_path / "home.graphml", "graphml")
    graph = nx.read_graphml(file)
    assert set(graph) == {*("p1", "p2", "n1", "n2", "n3", "n10", "b1", "d1", "room1", "room2")}
    assert graph.nodes["n3"]["predicted"] is True and graph.nodes["n1"]["predicted"] is False
    assert graph.nodes["n2"]["category"] == "Mug" and graph.nodes["n2"]["supported_by"] == "n1"
    assert graph.edges["p1", "p2"]["distance"] == 1.4142
    assert graph.edges["p2", "n1"]["linkage_angle"] == 0.785
    assert graph.edges["n3", "n2"]["relation"] == "predicted_from"
    assert nx.shortest_path_length(graph, "p1", "n1", weight="distance") == pytest.approx(2.4142)


def test_the_papers_form_has_places_only_and_the_grid(folder: Path, tmp_path: Path) -> None:
    files = exported(folder, tmp_path / "paper", "paper")
    assert [f.name for f in files] == ["places.graphml", IMAGE, SETTINGS]
    graph = nx.read_graphml(files[0])
    assert set(graph) == {"p1", "p2"} and graph.edges["p1", "p2"]["relation"] == "path"
    assert (folder / IMAGE).read_bytes() == files[1].read_bytes()


def test_nav2_writes_again_what_the_map_folder_holds(folder: Path, tmp_path: Path) -> None:
    for file in exported(folder, tmp_path / "nav2", "nav2"):
        assert file.read_bytes() == (folder / file.name).read_bytes()


def test_nav2_is_read_by_an_image_library_as_map_server_scales_it(
    folder: Path, tmp_path: Path
) -> None:
    image, settings = exported(folder, tmp_path / "nav2", "nav2")
    told = yaml.safe_load(settings.read_text())
    grey = cv2.imread(str(image), cv2.IMREAD_UNCHANGED).astype(float)
    occupied = (255 - grey) / 255 if not told["negate"] else grey / 255
    cost = np.clip(
        100 * (occupied - told["free_thresh"]) / (told["occupied_thresh"] - told["free_thresh"]),
        0,
        100,
    )[::-1]
    grid = sample_map().grid
    known = np.isfinite(grid.probability)
    assert told["mode"] == "scale" and told["resolution"] == pytest.approx(grid.resolution_m)
    assert told["origin"][:2] == pytest.approx(list(grid.origin_xy))
    assert (grey[::-1][~known] == 128).all() and not (grey[::-1][known] == 128).any()
    assert (cost[known & (grid.probability > told["occupied_thresh"])] == 100).all()
    assert (cost[known & (grid.probability < told["free_thresh"] - 1 / 255)] == 0).all()


def test_spark_dsg_loads_layers_labels_boxes_and_what_is_predicted(
    folder: Path, tmp_path: Path
) -> None:
    spark_dsg = pytest.importorskip("spark_dsg")
    (file,) = exported(folder, tmp_path / "home.json", "spark-dsg")
    graph = spark_dsg.DynamicSceneGraph.load(str(file))
    counts = {key: graph.get_layer(key).num_nodes() for key in (2, 3, 4, 5)}
    assert counts == {2: 4, 3: 2, 4: 2, 5: 1}
    things = {n.attributes.metadata.get()["id"]: n for n in graph.get_layer(2).nodes}
    assert {i: n.attributes.is_predicted for i, n in things.items()} == {
        **dict.fromkeys(("n1", "n2", "n10"), False),
        "n3": True,
    }
    assert things["n3"].attributes.metadata.get()["predicted_from"] == ["n2"]
    labels = graph.get_labelspace(2, 0).labels_to_names
    mug = things["n2"].attributes
    assert (mug.name, labels[mug.semantic_label]) == ("Mug", "Mug")
    table = things["n1"].attributes.bounding_box
    np.testing.assert_allclose(table.dimensions, [1.2, 0.8, 0.73], atol=1e-6)
    np.testing.assert_allclose(table.world_P_center, [2, 1, 0.365], atol=1e-6)
    turn = np.asarray(table.world_R_center)
    assert math.atan2(turn[1, 0], turn[0, 0]) == pytest.approx(0.1, abs=1e-6)


def test_spark_dsg_finds_the_hierarchy_and_the_ways(folder: Path, tmp_path: Path) -> None:
    spark_dsg = pytest.importorskip("spark_dsg")
    (file,) = exported(folder, tmp_path / "home.json", "spark-dsg")
    graph = spark_dsg.DynamicSceneGraph.load(str(file))
    named = {n.attributes.metadata.get().get("id", "building"): n for n in graph.nodes}
    ids = {n.id.value: name for name, n in named.items()}
    parents = {name: {ids[p] for p in n.parents()} for name, n in named.items()}
    assert parents["n1"] == {"p2"} and parents["p1"] == {"room1"}
    assert parents["room1"] == parents["room2"] == {"building"}
    way = graph.get_edge(named["p1"].id.value, named["p2"].id.value).info
    assert way.weighted and way.weight == pytest.approx(1.4142)
    assert graph.has_edge(named["n2"].id.value, named["n1"].id.value)


def test_geojson_is_read_by_gdal_in_metres_of_the_map(folder: Path, tmp_path: Path) -> None:
    pyogrio = pytest.importorskip("pyogrio")
    import shapely

    (file,) = exported(folder, tmp_path / "home.geojson", "geojson")
    told = pyogrio.read_info(file)
    assert told["features"] == 11 and "map frame of a robot" in told["crs"]
    meta, _, wkb, fields = pyogrio.raw.read(file)
    columns = dict(zip(meta["fields"], fields, strict=True))
    shapes = dict(zip(columns["id"], shapely.from_wkb(wkb), strict=True))
    assert shapely.is_valid(list(shapes.values())).all()
    assert shapes["n1"].area == pytest.approx(1.0) and shapes["n1"].centroid.coords[0] == (2, 1)
    assert shapes["n2"].area == pytest.approx(0.09 * 0.08, rel=2e-3)  # told to 0.1 mm
    assert shapes["d1"].length == pytest.approx(0.9)
    assert {shapes["d1"].coords[0][0], shapes["d1"].coords[1][0]} == {3.5}
    kinds = dict(zip(columns["id"], columns["kind"], strict=True))
    assert kinds["n3"] == NodeKind.CO_OCCURRENCE.value and kinds["e1"] == "Way"


def test_rings_of_geojson_run_counter_clockwise(folder: Path, tmp_path: Path) -> None:
    (file,) = exported(folder, tmp_path / "home.geojson", "geojson")
    for feature in json.loads(file.read_text())["features"]:
        if feature["geometry"]["type"] == "Polygon":
            (ring,) = feature["geometry"]["coordinates"]
            turned = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(ring))
            assert turned > 0 and ring[0] == ring[-1]


def test_an_anchor_places_the_map_on_earth(folder: Path, tmp_path: Path) -> None:
    (file,) = exported(folder, tmp_path / "there.geojson", "geojson", anchor="48.15,11.58,90")
    whole = json.loads(file.read_text())
    assert "crs" not in whole
    at = {f["id"]: f["geometry"]["coordinates"] for f in whole["features"]}
    assert at["p1"] == [11.58, 48.15]
    lon, lat = at["p2"]
    # One metre ahead is one to the east here, one to the left one to the north.
    assert (lat - 48.15) * 111_200 == pytest.approx(1.0, rel=1e-3)
    assert (lon - 11.58) * 111_200 * math.cos(math.radians(48.15)) == pytest.approx(1.0, rel=5e-3)


def ecef(lat_deg: float, lon_deg: float) -> np.ndarray:
    """Position on the ellipsoid of WGS 84, m, by its definition."""
    lat, lon, e2 = math.radians(lat_deg), math.radians(lon_deg), 6.69437999014e-3
    n = 6378137.0 / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    flat = n * math.cos(lat)
    return np.array([flat * math.cos(lon), flat * math.sin(lon), n * (1 - e2) * math.sin(lat)])


@pytest.mark.parametrize("latitude", [-70.0, 0.0, 48.15, 70.0])
def test_anchored_positions_are_right_to_millimetres(latitude: float) -> None:
    """Against the ellipsoid itself: east and north in the plane that touches it at the anchor."""
    longitude, heading, (x, y) = 179.9999, math.radians(30), (60.0, -80.0)
    lon, lat = Anchor(latitude, longitude, 30.0).lon_lat(x, y)
    assert -180 <= lon <= 180
    away = ecef(lat, lon) - ecef(latitude, longitude)
    a, b = math.radians(latitude), math.radians(longitude)
    east = np.array([-math.sin(b), math.cos(b), 0])
    north = np.array([-math.sin(a) * math.cos(b), -math.sin(a) * math.sin(b), math.cos(a)])
    # x is 30 degrees to the east of north, y a quarter turn to its left.
    forward = math.sin(heading) * east + math.cos(heading) * north
    left = math.sin(heading) * north - math.cos(heading) * east
    assert [away @ forward, away @ left] == pytest.approx([x, y], abs=0.003)


@pytest.mark.parametrize("wrong", ["48.15,11.58", "95,0,0", "a,b,c", "nan,0,0"])
def test_an_anchor_that_is_none_is_refused_in_one_line(
    folder: Path, tmp_path: Path, wrong: str
) -> None:
    with pytest.raises(PluginError, match="anchor") as told:
        exported(folder, tmp_path / "x", "geojson", anchor=wrong)
    assert "\n" not in str(told.value) and not list(tmp_path.iterdir())


def test_turtle_is_the_scene_as_it_is_stored(folder: Path, tmp_path: Path) -> None:
    (file,) = exported(folder, tmp_path / "home.ttl", "turtle")
    assert file.read_bytes() == (folder / "scene.ttl").read_bytes()


def test_json_ld_tells_rdflib_and_oxigraph_the_same_as_the_scene(
    folder: Path, tmp_path: Path
) -> None:
    import pyoxigraph
    import rdflib
    from rdflib.compare import isomorphic

    (file,) = exported(folder, tmp_path / "home.jsonld", "json-ld")
    scene = rdflib.Graph().parse(folder / "scene.ttl")
    assert isomorphic(scene, rdflib.Graph().parse(file, format="json-ld"))
    read = list(pyoxigraph.parse(path=file, format=pyoxigraph.RdfFormat.JSON_LD))
    assert len(read) == len(scene)
    mug = next(t for t in json.loads(file.read_text())["@graph"] if t["@id"] == "scene:n2")
    assert (mug["x"], mug["observations"], mug["supportedBy"]) == (2.1, 4, "scene:n1")


def test_csv_tables_are_what_their_description_says(folder: Path, tmp_path: Path) -> None:
    files = exported(folder, tmp_path / "tables", "csv")
    package = json.loads(files[0].read_text())
    assert {f.name for f in files[1:]} == {r["path"] for r in package["resources"]}
    read = {"number": float, "integer": int, "string": str, "boolean": {"true": 1, "false": 0}.get}
    rows = {}
    for resource in package["resources"]:
        fields = resource["schema"]["fields"]
        with (tmp_path / "tables" / resource["path"]).open(newline="") as file:
            rows[resource["name"]] = list(csv.DictReader(file))
        for row in rows[resource["name"]]:
            assert list(row) == [field["name"] for field in fields]
            for field in fields:
                text = row[field["name"]]
                assert text == "" or read[field["type"]](text) is not None
    assert len(rows["things"]) == 4 and len(rows["edges"]) == 3
    things = {row["id"]: row for row in rows["things"]}
    assert things["n2"]["category"] == "Mug" and float(things["n2"]["z"]) == 0.78
    assert things["n10"]["room"] == "" and things["n3"]["predicted"] == "true"
    beliefs = [(r["name"], float(r["probability"])) for r in rows["beliefs"] if r["node"] == "n2"]
    assert ("Mug", 0.6) in beliefs and ("GraspAbility", 0.4) in beliefs
    assert [r["kind"] for r in rows["history"] if r["node"] == "n4"] == ["Predicted", "Confirmed"]


def test_every_format_says_what_it_is() -> None:
    found = {f.name: f for f in formats(HOST)}
    assert {"csv", "geojson", "graphml", "json-ld", "nav2", "paper", "spark-dsg", "turtle"} <= {
        *found
    }
    assert all(f.what for f in found.values()) and "anchor" in found["geojson"].options


def test_nothing_is_replaced_unless_told(folder: Path, tmp_path: Path) -> None:
    target = tmp_path / "home.ttl"
    target.write_text("mine")
    with pytest.raises(MapError, match="is there already"):
        export_map(folder, "turtle", target, host=HOST)
    assert target.read_text() == "mine"
    export_map(folder, "turtle", target, force=True, host=HOST)
    assert target.read_bytes() == (folder / "scene.ttl").read_bytes()
    assert [p.name for p in tmp_path.iterdir()] == ["home.ttl"]


def test_several_files_keep_what_else_is_in_the_folder(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "my-notes.txt").write_text("mine")
    exported(folder, tmp_path, "paper")
    assert {p.name for p in tmp_path.iterdir()} == {
        "my-notes.txt",
        "places.graphml",
        IMAGE,
        SETTINGS,
    }
    (tmp_path / IMAGE).unlink()
    with pytest.raises(MapError, match=r"places.graphml: is there already"):
        exported(folder, tmp_path, "paper")
    assert not (tmp_path / IMAGE).exists()


def test_a_file_goes_into_a_folder_that_is_there_under_the_maps_name(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert exported(folder, tmp_path, "spark-dsg") == [tmp_path / "home.dsg.json"]
    monkeypatch.chdir(tmp_path)
    assert export_map(folder, "csv", host=HOST)[0] == tmp_path / "home-csv" / "datapackage.json"


def command(*arguments: object) -> Result:
    return CliRunner().invoke(build_cli(HOST), ["export", *map(str, arguments)])


def test_what_was_seen_is_not_predicted_though_it_follows_from_others(tmp_path: Path) -> None:
    spark_dsg = pytest.importorskip("spark_dsg")
    mug, table = (entity(i, predicted_from=f) for i, f in (("n2", ()), ("n1", ("n2",))))
    whole = replace(sample_map(), entities=(table, mug), past_predictions=(), edges=())
    folder = write_map(tmp_path / "m", whole, {}, [Nav2Exporter()], Names())
    (file,) = exported(folder, tmp_path / "m.json", "spark-dsg")
    scene = spark_dsg.DynamicSceneGraph.load(str(file))
    assert not any(n.attributes.is_predicted for n in scene.get_layer(2).nodes)
    (file,) = exported(folder, tmp_path / "m.graphml", "graphml")
    graph = nx.read_graphml(file)
    assert graph.nodes["n1"]["predicted"] is False
    assert graph.edges["n1", "n2"]["relation"] == "predicted_from"


def test_the_command_writes_lists_and_refuses(folder: Path, tmp_path: Path) -> None:
    done = command(folder, "--to", "csv", "--out", tmp_path / "t", "--json")
    told = json.loads(done.stdout)
    assert done.exit_code == 0 and told["format"] == "csv"
    assert all(Path(f["file"]).stat().st_size == f["bytes"] for f in told["files"])
    listed = json.loads(command("--list", "--json").stdout)
    assert [f["name"] for f in listed] == sorted(f["name"] for f in listed)
    assert command(folder).exit_code == 2
    for wrong in (("--to", "kml"), ("--to", "csv", "--out", tmp_path / "t"), ("--to", "x", "a=b")):
        refused = command(folder, *wrong)
        assert refused.exit_code in (1, 2) and "Traceback" not in refused.output
    assert refused.exit_code == 2


class Failing:
    """Fails."""

    name, in_map_folder = "failing", False

    def export(self, topological_map: object, folder: Path, run: object) -> list[Path]:
        (folder / "half").write_text("half")
        raise ZeroDivisionError("by zero")


def test_bad_input_gets_one_line_and_leaves_nothing(folder: Path, tmp_path: Path) -> None:
    from afkb.plugins import hookimpl

    class Plugin:
        @hookimpl
        def afkb_exporters(self, knowledge_base: object) -> list[Failing]:
            return [Failing()]

    host = PluginHost()
    host.register(Plugin(), name="failing")
    with pytest.raises(PluginError, match="exporter 'failing' failed with ZeroDivisionError"):
        export_map(folder, "failing", tmp_path / "x", host=host)
    with pytest.raises(PluginError, match="no exporter named 'kml'"):
        export_map(folder, "kml", tmp_path / "x", host=host)
    with pytest.raises(PluginError, match="takes no options"):
        export_map(folder, "csv", tmp_path / "x", {"a": "b"}, host=host)
    with pytest.raises(MapError, match="can't write the export"):
        export_map(folder, "turtle", "/proc/here/x.ttl", host=host)
    with pytest.raises(MapError, match="no such map"):
        export_map(tmp_path / "nowhere", "csv", tmp_path / "x", host=host)
    assert not list(tmp_path.iterdir())


def test_a_map_of_nothing_is_written_in_every_format(tmp_path: Path) -> None:
    names = ("places", "entities", "bounds", "doorways", "rooms", "edges", "closures")
    empty = replace(sample_map(), past_predictions=(), loops=(), **dict.fromkeys(names, ()))
    folder = write_map(tmp_path / "empty", empty, {}, [Nav2Exporter()], Names())
    assert not load(folder).kinds["Room"]
    for number, format_ in enumerate(formats(HOST)):
        if format_.name != "report":
            (tmp_path / str(number)).mkdir()
            assert export_map(folder, format_.name, tmp_path / str(number), host=HOST)


def test_a_folder_in_the_way_of_the_last_file_leaves_the_first_alone(
    folder: Path, tmp_path: Path
) -> None:
    files = exported(folder, tmp_path / "tables", "csv")
    first, last = min(files), max(files)
    first.write_text("mine")
    last.unlink()
    last.mkdir()
    with pytest.raises(MapError, match="is a folder"):
        export_map(folder, "csv", tmp_path / "tables", force=True, host=HOST)
    assert first.read_text() == "mine"

"""Nodes and edges in the form that spark_dsg saves them; every field that it reads is there."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from afkb.flow import Entity, RobotPlace, Room
from afkb_mapping.exporting.describing import NO_ROOM_CATEGORY, box_of, is_predicted, likeliest

Json = dict[str, Any]
Triple = Sequence[float]

OBJECTS, PLACES, ROOMS, BUILDINGS = 2, 3, 4, 5
"""Layers of a scene graph, as spark_dsg numbers them."""
NO_LABEL = 2**32 - 1
_GREY, _BLUE = (128, 128, 128), (70, 130, 220)
"""Colours of what is seen and of what is only expected."""


def symbol(letter: str, number: int) -> int:
    """spark_dsg's id of a node: a letter in the highest byte, a number in the others.

    >>> symbol("O", 3)
    5692549928996306947
    """
    return (ord(letter) << 56) + number


def object_json(id_: int, entity: Entity, labels: Sequence[str]) -> Json:
    """A thing; `labels`: the label space of objects."""
    box = box_of(entity)
    category = likeliest(entity.category_belief)
    colour = _BLUE if is_predicted(entity) else _GREY
    told = _semantic(entity.position_xyz, category, labels.index(category), colour)
    told |= {
        "type": "ObjectNodeAttributes",
        "is_predicted": is_predicted(entity),
        "last_update_time_ns": _nanoseconds(entity.last_seen),
        "bounding_box": _box(box.center_xyz, box.size_xyz, box.yaw),
        "mesh_connections": [],
        "registered": True,
        "world_R_object": _turn(entity.yaw),
        "metadata": {
            "id": entity.id,
            "kind": entity.kind.value,
            "predicted": is_predicted(entity),
            "predicted_from": list(entity.predicted_from),
            "existence": entity.existence,
            "movability": entity.movability,
            "affordances": dict(entity.affordances),
            "belief": dict(entity.category_belief),
        },
    }
    return _node(id_, OBJECTS, told)


def place_json(id_: int, place: RobotPlace) -> Json:
    """A place of the robot."""
    told = _semantic((place.x, place.y, 0.0), place.id, NO_LABEL, _GREY)
    told |= {
        "type": "PlaceNodeAttributes",
        "last_update_time_ns": _nanoseconds(place.stamp),
        "orientation": _turn(place.yaw),
        "distance": 0.0,
        "frontier_scale": [0.0, 0.0, 0.0],
        "real_place": True,
        "num_basis_points": 0,
        "num_frontier_voxels": 0,
        "metadata": {"id": place.id, "kind": "RobotPlace", "yaw": place.yaw},
    }
    flags = ("active_frontier", "anti_frontier", "need_cleanup")
    told |= dict.fromkeys(flags, False)
    lists = ("deformation_connections", "mesh_vertex_labels")
    told |= {name: [] for name in lists}
    told |= {name: [] for name in ("pcl_mesh_connections", "voxblox_mesh_connections")}
    return _node(id_, PLACES, told)


def room_json(id_: int, room: Room, kinds: Sequence[str]) -> Json:
    """A room, with the box around its outline; how high it is, a map does not tell."""
    category = likeliest(room.belief, NO_ROOM_CATEGORY)
    told = _semantic((room.x, room.y, 0.0), category, kinds.index(category), _GREY)
    told |= {
        "type": "RoomNodeAttributes",
        "bounding_box": _around([room]),
        "semantic_class_probabilities": {},
        "metadata": {
            "id": room.id,
            "kind": "Room",
            "area": room.area,
            "polygon": np.asarray(room.polygon_xy).tolist(),
            "belief": dict(room.belief),
        },
    }
    return _node(id_, ROOMS, told)


def building_json(id_: int, rooms: Sequence[Room]) -> Json:
    """The building that all rooms are in."""
    middle = np.mean([(r.x, r.y, 0.0) for r in rooms], axis=0) if rooms else np.zeros(3)
    told = _semantic(middle.tolist(), "Building", NO_LABEL, _GREY)
    told |= {"type": "SemanticNodeAttributes", "bounding_box": _around(rooms)}
    return _node(id_, BUILDINGS, told)


def edge_json(source: int, target: int, weight_m: float | None, told: Mapping[str, Any]) -> Json:
    """An edge; one with a length is weighted by it."""
    return {
        "source": source,
        "target": target,
        "info": {
            "type": "EdgeAttributes",
            "weighted": weight_m is not None,
            "weight": 1.0 if weight_m is None else weight_m,
            "metadata": {k: v for k, v in told.items() if v is not None},
        },
    }


def _node(id_: int, layer: int, attributes: Json) -> Json:
    return {"id": id_, "layer": layer, "partition": 0, "attributes": attributes}


def _semantic(xyz: Triple, name: str, label: int, colour: tuple[int, int, int]) -> Json:
    red, green, blue = colour
    return {
        "position": [float(v) for v in xyz],
        "last_update_time_ns": 0,
        "is_active": False,
        "is_predicted": False,
        "metadata": {},
        "name": name,
        "color": {"r": red, "g": green, "b": blue, "a": 255},
        "bounding_box": _box((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), None),
        "semantic_label": label,
        "semantic_feature": {"rows": 0, "cols": 0, "data": None},
    }


def _box(center: Triple, size: Triple, yaw: float | None) -> Json:
    """An upright box: turned by `yaw` (rad) about z, along the axes at 0, none at None."""
    kind = "INVALID" if yaw is None else "RAABB" if yaw else "AABB"
    return {
        "type": kind,
        "dimensions": [float(v) for v in size],
        "world_P_center": [float(v) for v in center],
        "world_R_center": _turn(yaw or 0.0),
    }


def _around(rooms: Sequence[Room]) -> Json:
    outlines = [np.asarray(r.polygon_xy).reshape(-1, 2) for r in rooms]
    corners = np.concatenate([*outlines, np.empty((0, 2))])
    if not len(corners):
        return _box((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), None)
    low, high = corners.min(axis=0), corners.max(axis=0)
    return _box([*(low + high) / 2, 0.0], [*(high - low), 0.0], 0.0)


def _turn(yaw: float) -> Json:
    """The quaternion of a turn about z, rad."""
    return {"w": math.cos(yaw / 2), "x": 0.0, "y": 0.0, "z": math.sin(yaw / 2)}


def _nanoseconds(stamp: float) -> int:
    """A stamp (s) as spark_dsg counts time, from 0 on."""
    return max(round(stamp * 1e9), 0)

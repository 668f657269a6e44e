"""What was said of a view, detections and hypotheses, as JSON; points of the plane as integers.

Numbers in JSON are read back to the bit, as Python writes the shortest digits that give them.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from afkb.flow import Detection, Hypothesis, OrientedBox, Relation
from afkb_mapping.memory.thinning import MM_PER_M, NO_POINTS

Json = dict[str, Any]
Points = NDArray[np.int32]


def points_of(detections: Sequence[Detection]) -> Points:
    """(N, 2) mm: footprints of all detections one after the other, in steps from the last point."""
    footprints = [d.footprint_xy for d in detections] or [NO_POINTS]
    mm = np.round(np.concatenate(footprints) * MM_PER_M).astype(np.int32)
    return np.diff(mm, axis=0, prepend=np.int32(0))


def detection_json(detection: Detection) -> Json:
    """A thinned detection without its footprint, of which only the number of points is told."""
    box = detection.box
    segment = detection.segment_xy
    told: Json = {
        "by": detection.detector,
        "affords": dict(detection.affordances),
        "box": [*box.center_xyz, *box.size_xyz, box.yaw],
        "at": detection.position_xyz.tolist(),
        "cov": detection.covariance_xyz.ravel().tolist(),
        "points": len(detection.footprint_xy),
        "pixels": detection.n_pixels,
        "image": detection.image_box,
        "segment": None if segment is None else segment.ravel().tolist(),
        "cut": detection.cut_by_image,
        "extent": detection.extent_known,
        "range": detection.range_m,
        "measures": dict(detection.measures),
    }
    # What joins others shares their place: of them it is told who said what.
    told["parts"] = [[p.detector, dict(p.affordances), dict(p.measures)] for p in detection.parts]
    return told


def detections_of(told: Sequence[Json], steps_mm: Points) -> tuple[Detection, ...]:
    """The inverse of `detection_json` and `points_of`."""
    points = np.cumsum(steps_mm, axis=0, dtype=np.int64) / MM_PER_M
    ends = np.cumsum([t["points"] for t in told]).tolist()
    return tuple(
        _detection(t, points[end - t["points"] : end]) for t, end in zip(told, ends, strict=True)
    )


def _detection(told: Json, footprint_xy: NDArray[np.float64]) -> Detection:
    x, y, z, length, width, height, yaw = told["box"]
    box = OrientedBox((x, y, z), (length, width, height), yaw)
    position, covariance = np.array(told["at"]), np.array(told["cov"]).reshape(3, 3)
    image, segment = told["image"], told["segment"]

    def made(by: str, affords: Json, measures: Json, points: Any, parts: Any) -> Detection:
        return Detection(
            detector=by,
            affordances=affords,
            box=box,
            position_xyz=position,
            covariance_xyz=covariance,
            footprint_xy=points,
            n_pixels=told["pixels"],
            range_m=told["range"],
            image_box=tuple(image) if image is not None else None,
            segment_xy=None if segment is None else np.array(segment).reshape(2, 2),
            cut_by_image=told["cut"],
            extent_known=told["extent"],
            measures=measures,
            parts=parts,
        )

    parts = tuple(made(by, p, measures, NO_POINTS, ()) for by, p, measures in told["parts"])
    return made(told["by"], told["affords"], told["measures"], footprint_xy, parts)


def hypothesis_json(hypothesis: Hypothesis) -> Json:
    """A hypothesis, field by field."""
    categories = hypothesis.categories
    return {
        "by": hypothesis.predictor,
        "order": hypothesis.order,
        "relation": hypothesis.relation.value,
        "anchors": hypothesis.anchors,
        "affords": dict(hypothesis.affordances),
        "scale": hypothesis.scale,
        "p": hypothesis.probability,
        "axiom": hypothesis.axiom,
        "distance": hypothesis.distance_m,
        "size": hypothesis.size_xy_m,
        "top": hypothesis.top_height_m,
        "categories": None if categories is None else dict(categories),
    }


def hypothesis_of(told: Json) -> Hypothesis:
    """The inverse of `hypothesis_json`."""
    top = told["top"]
    return Hypothesis(
        predictor=told["by"],
        order=told["order"],
        relation=Relation(told["relation"]),
        anchors=tuple(told["anchors"]),
        affordances=told["affords"],
        scale=told["scale"],
        probability=told["p"],
        axiom=told["axiom"],
        distance_m=tuple(told["distance"]),
        size_xy_m=tuple(told["size"]),
        top_height_m=None if top is None else tuple(top),
        categories=told["categories"],
    )

"""What is seen in single frames, before any map: detections, told as a person or program reads."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from afkb.errors import BadFrame, PluginError, SourceError
from afkb.flow import Detection, SkippedFrame, View
from afkb.inference import Network
from afkb.plugins.host import PluginHost
from afkb_mapping.geometry import yaw_of
from afkb_mapping.perception import Perception
from afkb_mapping.placing.levelling import level
from afkb_mapping.placing.placed_views import placed_views, skipped
from afkb_mapping.run_record import Stages
from afkb_mapping.selection import FrameRange, Selection
from afkb_mapping.structure import is_structure
from afkb_mapping.view_floor import free_floor

NAMED_CATEGORIES = 5


@dataclass(frozen=True, slots=True, eq=False)
class Look:
    """A placed view and what was detected in it, one detection a thing."""

    view: View
    detections: list[Detection]


def looks(
    host: PluginHost,
    uri: str,
    frames: FrameRange,
    detectors: tuple[str, ...] = (),
    options: dict[str, str] | None = None,
) -> Iterator[Look | SkippedFrame]:
    """Each of the frames with what the detectors see in it; levelled on the whole recording.

    Raises `SourceError` where the recording can't be used, `PluginError` for unknown detectors.
    """
    source, stages = host.open_source(uri, options or {}), Stages()
    if frames.start >= len(source):
        raise SourceError(f"{uri}: no frame {frames.start}, it has {len(source)}, counted from 0")
    perception = Perception(host.detectors(detectors), stages)
    levelled = level(Selection(source, FrameRange()).sample(), source.gravity_aligned)
    for view in placed_views(Selection(source, frames), levelled.T_map_source, stages):
        if isinstance(view, SkippedFrame):
            yield view
            continue
        try:
            yield Look(view, perception.detections(view))
        except PluginError as error:
            yield skipped(view, BadFrame(str(error)))


def as_json(look: Look | SkippedFrame, network: Network) -> dict[str, object]:
    """One frame in the shape that `afkb detect --json` prints; map frame, m and rad."""
    if isinstance(look, SkippedFrame):
        return {"frame": look.index, "skipped": f"{look.where}: {look.why}", "detections": []}
    T = look.view.T_map_base
    assert T is not None
    return {
        "frame": look.view.index,
        "stamp": look.view.stamp,
        "x": float(T[0, 3]),
        "y": float(T[1, 3]),
        "yaw": yaw_of(T),
        "free_floor": [o.round(3).tolist() for o in free_floor(look.view)],
        "detections": [described(d, network) for d in look.detections],
    }


def described(detection: Detection, network: Network) -> dict[str, object]:
    """What a detection says, and what follows from it alone: scale, category, static or dynamic.

    That a thing is static or dynamic is told from one frame, by its category's posterior and
    their movability (paper §II.D.i), without waiting for it to move.
    """
    box = detection.box
    x, y, z = (float(v) for v in detection.position_xyz)
    told: dict[str, object] = {
        "detectors": list(detection.detectors),
        "affords": {n: round(p, 4) for n, p in sorted(detection.affordances.items())},
        "x": x,
        "y": y,
        "z": z,
        "size": list(box.size_xyz),
        "yaw": box.yaw,
        "range": detection.range_m,
        "pixels": detection.n_pixels,
        "image_box": detection.image_box and list(detection.image_box),
        "cut_by_image": detection.cut_by_image,
        "border": dict(detection.border),
        # JSON knows no infinity, by which some detector may say "unlimited" or "unknown".
        "measures": {
            n: float(v) for n, v in sorted(detection.measures.items()) if math.isfinite(v)
        },
    }
    if detection.primitive is not None:
        shape = detection.primitive
        told["primitive"] = {
            "kind": shape.kind,
            "size": list(shape.size_xyz),
            "exponents": list(shape.exponents),
            "residual": shape.residual_m,
        }
    if detection.segment_xy is not None:
        told["segment"] = detection.segment_xy.tolist()
    if is_structure(detection):
        return told
    return told | _taken_for(detection, network)


def _taken_for(detection: Detection, network: Network) -> dict[str, object]:
    """Scale class, the likeliest categories, and whether it is of the things that get moved."""
    size = detection.box.size_xyz
    top = float(detection.position_xyz[2])
    if not detection.affords("SupportAbility"):
        top = detection.box.top
    if detection.measures.get("is_floor"):
        belief = {"Floor": 1.0}
    else:
        known = network.known(detection.affordances)
        belief = network.category_posterior(known, size, top, detection.seen_whole)
    movability, weight = network.movability(belief)
    best = sorted(belief.items(), key=lambda pair: (-pair[1], pair[0]))[:NAMED_CATEGORIES]
    return {
        "scale": network.knowledge_base.scale_of(size),
        "category": {name: round(p, 4) for name, p in best},
        "movability": movability,
        "matching_weight": round(weight, 4),
    }

"""Things on a real table: found, apart from each other, and nothing else."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from afkb.flow import Detection
from bench.detectors.data import Asked
from bench.detectors.mosd_clouds import Cloud, clouds_in
from bench.detectors.seen import CLAIMED, run_detectors

NEEDS = ("mosd",)
IOU = 0.5
TABLE_SHARE = 0.5
"""Share of the table's labelled pixels that one support must show."""
TABLE_OFF_M = 0.02


def run(asked: Asked) -> dict[str, Any]:
    """The score of each cloud, and of each kind of cloud together."""
    detectors = asked.host.detectors(asked.detectors)
    rows = []
    for cloud in clouds_in(asked.mosd):
        seen = run_detectors([cloud.view], detectors)
        (_, found), *_ = seen.views
        rows.append(score(cloud, found))
        if asked.pictures is not None:
            _draw(cloud, found, asked.pictures)
    return {"clouds": rows, "groups": _together(rows)}


def score(cloud: Cloud, found: Sequence[Detection]) -> dict[str, Any]:
    """Table and things of one cloud: each object with the body that overlaps it most."""
    bodies = bodies_of(found)
    overlaps = _overlaps(cloud, bodies)
    objects, claims = linear_sum_assignment(-overlaps)
    matched = {
        int(o): int(c) for o, c in zip(objects, claims, strict=True) if overlaps[o, c] >= IOU
    }
    things = [
        {
            "object": k,
            "pixels": int((cloud.objects == k).sum()),
            "iou": round(float(overlaps[n].max(initial=0.0)), 3),
            "found": n in matched,
            **(_shape(bodies[matched[n]]) if n in matched else {}),
        }
        for n, k in enumerate(cloud.things)
    ]
    return {
        "cloud": cloud.name,
        "group": cloud.group,
        "table": _table_found(cloud, found),
        "things": len(things),
        "found": len(matched),
        "missed": len(things) - len(matched),
        "extra": len(bodies) - len(matched),
        "mean_iou": round(float(np.mean([t["iou"] for t in things])), 3) if things else None,
        "objects": things,
    }


def bodies_of(found: Sequence[Detection]) -> list[Detection]:
    """The bodies among detections that are claimed to be one free-standing thing each."""
    return [
        d
        for d in found
        if d.pixels is not None and "stand" in d.measures and d.affords("DisposeAbility", CLAIMED)
    ]


def _overlaps(cloud: Cloud, bodies: Sequence[Detection]) -> NDArray[np.float64]:
    """IoU (things, bodies) over labelled pixels."""
    flat = cloud.objects.ravel()
    table = np.zeros((len(cloud.things), len(bodies)))
    for b, body in enumerate(bodies):
        assert body.pixels is not None
        shown = flat[body.pixels]
        for n, k in enumerate(cloud.things):
            both = int((shown == k).sum())
            table[n, b] = both / ((flat == k).sum() + (shown > 0).sum() - both)
    return table


def _table_found(cloud: Cloud, found: Sequence[Detection]) -> bool:
    """Whether one support, at the table's height, shows most of it."""
    v, u = np.nonzero(cloud.objects == 1)
    height = float(np.median(_heights(cloud, u, v)))
    return any(
        d.affords("SupportAbility", CLAIMED)
        and abs(d.position_xyz[2] - height) < TABLE_OFF_M
        and d.n_pixels > TABLE_SHARE * len(u)
        for d in found
    )


def _heights(cloud: Cloud, u: NDArray[np.intp], v: NDArray[np.intp]) -> NDArray[np.float64]:
    camera, depth, T = cloud.view.camera, cloud.view.depth_m, cloud.view.T_map_camera
    assert camera is not None and depth is not None
    rays = np.stack([(u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(len(u))])
    heights: NDArray[np.float64] = T[2, :3] @ (rays * depth[v, u]) + T[2, 3]
    return heights


def _shape(body: Detection) -> dict[str, Any]:
    shape = body.primitive
    if shape is None:
        return {}
    return {"kind": shape.kind, "residual_mm": round(1e3 * shape.residual_m, 2)}


def _together(rows: Sequence[dict[str, Any]]) -> dict[str, Any]:
    groups: dict[str, list[dict[str, Any]]] = defaultdict(list)
    for row in rows:
        groups[row["group"]].append(row)
    return {
        name: {
            "clouds": len(of),
            "tables": sum(r["table"] for r in of),
            **{key: sum(r[key] for r in of) for key in ("things", "found", "missed", "extra")},
            "recall": round(sum(r["found"] for r in of) / max(sum(r["things"] for r in of), 1), 3),
            "mean_iou": round(float(np.mean([t["iou"] for r in of for t in r["objects"]])), 3),
        }
        for name, of in groups.items()
    }


def table(result: dict[str, Any]) -> Iterator[str]:
    """A line a cloud with its objects, then a line a kind."""
    for row in result["clouds"]:
        yield (
            f"{row['cloud']:9} {row['group']:9} table {'yes' if row['table'] else 'NO '} "
            f"found {row['found']} of {row['things']}, extra {row['extra']}, "
            f"mean IoU {row['mean_iou']:.2f}: {'; '.join(map(_said, row['objects']))}"
        )
    for name, g in result["groups"].items():
        yield (
            f"{name:9} {g['clouds']} clouds, tables {g['tables']}, things {g['found']} of "
            f"{g['things']} ({g['recall']:.2f}), missed {g['missed']}, extra {g['extra']}, "
            f"mean IoU {g['mean_iou']:.2f}"
        )


def _said(thing: dict[str, Any]) -> str:
    shape = f" {thing['kind']} {thing['residual_mm']:.1f} mm" if "kind" in thing else ""
    return f"{thing['iou']:.2f}{shape}"


def _draw(cloud: Cloud, found: Sequence[Detection], folder: Path) -> None:
    """Bodies in colours over what the camera saw; outlines of the labelled objects in white."""
    import cv2

    size = cloud.objects.shape
    colour = cloud.view.color
    picture = np.full((*size, 3), 90, np.uint8) if colour is None else colour[..., ::-1].copy()
    hues = np.random.default_rng(0).integers(60, 255, (64, 3))
    for n, body in enumerate(bodies_of(found)):
        flat = picture.reshape(-1, 3)
        flat[body.pixels] = (0.4 * flat[body.pixels] + 0.6 * hues[n % 64]).astype(np.uint8)
    for k in cloud.things:
        outlines, _ = cv2.findContours(
            (cloud.objects == k).astype(np.uint8), cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE
        )
        cv2.drawContours(picture, outlines, -1, (255, 255, 255), 1)
    folder.mkdir(parents=True, exist_ok=True)
    cv2.imwrite(str(folder / f"mosd-{cloud.name}.png"), picture)

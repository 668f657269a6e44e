"""A small folder in TUM's layout, written by hand, for tests of its source."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np

from afkb.plugins.protocols import Source
from afkb_tum import afkb_open_source

WIDTH, HEIGHT = 16, 12
T0 = 1305031098.5
K = "20,20,8,6"


def png(path: Path, pixels: np.ndarray) -> None:
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(cv2.imencode(".png", pixels)[1].tobytes())


def tum_folder(folder: Path, frames: int = 3) -> Path:
    """Frame k, 0.1 s after the one before, is a wall 1.5 m away seen from x = k/10 m.

    Poses lie between the images' stamps, 50 times a second.
    """
    lines: dict[str, list[str]] = {name: ["# a comment"] for name in ("depth", "rgb")}
    for k in range(frames):
        stamp = T0 + 0.1 * k
        png(folder / "depth" / f"{k}.png", np.full((HEIGHT, WIDTH), 7500, np.uint16))
        png(folder / "rgb" / f"{k}.png", np.full((HEIGHT, WIDTH, 3), (255, 0, k), np.uint8))
        lines["depth"].append(f"{stamp:.6f} depth/{k}.png")
        lines["rgb"].append(f"{stamp + 0.01:.6f} rgb/{k}.png")
    for name, text in lines.items():
        (folder / f"{name}.txt").write_text("\n".join(text) + "\n")
    poses = [(T0 - 0.01 + 0.02 * i, 0.02 * i - 0.01) for i in range(5 * frames)]
    write_poses(folder / "groundtruth.txt", [(t, x, 0, 0, 0, 0, 0, 1) for t, x in poses])
    return folder


def write_poses(path: Path, poses: Sequence[Sequence[float]]) -> None:
    path.write_text("# stamp tx ty tz qx qy qz qw\n" + "".join(map(_line, poses)))


def _line(pose: Sequence[float]) -> str:
    return f"{pose[0]:.4f} " + " ".join(f"{v:.6g}" for v in pose[1:]) + "\n"


def open_tum(folder: Path, **options: str) -> Source:
    source = afkb_open_source(str(folder), {"intrinsics": K} | options, None)  # type: ignore[arg-type]
    assert source is not None
    return source

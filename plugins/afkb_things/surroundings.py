"""What the outline of a thing borders on in the image."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
from numpy.typing import NDArray

from afkb_mapping.bodies import Body
from afkb_mapping.kernels import kernel
from afkb_things.cells import step


@kernel
def surroundings(
    u: NDArray[np.int32],
    v: NDArray[np.int32],
    depth_m: NDArray[np.float32],
    names: NDArray[np.int32],
    name: int,
    labels: NDArray[np.int16],
    overs_m: NDArray[np.float32],
    core_m: float,
    noise: float,
) -> tuple[float, float, float, float]:
    """What a thing's outline borders on: shares of attached, behind it, before it, missing.

    Attached: the surface goes on, off the support, so that this is a part of something larger.
    What rises less than core_m over the support (overs_m) is its foot, or a cloth below it.
    `names` (H, W) is `name` at the thing's pixels and that of another thing at its ones, from
    which an edge parts it; `labels` (H, W) is negative on supports.
    """
    rows, cols = depth_m.shape
    attached = behind = before = missing = total = 0
    for k in range(len(u)):
        r, c = v[k], u[k]
        if (
            0 < r < rows - 1
            and 0 < c < cols - 1
            and names[r - 1, c] == names[r + 1, c] == names[r, c - 1] == names[r, c + 1] == name
        ):
            continue
        z = depth_m[r, c]
        jump = step(z, noise)
        for du, dv in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            i, j = v[k] + dv, u[k] + du
            if 0 <= i < rows and 0 <= j < cols and names[i, j] == name:
                continue
            # speckle: look a little further for the next pixel that returned
            reach = 1
            while 0 <= i < rows and 0 <= j < cols and depth_m[i, j] <= 0 and reach < 4:
                i, j, reach = i + dv, j + du, reach + 1
            if not (0 <= i < rows and 0 <= j < cols):
                total += 1
                missing += 1
                continue
            if names[i, j] == name:
                continue
            total += 1
            other = depth_m[i, j]
            if other <= 0:
                missing += 1
            elif other > z + jump:
                behind += 1
            elif other < z - jump:
                before += 1
            elif names[i, j] > 0:
                behind += 1
            elif labels[i, j] == 0 or (labels[i, j] > 0 and overs_m[i, j] > core_m):
                attached += 1
            else:
                behind += 1
    total = max(total, 1)
    return attached / total, behind / total, before / total, missing / total


@contextmanager
def named(bodies: Sequence[Body], names: NDArray[np.int32]) -> Iterator[NDArray[np.int32]]:
    """`names` (H, W), 0 before and after, with each body's number, from 1, at its pixels."""
    for name, body in enumerate(bodies, start=1):
        mark(body.u, body.v, names, name)
    yield names
    for body in bodies:
        mark(body.u, body.v, names, 0)


@kernel
def mark(u: NDArray[np.int32], v: NDArray[np.int32], names: NDArray[np.int32], name: int) -> None:
    """Write a name at a thing's pixels."""
    for k in range(len(u)):
        names[v[k], u[k]] = name

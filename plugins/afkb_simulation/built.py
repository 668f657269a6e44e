"""What a shape is once built: a mesh and the surfaces that things can stand on."""

from __future__ import annotations

from dataclasses import dataclass

from afkb_simulation.meshes import Mesh

Size = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Support:
    """A level rectangle to stand on, in the thing's own frame, m."""

    z: float
    x0: float
    y0: float
    x1: float
    y1: float

    @property
    def center_xy(self) -> tuple[float, float]:
        """Its middle, m."""
        return (self.x0 + self.x1) / 2, (self.y0 + self.y1) / 2


@dataclass(frozen=True, slots=True)
class Built:
    """A thing in its own frame: z = 0 under it, origin at the middle of its foot, front at +x.

    `top_m`: height of its main upper surface (a chair's seat), or of its rim. `supports`: what
    things can stand on, the main one first.
    """

    mesh: Mesh
    top_m: float
    supports: tuple[Support, ...] = ()

"""Small placed views and detections, made by hand."""

import numpy as np

from afkb.flow import Detection, Hypothesis, LaserScan, OrientedBox, PinholeCamera, Relation, View
from afkb_mapping.geometry import T_from_xy_yaw

CAMERA = PinholeCamera(160, 120, 140.0, 140.0, 79.5, 59.5)
T_BASE_CAMERA = np.array([[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 1.2], [0, 0, 0, 1.0]])
DUAL = "https://example.org/dual"


def view(index=0, x=0.0, y=0.0, yaw=0.0, depth_m=2.0, open_ahead=False):
    """A robot at a pose that looks at a flat wall `depth_m` ahead, with a scan of a round room.

    `open_ahead`: the scan has no returns ahead, so that the map knows nothing there.
    """
    ranges = np.full(360, 3.0, np.float32)
    if open_ahead:
        ranges[120:240] = np.inf
    T = T_from_xy_yaw(x, y, yaw)
    depth = np.full((CAMERA.height, CAMERA.width), depth_m, np.float32)
    scan = LaserScan(ranges, -np.pi, np.deg2rad(1), 0.1, 10.0)
    return View(
        index,
        index / 2,
        T,
        depth,
        CAMERA,
        T_BASE_CAMERA,
        scan=scan,
        T_base_laser=np.eye(4),
        T_map_base=T,
    )


def patch(x, y, width, depth, step=0.02):
    a, b = np.meshgrid(
        np.arange(-width / 2, width / 2, step), np.arange(-depth / 2, depth / 2, step)
    )
    return np.column_stack([a.ravel() + x, b.ravel() + y])


def support(x, y, z=0.75, width=1.2, depth=0.8, cut=False, **measures):
    return Detection(
        detector="surfaces",
        affordances={"SupportAbility": 0.95},
        box=OrientedBox((x, y, z - 0.01), (width, depth, 0.02)),
        position_xyz=np.array([x, y, z]),
        covariance_xyz=np.eye(3) * 0.003**2,
        footprint_xy=patch(x, y, width, depth),
        n_pixels=4000,
        range_m=1.5,
        image_box=(10, 10, 100, 100),
        cut_by_image=cut,
        measures=measures,
    )


def container(x, y, bottom=0.75, height=0.1, width=0.09, on_support=True):
    measures = {"support_height": bottom} if on_support else {}
    return Detection(
        detector="containers",
        affordances={"ContainAbility": 0.9},
        box=OrientedBox((x, y, bottom + height / 2), (width, width, height)),
        position_xyz=np.array([x, y, bottom + height / 2]),
        covariance_xyz=np.eye(3) * 0.004**2,
        footprint_xy=patch(x, y, width, width, 0.005),
        n_pixels=900,
        range_m=1.5,
        image_box=(50, 50, 70, 70),
        measures=measures,
    )


def support_below(*anchors, probability=0.7):
    return Hypothesis(
        predictor="duals",
        order=1,
        relation=Relation.BELOW,
        anchors=anchors,
        affordances={"SupportAbility": 1.0},
        scale="Medium",
        probability=probability,
        axiom=DUAL,
    )


def support_near(anchor, distance=0.7):
    return Hypothesis(
        predictor="co-occurrence",
        order=2,
        relation=Relation.NEAR,
        anchors=(anchor,),
        affordances={"SupportAbility": 1.0},
        scale="Large",
        probability=0.65,
        axiom="https://example.org/co-occurrence",
        distance_m=(distance, 0.2),
        size_xy_m=(1.2, 0.8),
        top_height_m=(0.65, 0.85),
    )

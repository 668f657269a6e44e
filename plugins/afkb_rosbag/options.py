"""What a user may choose about a bag."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, NonNegativeFloat

NONE = "none"


class BagOptions(BaseModel):
    """Topics and frames to use where the recording's own names leave a choice.

    - `depth_topic`, `scan_topic`: a topic, or `none` to leave that sensor out.
    - `camera_info_topic`: intrinsics of the depth camera.
    - `odom_topic`: odometry, used in place of tf's `odom_frame` → `base_frame`.
    - `base_frame`, `odom_frame`: tf frames; `odom_frame=map` takes a SLAM's corrected poses.
    - `max_dt`: s; how far apart two stamps may be to count as the same moment.
    - `max_gap`: s; how far apart two transforms may be to interpolate between them.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    depth_topic: str | None = None
    camera_info_topic: str | None = None
    scan_topic: str | None = None
    odom_topic: str | None = None
    base_frame: str | None = None
    odom_frame: str | None = None
    max_dt: NonNegativeFloat = 0.1
    max_gap: NonNegativeFloat = 0.3

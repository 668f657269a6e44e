"""What readers of recordings share: image files, intrinsics files, poses over time."""

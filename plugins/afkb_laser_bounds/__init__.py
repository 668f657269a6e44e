"""Detector: bounds (walls) as line segments in laser scans."""

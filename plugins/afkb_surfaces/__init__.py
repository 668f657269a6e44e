"""Detector: horizontal and vertical surfaces in depth."""

"""Detector: open and closed containers that stand on a support."""

"""Exporter: report.html, the map as one self-contained page."""

"""SPARQL over mapped scenes, measured: see `python -m bench.sparql --help`."""

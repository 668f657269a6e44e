"""The command line: what reads only RDF is here; plugins bring the rest."""

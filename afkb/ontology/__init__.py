"""Writes the ontology: from tables and rules to OWL, with the names that all of it shares."""

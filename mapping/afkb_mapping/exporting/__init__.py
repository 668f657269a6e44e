"""Stored maps written in other formats: the export itself, and the command."""

"""Quality gates of the ontology: shapes, pitfalls, reasoning and competency questions."""

"""Predictors: affordance duals and co-occurrences, compiled from the ontology."""

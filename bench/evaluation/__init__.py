"""All measurements, run by one command, and the document that is written from their results."""

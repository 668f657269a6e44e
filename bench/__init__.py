"""Side-by-side benchmarks and evaluations, each one command."""

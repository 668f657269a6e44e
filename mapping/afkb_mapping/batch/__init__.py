"""Many recordings, each mapped in a process of its own, shared out by Dask."""

"""Many records at once: on this machine's processes, or on a Dask cluster."""

"""Datasets: a folder with meta.toml and data.csv, read with every doubt located by row and column."""

from brace.dataset.faults import DataFault
from brace.dataset.intake import Dataset, load_dataset
from brace.dataset.meta import Meta, read_meta

__all__ = ["DataFault", "Dataset", "Meta", "load_dataset", "read_meta"]

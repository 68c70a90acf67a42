"""Where a diagnosis comes from: hashes of what was read, versions of what computed it."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass

from brace import __version__
from brace.dataset import Dataset
from brace.ground.files import DATA_LIMIT_BYTES, TOML_LIMIT_BYTES, read_bytes


@dataclass(frozen=True)
class Provenance:
    """Where a diagnosis comes from, described without paths or clocks."""

    title: str
    kind: str
    rows: int
    data_sha256: str  # over meta.toml, then data.csv
    model_sha256: str  # over the believed limb.toml; "" where there was none
    versions: Mapping[str, str]

    @property
    def name(self) -> str:
        """The record's title, or its hash's beginning."""
        return self.title or f"record {self.data_sha256[:12]}"


def provenance(dataset: Dataset, believed_text: str) -> Provenance:
    """Hashes and versions."""
    digest = hashlib.sha256(read_bytes(dataset.folder / "meta.toml", TOML_LIMIT_BYTES, "dataset's meta.toml"))
    digest.update(read_bytes(dataset.csv_path, DATA_LIMIT_BYTES, "dataset's data.csv"))
    model = hashlib.sha256(believed_text.encode()).hexdigest() if believed_text else ""
    return Provenance(dataset.meta.title, dataset.kind, dataset.rows, digest.hexdigest(), model, versions())


def versions() -> dict[str, str]:
    """What computed it."""
    import numpy
    import scipy

    from brace.native import library
    from brace.wire.names import SCHEMA_HASH

    native = library()
    core = native.ffi.string(native.lib.brace_host_version()).decode()
    return {
        "brace": __version__,
        "core": core,
        "schema": f"{SCHEMA_HASH:08x}",
        "numpy": numpy.__version__,
        "scipy": scipy.__version__,
    }

"""What a release is made of, as a CycloneDX bill of materials: Brace, what is compiled in, what is brought along."""

from __future__ import annotations

import re
import uuid
from datetime import datetime, timezone
from pathlib import Path

from cyclonedx.contrib.license.factories import LicenseFactory
from cyclonedx.model import Property
from cyclonedx.model.bom import Bom
from cyclonedx.model.component import Component, ComponentType
from cyclonedx.output import make_outputter
from cyclonedx.schema import OutputFormat, SchemaVersion
from packageurl import PackageURL
from release.about import about
from release.source import ReleaseError, Source, run

# Compiled into what is released: Debian package, licence, where it ends up.
COMPILED_IN = {
    "libeigen3-dev": ("eigen", "MPL-2.0", "libbrace_host.so"),
    "libnewlib-arm-none-eabi": ("newlib", "BSD-3-Clause", "firmware images"),
    "gcc-arm-none-eabi": ("libgcc", "GPL-3.0-or-later WITH GCC-exception-3.1", "firmware images"),
}


def bill_of_materials(source: Source) -> str:
    """The bill as JSON. The same release has the same serial number."""
    licences = LicenseFactory()
    brace = Component(
        name="brace",
        version=source.version,
        type=ComponentType.APPLICATION,
        bom_ref="brace",
        licenses=[licences.make_from_string("Apache-2.0")],
        properties=[Property(name="commit", value=source.commit)],
    )
    parts = [_compiled_in(package, licences) for package in COMPILED_IN] + [
        Component(
            name=(name := re.split(r"[<>=;\[ ]", package)[0]),
            type=ComponentType.LIBRARY,
            bom_ref=f"pypi-{name}",
            purl=PackageURL("pypi", name=name),
            properties=[Property(name="in", value=f"not in a file of this release; the wheel asks pip for {package}")],
        )
        for package in about(source.folder).needs
    ]
    bom = Bom(components=parts)
    bom.metadata.component = brace
    bom.metadata.timestamp = datetime.fromtimestamp(source.epoch_s, timezone.utc)
    bom.serial_number = uuid.uuid5(uuid.NAMESPACE_URL, f"brace-{source.version}-{source.commit}")
    bom.register_dependency(brace, parts)
    return str(make_outputter(bom, OutputFormat.JSON, SchemaVersion.V1_6).output_as_string(indent=1)) + "\n"


def _compiled_in(package: str, licences: LicenseFactory) -> Component:
    name, licence, where = COMPILED_IN[package]
    version = run("dpkg-query", "-W", "-f", "${Version}", package).strip()
    if not version:
        raise ReleaseError(f"Debian package {package} is not installed")
    return Component(
        name=name,
        version=version,
        type=ComponentType.LIBRARY,
        bom_ref=f"deb-{package}",
        purl=PackageURL("deb", "debian", package, version),
        licenses=[licences.make_from_string(licence)],
        properties=[Property(name="in", value=where)],
    )


def write(source: Source, dist: Path) -> None:
    """brace-<version>.cdx.json"""
    (dist / f"brace-{source.version}.cdx.json").write_text(bill_of_materials(source))

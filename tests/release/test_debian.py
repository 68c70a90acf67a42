"""The Debian packages of the C libraries: for each architecture a program is built with what is inside, and run."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

import pytest
from targets import EXAMPLES, PROJECT, REFERENCE_K, TARGETS, TOLERANCE_N_PER_MM, k_values, output_of

sys.path.insert(0, str(PROJECT / "tools"))
from release import source  # noqa: E402

MACHINES = {"x86_64": "host-gcc", "aarch64": "aarch64"}
MOST_BYTES = 3_000_000  # with numpy and scipy inside it was 75 MB


@pytest.mark.parametrize("machine", MACHINES)
def test_a_package(machine: str, tmp_path: Path) -> None:
    target = next(target for target in TARGETS if target.name == MACHINES[machine])
    target.skip_without()
    for tool in ("dpkg-deb", "pkg-config"):
        if shutil.which(tool) is None:
            pytest.skip(f"no {tool}")
    pytest.importorskip("argparse_manpage")
    from release import debian

    sources = source.Source(PROJECT, "0" * 40, 1_700_000_000, source.version_of(PROJECT))
    made = debian.package(sources, machine, tmp_path / "work", tmp_path)
    assert made.name == f"libbrace-dev_{sources.version}_{debian.ARCHITECTURES[machine]}.deb"
    assert made.stat().st_size < MOST_BYTES
    fields = output_of("dpkg-deb", "--field", made)
    assert f"Architecture: {debian.ARCHITECTURES[machine]}\n" in fields and "Multi-Arch: same\n" in fields
    assert "Depends:" not in fields.splitlines() and "python" not in fields
    root = tmp_path / "root"
    output_of("dpkg-deb", "--extract", made, root)
    assert (root / "usr/share/man/man1/brace-k.1.gz").is_file()
    assert (root / "usr/share/doc/libbrace-dev/docs/client.md").is_file()
    libraries = root / f"usr/lib/{machine}-linux-gnu"
    assert {path.name for path in libraries.glob("*.a")} >= {"libbrace_core.a", "libbrace_app.a", "libbrace_client.a"}
    find = f"--with-path={libraries / 'pkgconfig'}"
    flags = output_of("pkg-config", find, "--cflags", "--libs", "brace-core").split()
    limb = EXAMPLES / "bare_loop"
    output_of(
        target.compiler, EXAMPLES / "your_cmake" / "k.c", limb / "limb.c", f"-I{limb}", *flags, "-o", tmp_path / "k"
    )
    assert k_values(target.run(tmp_path / "k")) == [pytest.approx(REFERENCE_K, abs=TOLERANCE_N_PER_MM)]
    text = "".join(path.read_text() for path in libraries.rglob("*.[cp]*") if path.suffix in (".cmake", ".pc"))
    assert text and str(tmp_path) not in text and str(PROJECT) not in text

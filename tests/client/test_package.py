"""find_package(brace) from an installed tree, in a project that knows nothing else of this one."""

from __future__ import annotations

import subprocess
from pathlib import Path

from conftest import PROJECT, Sim

CONSUMER = """cmake_minimum_required(VERSION 3.24)
project(robot LANGUAGES C CXX)
find_package(brace 0.1 REQUIRED)
add_executable(print_k print_k.c connect.c)
target_link_libraries(print_k PRIVATE brace::client)
add_executable(from_cpp from_cpp.cpp)
target_link_libraries(from_cpp PRIVATE brace::client)
"""
FROM_CPP = """#include <brace/bus.h>
#include <brace/client.h>
#include <brace/client_motion.h>
#include <brace/parameter_list.h>
int main() { return brace_client_exit_code(BRACE_CLIENT_E_VERSION) - 6 + (BRACE_CLIENT_ENTRY(probe_u32) - 0x1001); }
"""


def run(*command: object) -> str:
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_consumer(tmp_path: Path, sim: Sim) -> None:
    prefix, consumer = tmp_path / "prefix", tmp_path / "consumer"
    run("cmake", "-S", PROJECT / "tools" / "client", "-B", tmp_path / "client", "-G", "Ninja")
    run("cmake", "--build", tmp_path / "client")
    run("cmake", "--install", tmp_path / "client", "--prefix", prefix)
    consumer.mkdir()
    (consumer / "CMakeLists.txt").write_text(CONSUMER)
    (consumer / "from_cpp.cpp").write_text(FROM_CPP)
    for name in ("print_k.c", "connect.c", "connect.h"):
        example = (PROJECT / "examples" / "c_client" / name).read_text()
        assert len(example.splitlines()) < 40
        (consumer / name).write_text(example)
    run("cmake", "-S", consumer, "-B", consumer / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={prefix}")
    run("cmake", "--build", consumer / "build")
    run(consumer / "build" / "from_cpp")
    lines = run(consumer / "build" / "print_k", sim.can, "1").splitlines()
    assert len(lines) == 10 and all("N/mm" in line and "rad" in line for line in lines)
    installed = "".join(path.read_text() for path in prefix.rglob("*.cmake"))
    assert str(PROJECT) not in installed  # the package may be moved

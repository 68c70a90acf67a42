"""brace doctor: what is there and what is missing, with stand-ins and a bus of our own, and with nothing."""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest
from image_bench import content, elf, list_them
from command_bench import Outcome

from brace.doctor import finding
from brace.doctor.builds import builds
from brace.doctor.controller import controller
from brace.doctor.finding import MISSING, NOTE, OK, OLD, Finding, Machine
from brace.doctor.hardware import hardware
from brace.doctor.programs import programs, python_packages

Brace = Callable[..., Outcome]


@pytest.fixture
def nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Machine:
    """A machine with nothing on it."""
    (tmp_path / "bin").mkdir()
    monkeypatch.setenv("PATH", str(tmp_path / "bin"))
    return Machine(tmp_path / "project", tmp_path / "sys", tmp_path / "dev", tmp_path / "modules")


def program(machine: Machine, name: str, script: str) -> None:
    path = machine.project.parent / "bin" / name
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(path.stat().st_mode | stat.S_IXUSR)


def put(path: Path, text: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def states(findings: list[Finding]) -> dict[str, str]:
    return {found.name: found.state for found in findings}


def test_nothing_is_there(nothing: Machine) -> None:
    found = list(programs(nothing))
    state = states(found)
    for name in (
        "gcc",
        "g++",
        "cmake",
        "ninja",
        "arm-none-eabi-gcc",
        "qemu-system-arm",
        "newlib",
        "programmer",
    ):
        assert state[name] == MISSING, name
    assert all(one.next_step.startswith("sudo apt-get install ") for one in found if not one.is_good)
    assert state["candump"] == NOTE
    state = states(list(hardware(nothing)))
    assert (
        state["probe"]
        == state["serial port"]
        == state["CAN interface"]
        == state["kernel module vcan"]
        == NOTE
    )
    state = states(list(builds(nothing)))
    assert set(state.values()) == {MISSING} and len(state) == 4


def test_what_is_there_is_told_with_its_version(nothing: Machine) -> None:
    program(nothing, "gcc", "echo 'gcc 99.1'")
    program(nothing, "openocd", "echo 'Open On-Chip Debugger 0.12.0' >&2")
    program(nothing, "cmake", "exec /bin/sleep 60")  # one that never says: there all the same
    told = {found.name: found for found in programs(nothing)}
    assert (told["gcc"].state, told["gcc"].found) == (OK, "gcc 99.1")
    assert told["openocd"].found == "Open On-Chip Debugger 0.12.0" and "programmer" not in told
    assert (told["cmake"].state, told["cmake"].found) == (OK, "there")


def test_hardware_is_seen(nothing: Machine) -> None:
    put(nothing.sys / "bus" / "usb" / "devices" / "1-1" / "idVendor", "0483\n")
    put(nothing.sys / "bus" / "usb" / "devices" / "1-1" / "idProduct", "374b\n")
    put(nothing.dev / "ttyACM0")
    put(nothing.sys / "class" / "net" / "can0" / "type", "280\n")
    put(nothing.sys / "class" / "net" / "can0" / "operstate", "down\n")
    put(nothing.sys / "class" / "net" / "vcan0" / "type", "280\n")
    put(nothing.sys / "class" / "net" / "vcan0" / "operstate", "unknown\n")
    put(nothing.sys / "class" / "net" / "eth0" / "type", "1\n")
    put(nothing.sys / "module" / "can" / "refcnt")
    put(nothing.modules / "modules.dep", "kernel/net/can/can-raw.ko.xz: kernel/net/can/can.ko.xz\n")
    found = list(hardware(nothing))
    told = {(one.name, one.found): one for one in found}
    assert any(one.name == "probe" and "stlink" in one.found for one in found)
    assert told["serial port", f"{nothing.dev}/ttyACM0"].state == OK
    assert (
        told["CAN interface", "can0: down"].next_step == "sudo ip link set can0 up type can bitrate 1000000"
    )
    assert told["CAN interface", "vcan0: unknown"].state == OK
    assert states(found)["kernel module can"] == OK
    assert (
        next(one for one in found if one.name == "kernel module can_raw").next_step == "sudo modprobe can_raw"
    )
    assert not any("eth0" in one.found for one in found)


def test_a_port_of_others_is_told(nothing: Machine, monkeypatch: pytest.MonkeyPatch) -> None:
    put(nothing.dev / "ttyUSB0")
    monkeypatch.setattr(
        "brace.doctor.hardware.os.access", lambda _path, _mode: False
    )  # root may use every port
    told = next(one for one in hardware(nothing) if one.name == "serial port")
    assert told.state == MISSING and "dialout" in told.next_step


def test_builds_are_as_new_as_their_sources(nothing: Machine) -> None:
    source = nothing.project / "firmware" / "core" / "k.c"
    put(source, "int k;")
    library = nothing.project / "build" / "host" / "host_sim" / "libbrace_host.so"
    put(library)
    folder = nothing.project / "build" / "m4f" / "images"
    folder.mkdir(parents=True)
    image = folder / "brace-stm32f405.elf"
    image.write_bytes(elf(content()))
    (folder / "image.elf").write_bytes(image.read_bytes())
    list_them(folder)
    (folder / "SHA256SUMS").write_text((folder / "SHA256SUMS").read_text().replace("image.elf", image.name))
    for path in (library, image):
        os.utime(path, (2e9, 2e9))
    os.utime(source, (1e9, 1e9))
    told = {found.name: found for found in builds(nothing)}
    assert told["libbrace_host.so"].state == told["brace-stm32f405"].state == OK
    assert told["brace-stm32f405"].found == "0.1.0 (0123456789ab)"
    os.utime(source, (2.1e9, 2.1e9))
    told = {found.name: found for found in builds(nothing)}
    assert told["libbrace_host.so"].state == told["brace-stm32f405"].state == OLD
    assert "firmware/core/k.c is newer" in told["brace-stm32f405"].found
    image.write_bytes(image.read_bytes() + b"\0")
    told = {found.name: found for found in builds(nothing)}
    assert (
        told["brace-stm32f405"].state == MISSING
        and "not the file that was built" in told["brace-stm32f405"].found
    )


def test_an_installed_command_needs_no_build(nothing: Machine, tmp_path: Path) -> None:
    """A wheel and the Debian package have the library inside."""
    installed = replace(nothing, native=tmp_path / "_native")
    assert nothing.needed == ("tools", "build")
    installed.native.mkdir()
    (lacking,) = builds(installed)
    assert installed.needed == ("tools",) and lacking.state == MISSING and "anew" in lacking.next_step
    put(installed.native / "libbrace_host.so")
    (there,) = builds(installed)
    assert there.is_good and there.found == "installed with the command"


def test_this_python_is_good_enough() -> None:
    found = list(python_packages(Machine()))
    assert {"Python", "numpy", "scipy", "cffi"} <= {one.name for one in found}
    assert all(one.is_good for one in found)


def test_exit_code_and_json(brace: Brace, monkeypatch: pytest.MonkeyPatch) -> None:
    good = Finding("build", "gcc", OK, "12")
    for lacking, needed, code in (
        (None, (), 0),
        (Finding("build", "cmake", MISSING, "not installed", "install it"), (), 1),
        (Finding("flash", "programmer", MISSING, "none", "install one"), (), 0),
        (Finding("flash", "programmer", MISSING, "none", "install one"), ("flash",), 1),
        (Finding("tools", "libbrace_host.so", OLD, "built", "./dev setup"), (), 1),
        (Finding("wire", "CAN interface", NOTE, "none"), ("wire",), 0),
    ):
        found = [good] + ([lacking] if lacking else [])
        for name in ("programs.programs", "programs.python_packages", "hardware.hardware", "builds.builds"):
            monkeypatch.setattr(f"brace.doctor.{name}", lambda _machine: [])
        monkeypatch.setattr("brace.doctor.builds.builds", lambda _machine, found=found: found)
        option = ("--needed", *needed) if needed else ()
        assert brace("doctor", *option).code == code
        outcome = brace("doctor", "--json", *option)
        told = json.loads(outcome.out)
        assert outcome.code == code and told["good"] == (code == 0)
        assert told["findings"][0] == {"for": "build", "name": "gcc", "state": "ok", "found": "12", "try": ""}
    assert brace("doctor", "--needed", "everything").code == 2
    assert set(finding.PURPOSES) > set(finding.ALWAYS_NEEDED)


def test_a_controllers_faults_and_counters_are_told() -> None:
    values = {"faults": 1 << 6 | 1 << 10, "frames_lost": 7}
    found = list(controller("can0, node 3", lambda name: values.get(name, 0)))
    assert [(one.name, one.state) for one in found] == [
        ("can_bus_off", "fault"), ("drive_refuses", "fault"), ("frames_lost", "note"),
    ]  # fmt: skip
    assert "7 requests" in found[2].found and all(one.next_step for one in found)
    assert not found[0].is_good and found[2].is_good
    (fine,) = controller("can0, node 3", lambda _: 0)
    assert fine.is_good and "can0, node 3" in fine.found

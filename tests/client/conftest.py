"""The C client's tests: a probe that makes its calls, `brace sim` to call,
and a controller made of Python that misbehaves."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from brace.model import LimbModel
from brace.native.loaded import under_force

PROJECT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("BRACE_HOST_BUILD", PROJECT / "build" / "host"))
PROBE = BUILD / "tests" / "client" / "client_probe"
PRINT_K = BUILD / "tools" / "client" / "print_k"
LIMB = PROJECT / "tools" / "brace" / "data" / "paper-limb.toml"
sys.path.insert(0, str(Path(__file__).parent))
PROMISED_MS = 2500  # given this time-out, the client reports every failure within REPORTING_S
# The guest kernel stands still for seconds when the machine is busy, and so does an emulated board, whose serial frames
# are torn by that, too. What is tested there is not their speed.
PATIENT_MS = 20000
IS_GUEST = "BRACE_TEST_CAN" in os.environ
ANSWER_MS = PATIENT_MS if IS_GUEST else PROMISED_MS
REPORTING_S = 3.0 if not IS_GUEST else PATIENT_MS / 1000.0


@dataclass
class Answer:
    """What one call of the client gave."""

    code: int  # positive: brace_client_status_t less its sign
    out: str
    err: str
    own_s: float  # what the client has waited and computed, without what a busy machine let it stand

    @property
    def reported_in_time(self) -> bool:
        """Within the 3 s that are promised for every failure; in the guest, before its caller gives up."""
        return self.own_s < REPORTING_S

    @property
    def values(self) -> dict[str, float]:
        assert self.code == 0, f"the client gave no value: {self.err}"
        return {name: float(value) for name, value in (line.split() for line in self.out.splitlines())}

    @property
    def snapshots(self) -> list[dict[str, float]]:
        parts = self.out.split("snapshot ")[1:]
        return [
            {name: float(value) for name, value in (line.split() for line in ("snapshot " + part).splitlines())}
            for part in parts
        ]


@pytest.fixture(scope="session")
def probe() -> Callable[..., Answer]:
    """One call of the C client in a process of its own: probe(url, call, numbers..., node=, timeout_ms=)."""
    if not PROBE.exists():
        pytest.fail(f"{PROBE} is missing; ./dev setup builds it")

    def call(url: str, name: str, *numbers: float, node: int = 1, timeout_ms: int = ANSWER_MS) -> Answer:
        done = subprocess.run(
            [PROBE, url, str(node), str(timeout_ms), name, *map(str, numbers)],
            capture_output=True, text=True, timeout=300,
        )
        said = re.fullmatch(r"(.*)own time (\d+) ms\n", done.stderr, re.DOTALL)
        assert said, f"the probe has not come to its end ({done.returncode}): {done.stderr}"
        return Answer(done.returncode, done.stdout, said[1], float(said[2]) * 1e-3)

    return call


def motors_of(
    limb: LimbModel, stands: tuple[float, float], force_n: Sequence[float]
) -> tuple[float, float]:
    """Angles of the motors of a limb that stands at joint angles under a force, by the double-precision reference,
    which wants the motors'."""
    motors = np.array(stands)
    for _ in range(4):  # each leaves a tenth of what it misses
        rest = under_force(limb, motors[0], motors[1], force_n)
        motors = np.array(stands) - [rest["femur_rad"][0], -rest["tibia_rad"][0]]
    return float(motors[0]), float(motors[1])


@dataclass
class Sim:
    """A `brace sim` that runs."""

    can: str
    modbus: str


@contextmanager
def simulated(folder: Path, model: Path, *options: object, can: str | None = None) -> Iterator[Sim]:
    """`brace sim` of this model on free ports, until the end of the block. folder: for what it says when it fails."""
    ports = ("--can", can or "tcp://127.0.0.1:0", "--modbus", "modbus-tcp://127.0.0.1:0")
    command = [sys.executable, "-m", "brace", "sim", "--model", model, *ports, *options]
    with (folder / "errors").open("w+") as errors:
        process = subprocess.Popen(
            [*map(str, command), "--seconds", "1200", "--json"], stdout=subprocess.PIPE, stderr=errors, text=True
        )
        assert process.stdout is not None
        line = process.stdout.readline()
        if not line:
            errors.seek(0)
            pytest.fail("brace sim did not start: " + errors.read())
        ready = json.loads(line)
        assert ready["event"] == "ready"
        yield Sim(ready["limbs"][0]["can"], ready["limbs"][0]["modbus_tcp"])
        process.terminate()
        process.wait(timeout=60)
        process.stdout.close()


@pytest.fixture(scope="session")
def sim(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Sim]:
    """The paper's limb standing at (1.0, 1.4) rad, pressed so that the tip has a force. Its sensor is free of noise: K
    counts the force that it reads."""
    folder = tmp_path_factory.mktemp("sim")
    quiet = folder / "quiet.toml"
    quiet.write_text(LIMB.read_text() + "\n[sensor]\nnoise_n = 0.0\n")
    options = ("--plant", quiet, "--limbs", 2, "--press", "1.5,-3")
    with simulated(folder, LIMB, *options, can=os.environ.get("BRACE_TEST_CAN")) as running:
        yield running

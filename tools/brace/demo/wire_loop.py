"""The loop over the wire: a controller that believes one limb moves another one; its own loading tests show
what its model lacks, the model with that in it is pushed back, and the K it reports is nearer to the truth.

Every step is the command that a person would type, run as it is printed."""

from __future__ import annotations

import contextlib
import json
import math
import os
import queue
import subprocess
import sys
import threading
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from pathlib import Path

from brace.ground.errors import BraceError
from brace.model import LimbModel, load_limb

JOINT_KEY = "joint.femur.compliance_rad_per_n_mm"
SOFTER = 2.6  # the true femur drive against the believed one
NOISE_KEY, NOISE_N = "sensor.noise_n", 0.2  # of one sample; a reading is the mean of a dwell
POSTURES = ((1.0, 1.4), (0.4, 1.0), (1.2, 2.0), (-0.2, 1.7))
STEPS, STEP_MM = 3, 0.6
RECORD, FOUND = "wire-test", "wire-diagnosis"
DATA = Path(__file__).resolve().parents[1] / "data"
SPEED = 8  # times the clock
_LIMIT_S = 300.0
_READY_S = 60.0

Command = tuple[object, ...]


@dataclass(frozen=True)
class Turn:
    """What the loop came to: K [N/mm] at the load's posture, as k_xx, k_xz, k_zz."""

    posture: tuple[float, float]
    before: tuple[float, float, float]
    after: tuple[float, float, float]
    truth: tuple[float, float, float]
    diagnosis: dict[str, object]

    def off(self, k: tuple[float, float, float]) -> float:
        """How far a K is from the plant's: Frobenius norm of the difference over the plant's own."""

        def norm(m: tuple[float, float, float]) -> float:
            return math.sqrt(m[0] ** 2 + 2 * m[1] ** 2 + m[2] ** 2)

        a, b, c = (x - y for x, y in zip(k, self.truth, strict=True))
        return norm((a, b, c)) / norm(self.truth)


def true_limb(believed: LimbModel) -> LimbModel:
    """The limb as it is: its femur drive yields more than its maker says."""
    return believed.with_values({JOINT_KEY: SOFTER * believed.number(JOINT_KEY), NOISE_KEY: NOISE_N})


def play(folder: Path) -> Generator[str, None, Turn]:
    """Writes believed.toml, true.toml and all that the commands make into `folder`; yields what a person
    reads."""
    model = load_limb(DATA / "paper-limb.toml")
    (folder / "believed.toml").write_text(model.to_toml(["what the controller believes"]))
    (folder / "true.toml").write_text(true_limb(model).to_toml(["what is true"]))
    theta1, theta2 = POSTURES[0]
    for posture in POSTURES:
        start = _sim(posture)
        yield shown(start)
        with _controller(folder, start) as bus:
            record = (
                *("record", "--bus", bus, "--loading-test", "--add", "--steps", STEPS, "--step-mm", STEP_MM),
                *("--title", "loading tests over the wire", "--out", RECORD),
            )
            yield shown(record)
            run(folder, record)
    diagnose = ("diagnose", RECORD, "--model", "believed.toml", "--out", FOUND)
    yield shown(diagnose)
    yield from ("     " + line for line in run(folder, diagnose).splitlines()[:3])
    start = _sim(POSTURES[0])
    yield shown(start)
    with _controller(folder, start) as bus:
        ask = ("query", "--bus", bus, "--theta1", theta1, "--theta2", theta2, "--json")
        push = ("params", "push", f"{FOUND}/limb.toml", "--bus", bus)
        yield shown(ask)
        before = _k(run(folder, ask))
        yield shown(push)
        run(folder, push)
        yield shown(ask)
        after = _k(run(folder, ask))
    ask_true = ("k", "--model", "true.toml", "--theta1", theta1, "--theta2", theta2, "--json")
    yield shown(ask_true)
    truth = _k(run(folder, ask_true))
    return Turn(
        POSTURES[0], before, after, truth, json.loads((folder / FOUND / "diagnosis.json").read_text())
    )


def _sim(posture: tuple[float, float]) -> Command:
    # '=' since the angle may be negative
    return ("sim", "--model", "believed.toml", "--plant", "true.toml", f"--posture={posture[0]},{posture[1]}",
            "--speed", SPEED, "--can", "tcp://127.0.0.1:0", "--modbus", "none")  # fmt: skip


@contextlib.contextmanager
def _controller(folder: Path, start: Command) -> Iterator[str]:
    """`brace sim` running; gives the bus to talk to."""
    process = _start(folder, (*start, "--json"))
    try:
        ready = json.loads(_first_line(process))
        yield str(ready["limbs"][0]["can"])
    finally:
        process.terminate()
        try:
            process.communicate(timeout=10.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()


def _first_line(process: subprocess.Popen[str]) -> str:
    """Waited for no longer than a start can take."""
    lines: queue.Queue[str] = queue.Queue()
    assert process.stdout is not None and process.stderr is not None
    threading.Thread(target=lambda out=process.stdout: lines.put(out.readline()), daemon=True).start()
    try:
        line = lines.get(timeout=_READY_S)
    except queue.Empty:
        line = ""
    if not line:
        process.kill()
        raise BraceError("the simulated controller did not start", why=_reason(process.stderr.read()))
    return line


def run(folder: Path, command: Command) -> str:
    """One command; its stdout."""
    process = _start(folder, command)
    try:
        out, err = process.communicate(timeout=_LIMIT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.communicate()
        raise BraceError(
            f"brace {command[0]} takes longer than {_LIMIT_S:.0f} s", why="it was ended"
        ) from None
    except BaseException:
        process.kill()
        raise
    if process.returncode != 0:
        raise BraceError(f"brace {command[0]} ended with {process.returncode}", why=_reason(err))
    return out


def _start(folder: Path, command: Command) -> subprocess.Popen[str]:
    environment = {name: value for name, value in os.environ.items() if name != "BRACE_DEBUG"}
    # The Debian package's brace is in a folder of its own, where only its own start looks.
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, (str(DATA.parents[1]), environment.get("PYTHONPATH"))))
    return subprocess.Popen([sys.executable, "-m", "brace", *map(str, command)], cwd=folder, env=environment,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)  # fmt: skip


def shown(command: Command) -> str:
    return "   $ brace " + " ".join(f"'{part}'" if " " in str(part) else str(part) for part in command)


def _k(text: str) -> tuple[float, float, float]:
    """K of a --json answer."""
    data = json.loads(text)
    return tuple(float(data[f"k_{entry}_n_per_mm"]) for entry in ("xx", "xz", "zz"))  # type: ignore[return-value]


def _reason(text: str) -> str:
    """What a command said went wrong: the head of its error, else its last words."""
    lines = text.strip().splitlines() or ["it says nothing"]
    return next((line.removeprefix("brace: ") for line in lines if line.startswith("brace: ")), lines[-1])

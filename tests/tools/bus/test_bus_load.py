"""What the load makes of K, as `brace query`, `monitor`, `record`, `sim` and `gravity` tell it, over CAN and Modbus."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command_bench import LIMB, PROJECT, Outcome, running

from brace.bus.can_controller import CanController
from brace.bus.load import LOAD_ENTRIES, factor_words, load_of
from brace.bus.open import open_bus
from brace.bus.session import Session
from brace.bus.url import parse
from brace.model import load_limb
from brace.native.loaded import under_force

POSTURE = (0.3, 0.6)
MATRIX = ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm")
UNLOADED = tuple(f"unloaded_{name}" for name in MATRIX)
K_RATIO = 0.0014  # docs/loaded.md: the estimator's worst error of K
STEP_N_PER_MM, STEP_N, STEP_MM = 0.0005, 0.001, 0.001
LOAD_HZ = 20
MORE = f"""
[gravity]
femur_n = 2.0
tibia_n = 1.5
knee_n = 3.0
[sensor]
noise_n = 0.0
[controller]
load_hz = {LOAD_HZ}
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("load") / "limb.toml"
    path.write_text(LIMB + MORE)
    return path


@pytest.fixture(scope="module")
def ports(model: Path) -> Iterator[dict[str, Any]]:
    """A limb whose foot is pressed by some newtons."""
    given = ("--can", "tcp://127.0.0.1:0", "--modbus", "modbus-tcp://127.0.0.1:0", "--posture", "0.3,0.6")
    with running(model, *given, "--press=-2,-10") as (_, ready):
        yield ready["limbs"][0]


@pytest.fixture(params=["can", "modbus_tcp"])
def url(request: pytest.FixtureRequest, ports: dict[str, Any]) -> str:
    return str(ports[request.param])


def matrix(entry: dict[str, Any], names: tuple[str, ...] = MATRIX) -> np.ndarray:
    xx, xz, zz = (entry[name] for name in names)
    return np.array([[xx, xz], [xz, zz]])


def test_query_tells_the_load_and_what_it_does(brace: Callable[..., Outcome], url: str) -> None:
    entry = json.loads(brace("query", "--bus", url, "--json").out)
    load = entry["load"]
    assert load["is_counted"] and math.hypot(load["force_x_n"], load["force_z_n"]) > 5.0
    assert load["gravity_direction_rad"] == pytest.approx(-math.pi / 2, abs=1e-4)
    changed = np.linalg.norm(matrix(entry) - matrix(load, UNLOADED)) / np.linalg.norm(matrix(load, UNLOADED))
    assert changed > 0.02
    told = brace("query", "--bus", url).out
    assert "load counted: force of the ground on the tip" in told and "they move the tip by" in told
    assert f"buckling factor {load['buckling_factor']:.1f}" in told  # with its words behind it
    assert "K without load = [" in told and f"the load changes K by {changed:.1%}" in told


def test_an_open_gap_is_not_the_loads_doing() -> None:
    load = load_of(dict.fromkeys(LOAD_ENTRIES, 2.0))
    closed, opened = (load.lines((0.0, 0.0, 0.0), is_open)[-1] for is_open in (False, True))
    assert "the load changes K by 100.0%" in closed
    assert "K without load = [" in opened and "with every gap closed" in opened and "changes" not in opened


def test_query_at_a_place_under_a_force(brace: Callable[..., Outcome], url: str, model: Path) -> None:
    at = ("--theta1", POSTURE[0], "--theta2", POSTURE[1])
    for force in ((-20.0, 0.0), (0.0, 10.0)):
        outcome = brace("query", "--bus", url, *at, "--fx", force[0], "--fz", force[1], "--json")
        assert outcome.code == 0, outcome.err
        entry = json.loads(outcome.out)
        exact = under_force(load_limb(model), *POSTURE, [force])
        k, moved = exact.k_n_per_mm[0], exact.displacement_mm[0]
        assert np.abs(matrix(entry) - k).max() <= 0.5 * STEP_N_PER_MM + K_RATIO * np.linalg.norm(k)
        room_mm = 0.5 * STEP_MM + K_RATIO * float(np.linalg.norm(moved))
        assert [entry["tip_dx_mm"], entry["tip_dz_mm"]] == pytest.approx(list(moved), abs=room_mm)
    told = brace("query", "--bus", url, *at, "--fx", -40, "--fz", 0).out
    assert "force and weight move the tip by" in told and "flag SOFTENED: The load has softened the limb" in told
    assert "below 3 a limb is much softer than without load" in told
    folded = brace("query", "--bus", url, *at, "--fx", -2000, "--fz", 0)
    assert folded.code == 2 and "it folds the limb there" in folded.err and "smaller force" in folded.err


def test_monitor_tells_the_load(brace: Callable[..., Outcome], url: str) -> None:
    line = brace("monitor", "--bus", url, "--seconds", 0.8).out.splitlines()[-1]
    assert "; load " in line and "moved " in line and "buckling factor " in line and "K without load " in line
    lines = [json.loads(one) for one in brace("monitor", "--bus", url, "--seconds", 0.8, "--json").out.splitlines()]
    loaded = [entry for entry in lines if "load" in entry]
    k = [entry for entry in lines if entry["event"] in ("stiffness", "posture")]
    assert len(loaded) > 5 and k
    for entry in loaded:
        load = entry["load"]
        assert load["is_counted"] and load["buckling_factor"] > 3.0
        # the load of this K: the controller stands still, so K differs from the one without load by as much each time
        assert np.linalg.norm(matrix(entry) - matrix(load, UNLOADED)) > 0.02 * np.linalg.norm(matrix(entry))


def test_a_terminal_sees_the_load(url: str) -> None:
    from brace.bus.watch import NodeState
    from brace.cli.monitor_display import _lines
    from brace.bus.load import LOAD_ENTRIES, Load
    from brace.bus.snapshot import Snapshot

    state = NodeState()
    values = dict(zip(LOAD_ENTRIES, (17.0, -3.0, 0.8, -10.0, 2.5, -1.0, -5.0, 2.5, -1.57, 0.0), strict=True))
    snapshot = Snapshot(1, 100.0, 7, 16.0, -3.0, 0.8, ("SOFTENED", "LOAD_UNKNOWN"), 1.0, load=Load(values))
    state.snapshot = state.load = snapshot
    text = "\n".join(_lines(state))
    assert "load -10.000 2.500 N" in text and "buckling factor 2.50" in text and "K without load 17.0000" in text
    assert "flag SOFTENED: the load makes it much softer" in text and "flag LOAD_UNKNOWN: no load counted" in text
    state.load = Snapshot(1, 90.0, 7, 16.0, -3.0, 0.8, (), 1.0, load=Load(values))  # of ten seconds ago
    assert "K without load" not in "\n".join(_lines(state))


def test_sim_tells_the_load(brace: Callable[..., Outcome], model: Path) -> None:
    given = ("sim", "--model", model, "--posture", "0.3,0.6", "--press=-2,-10", "--fast", "--seconds", 0.5,
             "--can", "none", "--modbus", "none")  # fmt: skip
    told = brace(*given).out
    assert "load " in told and "buckling factor " in told and "K without load " in told
    end = json.loads(brace(*given, "--json").out.splitlines()[-1])
    load = end["limbs"][0]["load"]
    assert load["is_counted"] and load["force_x_n"] == pytest.approx(end["limbs"][0]["truth"]["force_x_n"], abs=STEP_N)


def test_an_invalid_k_says_why_in_words(brace: Callable[..., Outcome], model: Path) -> None:
    given = ("--can", "tcp://127.0.0.1:0", "--modbus", "none", "--fault", "sensor_dead:femur@0.1")
    with running(model, *given) as (_, ready):
        can = ready["limbs"][0]["can"]
        brace("monitor", "--bus", can, "--seconds", 0.5)
        outcome = brace("query", "--bus", can)
    assert outcome.code == 5 and "no load is counted" in outcome.out
    assert "flag STALE: K is older than its age limit" in outcome.out


def test_a_log_keeps_the_load(brace: Callable[..., Outcome], ports: dict[str, Any], tmp_path: Path) -> None:
    """Frames of the load are in both kinds of log, decoded by replay and in MCAP's own topic; the DBC names them."""
    recorded = brace("record", "--bus", ports["can"], "--out", tmp_path / "a.log", "--seconds", 1.0)
    assert recorded.code == 0, recorded.err
    replayed = brace("replay", tmp_path / "a.log", "--json").out
    loads = [entry["load"] for line in replayed.splitlines() if "load" in (entry := json.loads(line))]
    assert len(loads) > 0.5 * LOAD_HZ
    assert brace("record", "--bus", f"log:{tmp_path / 'a.log'}", "--out", tmp_path / "a.mcap").code == 0
    assert brace("replay", tmp_path / "a.mcap", "--json").out == replayed

    from mcap.reader import make_reader

    with (tmp_path / "a.mcap").open("rb") as file:
        told = [json.loads(message.data) for _, _, message in make_reader(file).iter_messages(["/limb_1/stiffness"])]
    assert [entry["load"] for entry in told if "load" in entry] == loads

    can, cantools = pytest.importorskip("can"), pytest.importorskip("cantools")
    database = cantools.database.load_file(PROJECT / "firmware" / "interface" / "brace.dbc")
    theirs: list[dict[str, float]] = [{}]
    for message in can.CanutilsLogReader(str(tmp_path / "a.log")):
        if message.arbitration_id == 0x201:
            values = database.decode_message(0x201, message.data, decode_choices=False)
            if "load_unloaded_k_xx" in values:
                theirs.append({})
            theirs[-1] |= {name.removeprefix("load_"): value for name, value in values.items()}
    whole = [one for one in theirs if {"unloaded_k_xx", "counted_force_x", "moved_x", "buckling_factor"} <= one.keys()]
    ours = {(load["unloaded_k_xx_n_per_mm"], load["force_x_n"], load["moved_x_mm"]) for load in loads}
    found = {(one["unloaded_k_xx"], one["counted_force_x"], one["moved_x"]) for one in whole}
    assert ours <= found


def test_gravity_is_told_and_asked(brace: Callable[..., Outcome], url: str, model: Path) -> None:
    def asked() -> tuple[float, float]:
        entry = json.loads(brace("gravity", "--bus", url, "--json").out)
        return entry["gravity_direction_rad"], entry["gravity_lean_rad"]

    upright = pytest.approx((-math.pi / 2, 0.0), abs=1e-6)
    assert asked() == upright
    try:
        said = brace("gravity", "--bus", url, "--direction", 0.4, "--lean", -0.3)
        assert said.code == 0 and "down is 0.4000 rad from +x" in said.out
        assert "until the controller's next start" in said.out
        assert asked() == pytest.approx((0.4, -0.3), abs=1e-6)
        at = ("--theta1", POSTURE[0], "--theta2", POSTURE[1], "--fx", 0, "--fz", 0)
        k = json.loads(brace("query", "--bus", url, *at, "--json").out)
        limb = load_limb(model)
        names = [f"gravity.{part}_n" for part in ("femur", "tibia", "knee")]
        weights = {name: limb.number(name) * math.cos(-0.3) for name in names}
        exact = under_force(limb.with_values(weights), *POSTURE, [(0.0, 0.0)], 0.4).k_n_per_mm[0]
        assert np.abs(matrix(k) - exact).max() <= 0.5 * STEP_N_PER_MM + K_RATIO * np.linalg.norm(exact)
        told = json.loads(brace("gravity", "--bus", url, "--direction", -0.2, "--json").out)
        assert (told["gravity_direction_rad"], told["gravity_lean_rad"]) == pytest.approx((-0.2, 0.0), abs=1e-6)
    finally:
        assert brace("gravity", "--bus", url, "--as-parameters").code == 0
    assert asked() == upright


@pytest.mark.parametrize(
    "given", [("--direction", 4), ("--lean", 0.1), ("--direction", 0.1, "--lean", 2), ("--direction", "nan"),
              ("--direction", 0.1, "--as-parameters")],
)  # fmt: skip
def test_what_is_no_direction(brace: Callable[..., Outcome], ports: dict[str, Any], given: tuple[object, ...]) -> None:
    outcome = brace("gravity", "--bus", ports["can"], *given)
    assert outcome.code == 2 and "try:" in outcome.err


def test_clients_that_ask_under_other_forces_at_once(ports: dict[str, Any], model: Path) -> None:
    """A controller counts the force that was told last. Whom another client comes between asks again."""
    forces = [(0.0, 10.0), (-20.0, 0.0), (6.0, 4.0)]

    def answers(force: tuple[float, float]) -> list[Any]:
        bus = open_bus(parse(ports["can"]), 1_000_000)
        try:
            device = CanController(Session(bus, 1))
            return [device.k_at_posture(*POSTURE, force) for _ in range(30)]
        finally:
            bus.close()

    with ThreadPoolExecutor(len(forces)) as clients:
        told = list(clients.map(answers, forces))
    for force, found in zip(forces, told, strict=True):
        k = under_force(load_limb(model), *POSTURE, [force]).k_n_per_mm[0]
        for answer in found:
            size = float(np.linalg.norm(k))
            got = (answer.k_xx, answer.k_xz, answer.k_zz)
            assert got == pytest.approx((k[0, 0], k[0, 1], k[1, 1]), abs=0.5 * STEP_N_PER_MM + K_RATIO * size)


def test_words_for_a_buckling_factor() -> None:
    assert factor_words(None) == "not known"
    assert factor_words(math.inf).startswith("none") and factor_words(2.0).startswith("2.00: ")
    assert "much softer" in factor_words(2.0) and "much softer" not in factor_words(4.0)

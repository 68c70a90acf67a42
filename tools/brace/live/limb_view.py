"""What the page shows of one limb: numbers with their units in the names, and sentences for what has a meaning."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import TypedDict

from brace.bus.load import Load
from brace.bus.open_play import open_joints
from brace.bus.sigma import Sigma
from brace.bus.snapshot import Snapshot
from brace.bus.watch import NodeState
from brace.live.card import Card
from brace.wire.code import CodeTable
from brace.wire.codes import FAULT, FLAG, MODE
from brace.wire.layout import Value

SILENT_S = 2.0  # a heartbeat comes each second
LOAD_LATE_S = 2.0  # it may come more seldom than K
_KNOWN_MOST = 256  # so many words are kept, because the page asks for them thirty times a second and they hardly change

_NO_LOAD_SENT = "not sent: controller.load_hz is 0 (set it in limb.toml, then brace params push)"
_NO_LOAD_COUNTED = "no load is counted: K is the one without load"

_PLAY_WORDS = {  # of one joint: which side of its backlash is loaded
    "unknown": "not known which side of the backlash is loaded",
    "taking_up": "backlash is being taken up",
    "engaged_positive": "positive side of the backlash is loaded",
    "engaged_negative": "negative side of the backlash is loaded",
    "crossing": "backlash is open",
    "fault": "backlash not known: bad samples",
}


class Said(TypedDict):
    """A name of the dictionary, and what it means."""

    name: str
    text: str


class Play(TypedDict):
    """One joint's backlash."""

    joint: str
    state: str
    text: str


class LoadView(TypedDict):
    """The load that K counts."""

    force_n: list[Value]  # x, z: of the ground on the tip
    moved_mm: list[Value]
    unloaded_k_n_per_mm: list[Value]  # xx, xz, zz
    buckling_factor: Value  # None: none, or not known


class LimbWords(TypedDict):
    """What a limb reports that seldom changes. None: not known."""

    node: int
    name: str
    lengths_mm: list[float] | None  # coxa, femur, tibia
    lengths_why: str  # why they are not known
    load_why: str  # why there is no load
    play: list[Play]
    mode: str
    mode_text: str
    faults: list[Said]
    flags: list[Said]


class LimbNumbers(TypedDict):
    """What a limb reports that changes with every update. None: not known."""

    node: int
    silent_s: float | None  # None: it is heard
    rate_hz: float
    age_ms: Value
    is_valid: bool
    k_n_per_mm: list[Value]  # xx, xz, zz
    sigma_k_n_per_mm: list[Value] | None  # one sigma of each, as the controller says
    lambda_n_per_mm: list[Value]  # least, greatest
    stiff_axis_rad: Value
    relative_sigma: list[float] | None  # of the two eigenvalues: the controller's, else, without load, the model's
    theta_rad: list[Value]  # coxa, femur, tibia
    k_space_n_per_mm: list[Value] | None  # xx xy xz yy yz zz, in the robot's frame
    lambda_space_n_per_mm: list[Value] | None
    sigma_lambda_space_n_per_mm: list[Value] | None  # one sigma of each, as the controller says
    load: LoadView | None


def limb_words(node: int, state: NodeState, card: Card) -> LimbWords:
    """An equal object from before, if there is one, so that its text need not be made again."""
    k, load = _k(state), _recent_load(state)
    return _words(
        node,
        card,
        state.space.space.play_coxa if state.space is not None and state.space.space is not None else "",
        () if k is None else k.play,
        () if k is None else k.flags,
        state.mode,
        state.faults or (),
        _NO_LOAD_SENT if load is None else "" if load.is_counted else _NO_LOAD_COUNTED,
    )


def limb_numbers(node: int, state: NodeState, card: Card, now_s: float) -> LimbNumbers:
    """The newest of a limb. Everything of K is of one snapshot, the newest that came with its posture."""
    k = _k(state)
    theta1, theta2 = (k.theta1, k.theta2) if k is not None else (None, None)
    reported = _recent_sigma(state)
    sigmas = _relative(reported, k)
    load = _load_view(_recent_load(state))
    if sigmas is None and load is None and theta1 is not None and theta2 is not None:  # the model's is of K without load
        sigmas = card.relative_sigmas(theta1, theta2)
    space = state.space.space if state.space is not None else None
    silent_s = now_s - state.last_s
    return {
        "node": node,
        "silent_s": round(silent_s, 1) if silent_s > SILENT_S else None,
        "rate_hz": round(state.rate_hz, 1),
        "age_ms": k.age_ms if k is not None else None,
        "is_valid": k is not None and k.is_valid,
        "sigma_k_n_per_mm": list(reported.k) if reported is not None and reported.is_known else None,
        "k_n_per_mm": [k.k_xx, k.k_xz, k.k_zz] if k is not None else [None, None, None],
        "lambda_n_per_mm": [k.lambda_min, k.lambda_max] if k is not None else [None, None],
        "stiff_axis_rad": k.stiff_axis if k is not None else None,
        "relative_sigma": None if sigmas is None else [round(sigma, 4) for sigma in sigmas],
        "theta_rad": [space.theta0 if space is not None else None, theta1, theta2],
        "k_space_n_per_mm": None if space is None else list(space.k),
        "lambda_space_n_per_mm": None if space is None else list(space.eigenvalues),
        "sigma_lambda_space_n_per_mm": _space_sigmas(reported),
        "load": load,
    }


def _k(state: NodeState) -> Snapshot | None:
    return state.posture or state.snapshot


def _recent_load(state: NodeState) -> Load | None:
    reported, newest = state.load, state.snapshot
    is_recent = reported is not None and newest is not None and newest.time_s - reported.time_s <= LOAD_LATE_S
    return reported.load if reported is not None and is_recent else None


def _recent_sigma(state: NodeState) -> Sigma | None:
    reported, newest = state.sigma, state.snapshot
    is_recent = reported is not None and newest is not None and newest.time_s - reported.time_s <= LOAD_LATE_S
    return reported.sigma if reported is not None and is_recent else None


def _space_sigmas(reported: Sigma | None) -> list[Value] | None:
    if reported is None or reported.space is None:
        return None
    return [reported.space[f"space_lambda_{number}"] for number in (1, 2, 3)]


def _relative(sigma: Sigma | None, k: Snapshot | None) -> tuple[float, float] | None:
    """One sigma of the two eigenvalues, as a fraction of each. None: not known."""
    if sigma is None or k is None:
        return None
    shares = [
        None if one is None or not of else float(one) / float(of)
        for one, of in ((sigma.values["lambda_min"], k.lambda_min), (sigma.values["lambda_max"], k.lambda_max))
    ]
    least, most = shares
    return None if least is None or most is None else (least, most)


def _load_view(load: Load | None) -> LoadView | None:
    if load is None or not load.is_counted:
        return None
    v = load.values
    factor = v["buckling_factor"]
    return {
        "force_n": [v["counted_force_x"], v["counted_force_z"]],
        "moved_mm": [v["moved_x"], v["moved_z"]],
        "unloaded_k_n_per_mm": [v["unloaded_k_xx"], v["unloaded_k_xz"], v["unloaded_k_zz"]],
        "buckling_factor": None if factor is None or math.isinf(factor) else factor,
    }


@lru_cache(maxsize=_KNOWN_MOST)
def _words(
    node: int,
    card: Card,
    coxa: str,
    femur_and_tibia: tuple[str, ...],
    flags: tuple[str, ...],
    mode: str,
    faults: tuple[str, ...],
    load_why: str,
) -> LimbWords:
    states = [] if not coxa else [("coxa", coxa)]
    states += zip(("femur", "tibia"), femur_and_tibia, strict=False)
    opened = [joint for joint in open_joints(flags, femur_and_tibia) if joint not in card.tight_joints]
    return {
        "node": node,
        "name": card.name,
        "lengths_mm": None if card.lengths_mm is None else list(card.lengths_mm),
        "lengths_why": card.why_not,
        "load_why": load_why,
        "play": [
            {"joint": joint, "state": state, "text": _PLAY_WORDS.get(state, state) + _help(joint, opened)}
            for joint, state in states
            if joint not in card.tight_joints
        ],
        "mode": mode,
        "mode_text": _text(MODE, mode.upper()),
        "faults": [{"name": name.upper(), "text": _text(FAULT, name.upper())} for name in faults],
        "flags": [{"name": name.upper(), "text": _text(FLAG, name.upper())} for name in flags],
    }


def _help(joint: str, opened: Sequence[str]) -> str:
    """What takes up play that leaves K open."""
    return f"; brace take-up {joint}- --bus URL (or {joint}+) takes it up" if joint in opened else ""


def _text(table: CodeTable, name: str) -> str:
    return table.texts.get(name, "")

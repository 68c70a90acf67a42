"""The C client against the emulated board's image: its SLCAN port and its Modbus RTU port."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator

import pytest
from conftest import PATIENT_MS, PROJECT, Answer
from test_against_sim import INDEX, POSTURE, check_k

sys.path.append(str(PROJECT / "tests" / "socketcan"))
from processes import SLOWLY, emulated  # noqa: E402

Probe = Callable[..., Answer]


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """Ports of a controller with the paper's limb."""
    with emulated(tmp_path_factory.mktemp("board"), clock=SLOWLY) as places:
        yield {"can": f"slcan:{places['slcan']}", "modbus": f"modbus:{places['modbus']}"}


@pytest.mark.parametrize("way", ["can", "modbus"])
def test_k_of_now_and_elsewhere(probe: Probe, board: dict[str, str], way: str) -> None:
    now = probe(board[way], "read", 7, 1, timeout_ms=PATIENT_MS)
    assert now.code == 0, now.err
    [snapshot] = now.snapshots
    assert snapshot["parts"] == 7 and snapshot["valid"] == 1
    for posture in (POSTURE, (0.2, 1.9)):
        there = probe(board[way], "posture", *posture, timeout_ms=PATIENT_MS)
        assert there.code == 0, there.err
        check_k(there.values, posture)
    entry = probe(board[way], "entry_f32", INDEX["probe_f32"], timeout_ms=PATIENT_MS)
    assert entry.values == {"value": 12345.5}

"""The database of several nodes, read by cantools: every frame of every node decodes as node 1's does."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cantools
import pytest
from command_bench import Outcome

from brace.wire.dbc import CLASSIC, FD, for_nodes

NODES = (1, 2, 64, 127)


def loaded(text: str) -> Any:
    return cantools.database.load_string(text, "dbc", strict=True)


@pytest.mark.parametrize("template", [CLASSIC, FD])
def test_each_node_decodes_as_node_1_does(template: Path) -> None:
    rng = random.Random(7)
    one, several = loaded(template.read_text()), loaded(for_nodes(template.read_text(), NODES))
    assert len(several.messages) == len(NODES) * len(one.messages)
    assert sorted(node.name for node in several.nodes) == sorted([*(f"LIMB_{n}" for n in NODES), "ROBOT"])
    for message in one.messages:
        for node in NODES:
            moved = several.get_message_by_frame_id(message.frame_id - 1 + node)
            assert moved.name == f"{message.name}_{node}" and moved.comment == message.comment
            assert moved.senders == [name.replace("LIMB", f"LIMB_{node}") for name in message.senders]
            assert moved.signal_tree == message.signal_tree
            for here, there in zip(message.signals, moved.signals):
                assert (here.choices, here.is_float, here.comment) == (there.choices, there.is_float, there.comment)
            data = rng.randbytes(message.length)
            if not message.is_multiplexed():
                told = [str(one.decode(data, allow_truncated=True)) for one in (message, moved)]
                assert told[0] == told[1]


def test_one_node_keeps_the_plain_names() -> None:
    assert for_nodes(CLASSIC.read_text(), [1]) == CLASSIC.read_text()
    (stiffness,) = [one for one in loaded(for_nodes(CLASSIC.read_text(), [9])).messages if one.name == "stiffness_a"]
    assert stiffness.frame_id == 0x180 + 9 and stiffness.senders == ["LIMB"]


def test_the_command_writes_it_and_refuses_one_node_twice(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    out = tmp_path / "robot.dbc"
    assert brace("dbc", "--nodes", 1, 2, "--out", out).code == 0
    assert loaded(out.read_text()).get_message_by_frame_id(0x182).name == "stiffness_a_2"
    assert loaded(brace("dbc", "--fd").out).messages
    twice = brace("dbc", "--nodes", 3, 3)
    assert twice.code == 2 and "3 twice" in twice.err
    commas = brace("dbc", "--nodes", "1,2")
    assert commas.code == 2 and "--nodes 1 2" in commas.err
    assert brace("dbc", "--nodes", 128).code == 2
    told = json.loads(brace("dbc", "--nodes", 1, 2, "--json").out)
    assert told["nodes"] == [1, 2] and loaded(told["dbc"]).get_message_by_frame_id(0x182).name == "stiffness_a_2"
    told = json.loads(brace("dbc", "--fd", "--out", out, "--json").out)
    assert told == {"nodes": [1], "fd": True, "written": [str(out)]} and loaded(out.read_text()).messages

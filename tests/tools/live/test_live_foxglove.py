"""`brace monitor --foxglove`: read by a client that speaks Foxglove's WebSocket protocol itself."""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from command_bench import FREE, LIMB, Outcome, running, spawn

pytest.importorskip("foxglove")
PROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
MESSAGE, HEADER_BYTES = 1, 13  # a binary message: its kind, subscription, time
WAIT_S = 30.0


async def first_message(address: str) -> tuple[str, dict[str, object]]:
    """The topic and the first message of the first channel that is offered."""
    import aiohttp

    async with aiohttp.ClientSession() as client, client.ws_connect(address, protocols=PROTOCOLS) as socket:
        topics: dict[int, str] = {}
        async for message in socket:
            if message.type == aiohttp.WSMsgType.TEXT:
                told = json.loads(message.data)
                if told["op"] == "advertise":
                    for channel in told["channels"]:
                        assert channel["encoding"] == "json"
                        topics[channel["id"]] = channel["topic"]
                        await socket.send_json(
                            {"op": "subscribe", "subscriptions": [{"id": channel["id"], "channelId": channel["id"]}]}
                        )
            elif message.data[0] == MESSAGE:
                (subscription,) = struct.unpack_from("<I", message.data, 1)
                return topics[subscription], json.loads(message.data[HEADER_BYTES:])
    raise AssertionError("no message")


def test_a_viewer_sees_each_k(tmp_path: Path) -> None:
    limb = tmp_path / "limb.toml"
    limb.write_text(LIMB)
    with running(limb, *FREE) as (_, ready):
        process = spawn("monitor", "--bus", ready["limbs"][0]["can"], "--foxglove", "0")
        try:
            assert process.stdout is not None
            address = process.stdout.readline().split()[1]
            topic, told = asyncio.run(asyncio.wait_for(first_message(address), WAIT_S))
        finally:
            process.terminate()
            assert process.wait(timeout=WAIT_S) == 0
    assert topic == "/limb_1/stiffness"
    assert isinstance(told["k_xx_n_per_mm"], float) and told["k_is_valid"] is True


def test_registers_are_not_sent_on(brace: Callable[..., Outcome]) -> None:
    outcome = brace("monitor", "--bus", "modbus-tcp://127.0.0.1:1/1", "--foxglove")
    assert outcome.code == 2 and "over Modbus" in outcome.err

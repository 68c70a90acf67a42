"""Nobody waits for ever, and no wrong answer is believed: the C client against a controller that misbehaves."""

from __future__ import annotations

import contextlib
import os
import pty
import socket
import subprocess
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import PRINT_K, Answer
from slcan_controller import SlcanController

from brace.wire.frames import DICTIONARY_HASH

USAGE, NO_DEVICE, NO_KERNEL, DOWN, TIMEOUT, SILENT, BIT_RATE, NODE, VERSION, REFUSED, UNSUPPORTED = (
    1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12,
)  # fmt: skip
Probe = Callable[..., Answer]


def test_identity_and_entry(probe: Probe) -> None:
    with SlcanController(node=5) as controller:
        who = probe(controller.url, "identity", node=5)
        assert who.code == 0, who.err
        assert who.values == {
            "node": 5, "hash": DICTIONARY_HASH, "version": 0x010203, "crc": 0x12345678, "origin": 2,
        }  # fmt: skip
        assert probe(controller.url, "entry_f32", 4096, node=5).values == {"value": 12345.5}


def test_node_0_is_the_first_that_is_heard(probe: Probe) -> None:
    with SlcanController(node=101) as controller:
        assert probe(controller.url, "identity", node=0).values["node"] == 101


def test_another_dictionary_is_refused_and_both_are_named(probe: Probe) -> None:
    with SlcanController(hash_=0x1234ABCD) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == VERSION and "exit 6" in answer.err
        assert "0x1234abcd" in answer.err and f"0x{DICTIONARY_HASH:08x}" in answer.err


def test_another_dictionary_that_only_the_heartbeat_reports(probe: Probe) -> None:
    with SlcanController(hash_=0x1234ABCD, answers=False) as controller:
        assert probe(controller.url, "identity").code == VERSION


def test_a_controller_of_protocol_1(probe: Probe) -> None:
    """Its answers have the numbers of other answers; its heartbeat says so."""
    with SlcanController(hash_=0x1234ABCD, numbers_answers=False) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == VERSION and "0x1234abcd" in answer.err


def test_wrong_node(probe: Probe) -> None:
    with SlcanController(node=3) as controller:
        answer = probe(controller.url, "identity", node=7)
        assert answer.code == NODE and "exit 4" in answer.err
        assert "heard: 3" in answer.err and "try node 3" in answer.err
        assert answer.reported_in_time


def test_silence(probe: Probe) -> None:
    with SlcanController(speaks=False, answers=False) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == SILENT and "powered" in answer.err and "exit 4" in answer.err
        assert answer.reported_in_time


def test_wrong_bit_rate_as_an_adapter_reports_it(probe: Probe) -> None:
    with SlcanController(speaks=False, answers=False, errors=0x80) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == BIT_RATE and "bit rate" in answer.err and "exit 4" in answer.err
        assert answer.reported_in_time


def test_wrong_baud_rate_of_the_serial_line(probe: Probe) -> None:
    with SlcanController(speaks=False, answers=False, garbage=b"\xf0\x81\r\x05\xfe\r") as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == BIT_RATE and answer.reported_in_time


@pytest.mark.parametrize("what", [b"\r", b"z", b"T000000010\r", b"\xf0\x81\r", b"t70015\r"])
def test_an_endless_flood_of_what_is_no_frame(probe: Probe, what: bytes) -> None:
    """More of it is there whenever the client looks: empty lines, a line without an end, another kind of frame, noise,
    half a frame."""
    with SlcanController(flood=what * (65536 // len(what))) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code in (SILENT, BIT_RATE) and "exit 4" in answer.err and answer.reported_in_time, answer.err
        answer = probe(controller.url, "dump", 200)
        assert answer.code == TIMEOUT and answer.reported_in_time and answer.out.splitlines()[0] == "open"


def test_a_peer_that_goes_is_reported_and_kills_nobody(probe: Probe) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:

        def hang_up() -> None:
            taken, _ = server.accept()
            taken.recv(100)
            taken.close()

        threading.Thread(target=hang_up, daemon=True).start()
        answer = probe(f"tcp://127.0.0.1:{server.getsockname()[1]}", "dump", 500)
        assert answer.code == DOWN  # -13 would be SIGPIPE, of the farewell to nobody
        assert answer.reported_in_time


def test_heard_but_no_answer(probe: Probe) -> None:
    with SlcanController(answers=False) as controller:
        answer = probe(controller.url, "identity")
        assert answer.code == TIMEOUT and "is heard" in answer.err and answer.reported_in_time


def test_the_other_end_hangs_up(probe: Probe) -> None:
    with SlcanController(hangs_up=True) as controller:
        answer = probe(controller.url, "identity", timeout_ms=8000)
        assert answer.code == DOWN and answer.own_s < 6.0  # at once, long before it would give up


def test_refusal(probe: Probe) -> None:
    with SlcanController() as controller:
        answer = probe(controller.url, "entry_u32", 77)
        assert answer.code == REFUSED and "refusal -3" in answer.err and "outside its stated range" in answer.err


@pytest.mark.parametrize(
    ("status", "detail", "words"),
    [
        (-3, 8, "play is open"), (-3, 0, "outside its stated range"), (-15, 16, "not valid"), (-66, 0, "ask again"),
        (-64, 22, "no such question"),
    ],
)  # fmt: skip
def test_refusals_in_words_for_what_was_asked(probe: Probe, status: int, detail: int, words: str) -> None:
    with SlcanController(refuses_force=(status, detail)) as controller:
        answer = probe(controller.url, "force", 0, -1)
        assert answer.code == REFUSED and f"refusal {status}" in answer.err and words in answer.err, answer.err


@pytest.mark.parametrize(("errors", "status"), [(0, SILENT), (0x80, BIT_RATE)])
def test_silence_holds_a_control_loop_up_no_longer_than_its_time_out(probe: Probe, errors: int, status: int) -> None:
    """It has answered, and then says nothing more. An adapter's error flags are known all the same: to a later read."""
    with SlcanController(speaks=False, errors=errors) as controller:
        loop = probe(controller.url, "loop", 20, 1000).values
        # 50 of 20 ms each; of a busy machine a fifth is asked. Waiting 250 ms for the adapter's flags there would be 4
        assert loop["good"] == 0 and loop["failed"] >= 10 and loop["last_failure"] == status, loop


def test_what_was_broken_before_it_was_heard_is_no_wrong_bit_rate(probe: Probe) -> None:
    """Noise while the line was opened; it has answered since, and is silent now."""
    with SlcanController(speaks=False, noise_first=b"\xf0\x81\rt70015\r") as controller:
        assert probe(controller.url, "loop", 20, 300).values["last_failure"] == SILENT


@pytest.mark.parametrize(("speaks", "status"), [(False, SILENT), (True, TIMEOUT)])
def test_what_was_heard_before_a_question_is_no_sign_of_life(probe: Probe, speaks: bool, status: int) -> None:
    with SlcanController(speaks=speaks) as controller:  # answers identify, not this
        answer = probe(controller.url, "posture", 1, 1.4)
        assert answer.code == status, answer.err


def test_answers_to_others_are_not_believed(probe: Probe) -> None:
    with SlcanController() as controller:
        assert probe(controller.url, "entry_u32", 78).values == {"value": 333}


def test_parts_of_two_answers_are_not_mixed(probe: Probe) -> None:
    with SlcanController() as controller:
        force = probe(controller.url, "force", 1, 1)
        assert force.code == 0, force.err
        assert force.values == {"fx": 2.0, "fz": 2.0, "low": 2.0, "high": 2.0}
        tokens = [request[1] for request in controller.requests if request[0] == 6]
        assert len(tokens) == len(set(tokens)) == 2


def test_another_client_with_the_same_token(probe: Probe) -> None:
    with SlcanController(echo_first=True) as controller:
        entry = probe(controller.url, "entry_f32", 1)
        assert entry.values == {"value": 12345.5}


def test_values_out_of_range_are_not_sent(probe: Probe) -> None:
    with SlcanController() as controller:
        for call in (("posture", 9, 1), ("posture", "nan", 1), ("tip", 9000, 0, 1), ("force", 900, 0),
                     ("sag", "inf", 0)):
            assert probe(controller.url, *call).code == USAGE, call
        assert all(request[0] == 20 for request in controller.requests)


@pytest.mark.parametrize(
    ("url", "status"),
    [
        ("tcp://127.0.0.1:1", NO_DEVICE), ("slcan:/dev/tty-none", NO_DEVICE), ("slcan:/dev/null", NO_DEVICE),
        ("modbus:/dev/tty-none", NO_DEVICE), ("modbus-tcp://127.0.0.1:1", NO_DEVICE), ("tcp://127.0.0.1", USAGE),
        ("bogus://x", USAGE), ("modbus:/dev/ttyS0@5", USAGE), ("modbus-tcp://127.0.0.1:1502/300", USAGE),
        ("slcan:/dev/ttyACM0@123", USAGE), ("", USAGE),
    ],
)  # fmt: skip
def test_no_device(probe: Probe, url: str, status: int) -> None:
    answer = probe(url, "identity")
    assert answer.code == status and answer.reported_in_time
    assert f"exit {2 if status == USAGE else 4}" in answer.err
    assert len(answer.err.splitlines()[0]) > 30


def test_socketcan_where_the_kernel_has_none(probe: Probe) -> None:
    answer = probe("can-none0", "identity")
    assert answer.code in (NO_KERNEL, NO_DEVICE) and "exit 4" in answer.err and answer.reported_in_time
    assert "no CAN" in answer.err or "no such interface" in answer.err


@pytest.mark.parametrize("kind", ["slcan", "modbus"])
def test_a_serial_device_that_says_nothing(probe: Probe, kind: str) -> None:
    ours, theirs = pty.openpty()
    try:
        answer = probe(f"{kind}:{os.ttyname(theirs)}", "identity")
        assert answer.code == SILENT and "exit 4" in answer.err and answer.reported_in_time, answer.err
    finally:
        os.close(ours)
        os.close(theirs)


SHIM = """
#define _GNU_SOURCE
#include <dlfcn.h>
#include <stdio.h>
typedef void *(*new_rtu_t)(const char *, int, char, int, int);
void *modbus_new_rtu(const char *device, int baud, char parity, int data_bits, int stop_bits)
{
    const new_rtu_t real = (new_rtu_t)dlsym(RTLD_NEXT, __func__);
    fprintf(stderr, "line %d %d%c%d\\n", baud, data_bits, parity, stop_bits);
    return real(device, baud, parity, data_bits, stop_bits);
}
"""


def test_modbus_on_a_serial_line_has_the_controller_s_parity(
    probe: Probe, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """8E1 (docs/modbus.md). Pseudo-terminals, which the other tests run on, have no parity: there it would not show."""
    (tmp_path / "shim.c").write_text(SHIM)
    subprocess.run(["cc", "-shared", "-fPIC", "-o", tmp_path / "shim.so", tmp_path / "shim.c", "-ldl"], check=True)
    monkeypatch.setenv("LD_PRELOAD", str(tmp_path / "shim.so"))
    assert "line 19200 8E1" in probe("modbus:/dev/tty-none@19200", "identity").err
    ours, theirs = pty.openpty()
    assert "line 115200 8N1" in probe(f"modbus:{os.ttyname(theirs)}", "identity", timeout_ms=300).err
    os.close(ours)
    os.close(theirs)


@pytest.mark.parametrize("kind", ["modbus-tcp", "tcp"])
def test_a_port_that_accepts_and_says_nothing(probe: Probe, kind: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as server:
        answer = probe(f"{kind}://127.0.0.1:{server.getsockname()[1]}", "identity")
        assert answer.code == SILENT and answer.reported_in_time, answer.err


@pytest.mark.parametrize("times", [1, 1000])
def test_modbus_noise(probe: Probe, times: int) -> None:
    """Whether every try is answered so, or only the first."""
    ours, theirs = pty.openpty()
    subprocess.run(["stty", "-F", os.ttyname(theirs), "raw", "-echo"], check=True)

    def answer_with_noise() -> None:
        with contextlib.suppress(OSError):  # the device has been closed
            for answered in range(1000):
                os.read(ours, 64)
                if answered < times:
                    os.write(ours, b"\x01\x04\x10" + b"\x55" * 18)  # the right length, a wrong CRC

    threading.Thread(target=answer_with_noise, daemon=True).start()
    answer = probe(f"modbus:{os.ttyname(theirs)}", "identity")
    assert answer.code == BIT_RATE and answer.reported_in_time, answer.err
    os.close(theirs)


def test_the_example_ends_with_a_reason_too() -> None:
    done = subprocess.run([PRINT_K, "tcp://127.0.0.1:1"], capture_output=True, text=True, timeout=30)
    assert done.returncode == 4 and "refused" in done.stderr
    assert subprocess.run([PRINT_K], capture_output=True, timeout=30).returncode == 2

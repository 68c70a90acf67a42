"""`brace params push, pull, diff, rollback` on a controller: what was written is in force, or nothing was."""

from __future__ import annotations

import contextlib
import json
import random
import signal
import struct
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from bus_bench import device_on, limb_on_tcp, wait_for_mode
from command_bench import FREE, LIMB, Outcome, running, spawn

from brace.bus.controller import Advance, Identity, Stored
from brace.bus.push import push
from brace.ground.errors import DeviceFaultError, NoDeviceError, NotVerifiedError
from brace.model import load_limb
from brace.params import Block, pack


@pytest.fixture
def limb(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB)
    return path


@pytest.fixture
def other(tmp_path: Path) -> Path:
    path = tmp_path / "other.toml"
    path.write_text(LIMB.replace("tibia_mm = 313.5", "tibia_mm = 301.25").replace("= 0.25", "= 0.31"))
    return path


def crc_in_force(url: str) -> int:
    with device_on(url) as device:
        return device.identify().parameter_crc


def test_push_pull_diff_rollback(brace: Callable[..., Outcome], limb: Path, other: Path, tmp_path: Path) -> None:
    with limb_on_tcp(limb) as url:
        assert brace("params", "diff", limb, "--bus", url, "--check").code == 0
        assert brace("params", "diff", other, "--bus", url, "--check").code == 1
        before = crc_in_force(url)
        outcome = brace("params", "push", other, "--bus", url, "--json")
        assert outcome.code == 0, outcome.err
        pushed = json.loads(outcome.out)
        assert pushed["verified"] and pushed["parameter_crc"] == f"{crc_in_force(url):08x}" != f"{before:08x}"
        assert brace("params", "diff", other, "--bus", url, "--check").code == 0
        live = json.loads(brace("query", "--bus", url, "--json").out)  # and it speaks, under its number
        assert live["node"] == 1 and live["mode"] == "monitor"

        assert brace("params", "pull", "--bus", url, "--out", tmp_path / "pulled.toml").code == 0
        pulled = load_limb(tmp_path / "pulled.toml")
        assert pulled.number("geometry.tibia_mm") == 301.25 and pulled.number("controller.node_id") == 1
        assert brace("params", "pull", "--bus", url, "--out", tmp_path / "pulled.bin").code == 0
        assert brace("params", "diff", tmp_path / "pulled.toml", tmp_path / "pulled.bin", "--check").code == 0

        back = json.loads(brace("params", "rollback", "--bus", url, "--json").out)
        assert back["parameter_crc"] == f"{before:08x}" == f"{crc_in_force(url):08x}"
        again = brace("params", "push", tmp_path / "pulled.bin", "--bus", url)
        assert again.code == 0 and "controller keeps" not in again.out + again.err
        assert brace("params", "diff", other, "--bus", url, "--check").code == 0


def test_what_was_pushed_is_there_after_power_off(
    brace: Callable[..., Outcome], limb: Path, other: Path, tmp_path: Path
) -> None:
    memory = tmp_path / "memory"
    with limb_on_tcp(limb, "--nvm", memory) as url:
        first = brace("params", "push", other, "--bus", url)
        assert first.code == 0 and "the controller keeps 1" in first.out + first.err
        crc = crc_in_force(url)
    with limb_on_tcp(limb, "--nvm", memory) as url:
        assert crc_in_force(url) == crc


@pytest.mark.minutes
def test_a_push_interrupted_at_any_frame_leaves_the_set_before(limb: Path, other: Path) -> None:
    block = pack(load_limb(other).with_values({"controller.node_id": 1}))
    words = len(block.content) // 4
    chance = random.Random(3)
    with limb_on_tcp(limb) as url:
        before = crc_in_force(url)
        for cut in (0, 1, 2, words - 1, words, *chance.sample(range(3, words - 1), 6)):
            with device_on(url) as device:
                device.enter_configuration()

                def stop(done: int, cut: int = cut) -> None:
                    if done == cut:
                        raise NoDeviceError("the cable is out")

                with contextlib.suppress(NoDeviceError):
                    stop(0)
                    device.upload(block, stop)
            with device_on(url) as device:  # somebody comes back later
                assert device.identify().parameter_crc == before
                device.leave_configuration()
                assert device.download(lambda _: None).identity == before
        with device_on(url) as device, pytest.raises(DeviceFaultError):
            device.commit(block)  # leaving CONFIGURATION has forgotten the upload
        with device_on(url) as device:
            assert push(device, block, lambda _: None).crc == block.identity != before


def test_a_killed_or_interrupted_push(limb: Path, other: Path) -> None:
    with limb_on_tcp(limb) as url:
        before = crc_in_force(url)
        for sent, code in ((signal.SIGKILL, -9), (signal.SIGTERM, 130), (signal.SIGINT, 130)):
            process = spawn("params", "push", other, "--bus", url)
            wait_for_mode(url, "configuration")
            process.send_signal(sent)
            process.communicate(timeout=60)
            if process.returncode == 0:
                pytest.skip("the push was done before the signal came")
            assert process.returncode == code
            assert crc_in_force(url) == before
            if sent == signal.SIGKILL:
                with device_on(url) as device:
                    device.leave_configuration()
            wait_for_mode(url, "monitor")  # which the others have done themselves


@pytest.mark.parametrize("fault", ["nvm_fails@0.4", "nvm_forgets@0.4"])
def test_a_memory_that_does_not_keep_it_is_7_with_the_set_before(
    brace: Callable[..., Outcome], limb: Path, other: Path, fault: str
) -> None:
    with limb_on_tcp(limb, "--fault", fault) as url:
        before = crc_in_force(url)
        time.sleep(1.6)  # in the limb's time; a machine that is late may take four times as long
        outcome = brace("params", "push", other, "--bus", url)
        assert outcome.code == 7, outcome.err
        assert "try:" in outcome.err
        assert crc_in_force(url) == before


def test_a_set_that_no_limb_can_have_is_3_and_nothing_is_asked(
    brace: Callable[..., Outcome], limb: Path, tmp_path: Path
) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text(LIMB.replace("tibia_mm = 313.5", "tibia_mm = -1"))
    assert brace("params", "push", bad, "--bus", "tcp://127.0.0.1:9").code == 3


class Forgetful:
    """A controller that puts something else in force than it was given."""

    url, node = "forgetful", 1

    def __init__(self, held: Block, wrong: Block, lies: bool, rolls_back: bool = True) -> None:
        self.held, self.wrong, self.before = held, wrong, held
        self.lies, self.rolls_back = lies, rolls_back
        self.calls: list[str] = []

    def identify(self) -> Identity:
        return Identity(1, "0", 0, self.held.identity, "slot_a")

    def enter_configuration(self) -> None:
        self.calls.append("enter")

    def leave_configuration(self) -> None:
        self.calls.append("leave")

    def upload(self, block: Block, advance: Advance) -> None:
        self.calls.append("upload")

    def commit(self, block: Block) -> Stored:
        self.held = self.wrong
        return Stored(2, block.identity if self.lies else self.held.identity)

    def rollback(self) -> Stored:
        self.calls.append("rollback")
        if not self.rolls_back:
            raise DeviceFaultError("there is no set to go back to")
        self.held = self.before
        return Stored(1, self.held.identity)

    def download(self, advance: Advance) -> Block:
        return self.held


@pytest.mark.parametrize("lies", [False, True])
def test_what_reads_back_otherwise_is_rolled_back(limb: Path, other: Path, lies: bool) -> None:
    held, wanted = pack(load_limb(limb)), pack(load_limb(other))
    wrong = pack(load_limb(other).with_values({"geometry.tibia_mm": 301.5}))
    device = Forgetful(held, wrong, lies)
    with pytest.raises(NotVerifiedError) as refused:
        push(device, wanted, lambda _: None)  # type: ignore[arg-type]
    assert device.calls == ["enter", "upload", "rollback", "leave"]
    assert device.held is held
    assert "rolled back" in refused.value.what and "geometry.tibia_mm is 301.5 mm, not 301.25" in refused.value.why
    assert refused.value.exit_code == 7


def test_a_roll_back_that_fails_is_said(limb: Path, other: Path) -> None:
    held, wanted = pack(load_limb(limb)), pack(load_limb(other))
    device = Forgetful(held, held, lies=True, rolls_back=False)
    with pytest.raises(NotVerifiedError) as refused:
        push(device, wanted, lambda _: None)  # type: ignore[arg-type]
    assert "the roll-back failed: there is no set to go back to" in refused.value.what


def test_a_lost_answer_to_the_commit_is_looked_after(limb: Path, other: Path) -> None:
    held, wanted = pack(load_limb(limb)), pack(load_limb(other))

    class Silent(Forgetful):
        def commit(self, block: Block) -> Stored:
            super().commit(block)
            raise NoDeviceError("no answer")

    assert push(Silent(held, wanted, True), wanted, lambda _: None).crc == wanted.identity  # type: ignore[arg-type]
    with pytest.raises(NotVerifiedError) as refused:
        push(Silent(held, held, True), wanted, lambda _: None)  # type: ignore[arg-type]
    assert "the one before is in force" in refused.value.what


def test_the_block_s_last_word_is_its_crc(limb: Path) -> None:
    """What commit is asked with."""
    import zlib

    content = pack(load_limb(limb)).content
    assert struct.unpack("<I", content[-4:])[0] == zlib.crc32(content[:-4])


def test_parameters_over_modbus(brace: Callable[..., Outcome], limb: Path, other: Path) -> None:
    with running(limb, *FREE) as (_, ready):
        url, can = ready["limbs"][0]["modbus_tcp"] + "/1", ready["limbs"][0]["can"]
        before = crc_in_force(can)
        assert brace("params", "diff", limb, "--bus", url, "--check").code == 0
        outcome = brace("params", "push", other, "--bus", url)
        assert outcome.code == 0, outcome.err
        assert brace("params", "diff", other, "--bus", can, "--check").code == 0
        assert brace("params", "rollback", "--bus", url).code == 0
        assert crc_in_force(can) == before
        for bus in (can, url):
            nothing = brace("params", "rollback", "--bus", bus)
            assert nothing.code == 5 and "there is no set to go back to" in nothing.err, nothing.err
        live, over_can = (json.loads(brace("query", "--bus", bus, "--json").out) for bus in (url, can))
        for name in ("k_xx_n_per_mm", "k_xz_n_per_mm", "k_zz_n_per_mm"):
            assert abs(live[name] - over_can[name]) < 0.05  # the force sensor's noise turns each K by up to 1 %
        asked = [
            json.loads(brace("query", "--bus", b, "--theta1", 0.4, "--theta2", 1.1, "--json").out) for b in (url, can)
        ]
        assert abs(asked[0]["k_xx_n_per_mm"] - asked[1]["k_xx_n_per_mm"]) < 0.0005
        assert brace("monitor", "--bus", url, "--seconds", 0.5).code == 0
        beyond = brace("query", "--bus", url, "--x", 1, "--z", 1)  # nearer than the links can fold
        assert beyond.code == 5, beyond.err
        wrong_unit = brace("query", "--bus", ready["limbs"][0]["modbus_tcp"] + "/9")
        assert wrong_unit.code == 4 and "unit 9 does not answer" in wrong_unit.err

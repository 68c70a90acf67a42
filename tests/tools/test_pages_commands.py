"""What pages print besides the README and docs/bus.md runs here where it takes seconds: with the files that the page
speaks of made beforehand, in the page's order. A printed answer must be the command's."""

from __future__ import annotations

import contextlib
import os
import random
import re
import shlex
import shutil
import signal
import stat
import subprocess
import sys
import textwrap
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from bus_bench import limb_on_tcp
from command_bench import FREE, LIMB, PROJECT, Outcome, running, spawn
from test_printed_commands import START, lines_of_code

from brace.bus.can_controller import CanController
from brace.bus.open import open_bus
from brace.bus.session import Session
from brace.bus.url import parse
from brace.wire.registers import REGISTERS

Brace = Callable[..., Outcome]
DOCS = PROJECT / "docs"
sys.path.insert(0, str(Path(__file__).parent / "importing"))
sys.path.insert(0, str(Path(__file__).parent / "new"))


def printed(page: str, *begin: str) -> list[str]:
    """The words of the first `brace` command of a page that begins so."""
    for line in lines_of_code(DOCS / page):
        match = START.search(line)
        if match:
            words = shlex.split(line[match.end() :], comments=True)
            if words[: len(begin)] == list(begin):
                return words
    raise AssertionError(f"{page} prints no {' '.join(begin)}")


def done(brace: Brace, words: list[str]) -> Outcome:
    outcome = brace(*words)
    assert outcome.code == 0, f"brace {' '.join(words)}: {outcome.out[-1500:]}{outcome.err}"
    return outcome


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("tools").symlink_to(PROJECT / "tools")


def test_calibrating(brace: Brace) -> None:
    """With a plan of three postures instead of twelve; the record of the real limb is the rehearsal's."""
    shutil.copy("tools/brace/data/paper-limb.toml", "limb.toml")
    plan, *postures = Path("tools/brace/data/paper-rig.toml").read_text().split("[[configuration]]")
    Path("rig.toml").write_text("[[configuration]]".join([plan, *postures[::5]]))
    page = "calibrate.md"
    done(brace, printed(page, "simulate", "--model"))
    done(brace, printed(page, "identify", "rehearsal"))
    shutil.copytree("rehearsal", "measured")
    shutil.copytree("rehearsal", "held-out")
    done(brace, printed(page, "identify", "measured"))
    rehearsed, fitted = (Path(name).read_text().splitlines()[1:-1] for name in ("rehearsed.toml", "fitted.toml"))
    assert rehearsed == fitted != []  # but for the first line, which names the record, and the last, its checksum
    done(brace, printed(page, "predict"))
    assert Path("predicted.csv").is_file()
    done(brace, printed(page, "params", "pack"))
    differing = brace(*printed(page, "params", "diff"))
    assert differing.code == 0 and "geometry.femur_mm" in differing.out, differing.out + differing.err


def test_the_plan_and_its_answer(brace: Brace) -> None:
    answer = [line.strip() for line in lines_of_code(DOCS / "plan.md")][1:7]
    out = [line.strip() for line in done(brace, printed("plan.md", "plan")).out.splitlines()]
    assert answer == out


def test_files_of_ones_own(brace: Brace) -> None:
    """Two files, whose open points are answered in the draft; without a terminal the first command refuses to guess."""
    import logs_of_a_rig as rig
    from foreign_files import Record, two_files
    from test_logs import answered

    here = Path()
    for path in two_files(here):
        path.rename(path.name.removeprefix("test_"))
    page = "datasets.md"
    asked = brace(*printed(page, "import", "x.csv", "z.csv", "--out"))
    assert asked.code == 2 and "--draft" in asked.err, asked.err
    done(brace, printed(page, "import", "x.csv", "z.csv", "--draft"))
    mapping = Path("mapping.toml")
    assert '"?"' not in mapping.read_text()
    done(brace, printed(page, "import", "x.csv", "z.csv", "--mapping"))
    assert Path("measured/meta.toml").is_file()
    shutil.rmtree("measured")
    mapping.unlink()
    rig.candump(here, Record()).rename("rig.log")
    rig.database(here)
    done(brace, printed(page, "import", "rig.log"))
    mapping.unlink()
    rig.json_mcap(here, Record()).rename("rig.mcap")
    done(brace, ["import", "rig.mcap", "--draft", "mapping.toml"])
    answered(mapping, {"/ft300.force.x": {"unit": '"N"'}, "/ft300.force.z": {"unit": '"N"'}})
    done(brace, printed(page, "import", "rig.mcap"))


def test_a_limb_from_a_urdf(brace: Brace) -> None:
    pytest.importorskip("mujoco")
    from test_new_command import TUBES, URDF

    urdf = URDF.format(yaw=0.0, down=0.0, hip=-1, knee=1).replace('"foot"', '"left_foot"')
    Path("robot.urdf").write_text(urdf)
    words = printed("your-limb.md", "new", "--out", "limb.toml", "--urdf")
    assert words[-1] == "..."
    given = dict(zip(TUBES[4::2], TUBES[5::2], strict=True)) | {"--coxa-joint": "60"}
    rest = [word for option, value in given.items() if option not in words for word in (option, value)]
    done(brace, [*words[:-1], *rest])


def test_a_joint_on_the_bench(brace: Brace) -> None:
    """A spring of 60 N m/rad, loaded up and down, six tests."""
    folder, noise = Path("joint-test"), random.Random(3)
    folder.mkdir()
    rows = ["t_s,angle_rad,torque_n_mm,test"]
    for number in range(480):
        torque = 4000.0 * (1.0 - abs(number % 80 - 40) / 20.0)
        angle = torque / 60000.0 + noise.gauss(0.0, 2e-5)
        rows.append(f"{number * 0.1:.1f},{angle:.6f},{torque:.2f},{number // 80}")
    (folder / "data.csv").write_text("\n".join(rows) + "\n")
    (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\n')
    done(brace, printed("joint-tests.md", "diagnose"))
    assert Path("found/diagnosis.json").is_file()


def lines_with(page: str, *words: str) -> list[str]:
    return [line for line in lines_of_code(DOCS / page) if all(word in line for word in words)]


@contextlib.contextmanager
def said_first(process: subprocess.Popen[str]) -> Iterator[str]:
    """What a program that goes on says first."""
    try:
        assert process.stdout is not None
        yield process.stdout.readline()
    finally:
        process.terminate()
        process.wait(timeout=30.0)
        process.stdout.close() if process.stdout is not None else None


def test_servos_with_nothing_attached() -> None:
    with said_first(spawn(*printed("joints.md", "sim"))) as line:
        assert '"can"' in line or "tcp://" in line, line
    (line,) = lines_with("joints.md", "brace.sim.servos")
    command = [sys.executable, *shlex.split(line)[1:]]
    with said_first(subprocess.Popen(command, stdout=subprocess.PIPE, text=True)) as said:
        place = re.search(r"/dev/pts/\d+", said)
        assert place is not None, said
        (text,) = lines_with("joints.md", "--servos /dev/pts/N")
        words = shlex.split(text.partition("brace ")[2].replace("/dev/pts/N", place[0]))
        words[words.index("--seconds") + 1] = "1"
        ended = spawn(*words)
        ended.communicate(timeout=60.0)
        assert ended.returncode == 0


def test_a_key_for_a_guarded_board() -> None:
    (line,) = lines_with("security.md", "umask")
    subprocess.run(line, shell=True, check=True)
    key = Path("limb.key")
    assert re.fullmatch(r"[0-9a-f]{32}", key.read_text()) and stat.S_IMODE(key.stat().st_mode) == 0o600


def block_with(page: str, text: str) -> str:
    """The whole piece of code of a page that has this text in it."""
    blocks = re.findall(r"(?:^    .*\n|^\n(?=    ))+", (PROJECT / "docs" / page).read_text(), re.MULTILINE)
    (block,) = [textwrap.dedent(block) for block in blocks if text in block]
    return block


class ByHand:
    """candump and cansend for a shell, over a bus that only we have open."""

    def __init__(self, folder: Path, bus: Any) -> None:
        self.bus, self.ends = bus, False
        self.sent, self.heard = folder / "sent", folder / "heard"
        for fifo in (self.sent, self.heard):
            os.mkfifo(fifo)
        for name, text in (("cansend", f'echo "$2" > {self.sent}'), ("candump", f"exec cat {self.heard}")):
            (folder / name).write_text(f"#!/bin/sh\n{text}\n")
            (folder / name).chmod(0o755)
        self.environment = os.environ | {"PATH": f"{folder}:{os.environ['PATH']}"}

    def carry(self, seconds: float) -> None:
        """Frames both ways; what candump would print of the answers."""
        sent = os.fdopen(os.open(self.sent, os.O_RDWR | os.O_NONBLOCK), "rb", buffering=0)
        heard = os.open(self.heard, os.O_RDWR | os.O_NONBLOCK)
        until, rest = time.monotonic() + seconds, b""
        with sent:
            while time.monotonic() < until and not self.ends:
                *lines, rest = (rest + (sent.read() or b"")).split(b"\n")
                for line in lines:
                    identifier, _, data = line.decode().partition("#")
                    self.bus.send(int(identifier, 16), bytes.fromhex(data))
                frame = self.bus.receive(0.005)
                if frame is not None and frame.identifier == 0x581:
                    os.write(heard, f"(0.0) can0 581#{frame.data.hex().upper()}\n".encode())
        os.close(heard)


def test_a_take_up_by_hand(tmp_path: Path) -> None:
    """The page's loop, run by a shell as it stands, over the bus that is there. At a speed of its own a limb waits for
    its owner for 0.5 s of the clock: a turn of the loop starts two programs, which takes long on a busy machine."""
    Path("limb.toml").write_text(LIMB.replace("[joint.femur]", "[joint.femur]\ngap_rad = 0.006"))
    with limb_on_tcp(Path("limb.toml"), "--speed", 0.9) as url:
        bus = open_bus(parse(url))
        controller = CanController(Session(bus, 1))
        assert controller.take_ups()["femur"] == "none"
        hand = ByHand(tmp_path, bus)
        shell = subprocess.Popen(["sh", "-c", block_with("security.md", "candump -L can0") + "wait"],
                                 env=hand.environment, start_new_session=True)
        try:
            hand.carry(8.0)
        finally:
            os.killpg(shell.pid, signal.SIGKILL)
            shell.wait(timeout=30.0)
        assert controller.take_ups()["femur"] == "held"
        assert controller.read_entry("silences") == 0


def test_the_registers_by_hand() -> None:
    addresses = {register.name: register.address for register in REGISTERS}
    block = block_with("security.md", "mbpoll $tcp -t 3:int")
    assert f"-r {addresses['life_number']} -c 2" in block
    assert addresses["begin_number"] == addresses["life_number"] + 2
    assert f"-r {addresses['life_heard']} " in block and f"-r {addresses['take_up']} " in block


def test_a_take_up_by_registers_by_hand() -> None:
    """The page's loop with mbpoll, likewise."""
    if shutil.which("mbpoll") is None:
        pytest.skip("mbpoll is missing (Debian package mbpoll)")
    Path("limb.toml").write_text(LIMB.replace("[joint.femur]", "[joint.femur]\ngap_rad = 0.006"))
    with running(Path("limb.toml"), *FREE, "--speed", 0.9) as (_, ready):
        urls = ready["limbs"][0]
        (port,) = re.findall(r":(\d+)$", urls["modbus_tcp"])
        controller = CanController(Session(open_bus(parse(urls["can"])), 1))
        loop = block_with("security.md", "mbpoll $tcp -t 3:int").replace("-p 1502", f"-p {port}")
        shell = subprocess.Popen(["sh", "-c", loop + "wait"], stdout=subprocess.DEVNULL, start_new_session=True)
        try:
            until = time.monotonic() + 60.0
            while controller.take_ups()["femur"] != "held" and time.monotonic() < until:
                time.sleep(0.1)
        finally:
            os.killpg(shell.pid, signal.SIGKILL)
            shell.wait(timeout=30.0)
        assert controller.take_ups()["femur"] == "held"
        assert controller.read_entry("silences") == 0


def test_the_core_in_two_files() -> None:
    line = next(line for line in lines_of_code(PROJECT / "README.md") if "two_files.py" in line)
    subprocess.run(line, shell=True, check=True)
    assert {path.name for path in Path("my_project").iterdir()} >= {"brace_core.h", "brace_core.c"}

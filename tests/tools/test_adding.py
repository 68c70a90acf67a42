"""docs/adding.md, done for real with throw-away things: in a copy of the project a parameter, a request and a message
are added, the generator runs, its C is compiled and asked, and the files that were written by hand are counted."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cantools.database
import pytest

from conftest import PROJECT

COPIED = ("firmware/core", "firmware/interface", "host_sim", "tools/interface", "tools/brace", "docs/protocol.md",
          "docs/limb-keys.md")
DICTIONARY, MESSAGES = "firmware/interface/dictionary.toml", "firmware/interface/messages.toml"
WARNINGS = ("-std=c11", "-O0", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function")

# Stands in for the controller: as firmware/app/src/wire does, it makes its tables from the generated lists, and has one
# function for each request of the dictionary as it is.
CONTROLLER = """
#include "brace/answering.h"
#include "brace/can_frames.h"
#include "brace/can_snapshot.h"
#include "brace/parameters.h"
#include <stdio.h>
#include <string.h>

#define ANSWER_OF(CODE, name) \\
    int32_t answer_##name(void *request, const brace_##name##_request_t *asked, brace_##name##_answer_t *answer);
BRACE_REQUESTS(ANSWER_OF)

static int32_t answer_request(uint32_t code, const brace_request_t *asked, brace_answer_t *answer)
{
#define ANSWER(CODE, name) case CODE: return answer_##name(NULL, &asked->name, &answer->name);
    switch (code) {
        BRACE_REQUESTS(ANSWER)
    default: return -1;
    }
}

#define ROW_OF(ID, name, rate, coxa) {ID, brace_can_make_##name, offsetof(brace_controller_t, rate)},
static const struct {
    uint32_t id;
    void (*make)(const brace_measured_t *, float, uint8_t *);
    size_t rate;
} process[] = {BRACE_CAN_PROCESS(ROW_OF)};

static void print_frame(uint32_t id, const uint8_t *data)
{
    printf("%03x ", (unsigned)id);
    for (int i = 0; i < 8; i++) {
        printf("%02x", data[i]);
    }
    printf("\\n");
}

int main(void)
{
    const brace_measured_t measured = {.load_femur_n_mm = -1.5f};
    brace_parameters_t parameters;
    brace_parameters_default(&parameters);
    for (size_t i = 0; i < sizeof process / sizeof *process; i++) {
        uint32_t hz;
        uint8_t data[8] = {0};
        memcpy(&hz, (const char *)&parameters.controller + process[i].rate, 4);
        process[i].make(&measured, 0.0f, data);
        if (hz != 0u) {
            print_frame(process[i].id + 1u, data);
        }
    }
    for (uint32_t code = 0; code < 256u; code++) {
        const uint8_t request[8] = {(uint8_t)code, 9, 7};
        uint8_t parts[BRACE_CAN_ANSWER_PARTS_MOST][8];
        brace_request_t asked;
        brace_answer_t answer;
        brace_can_unpack_request(request, &asked);
        if (answer_request(code, &asked, &answer) == 0) {
            brace_can_pack_answer(code, &answer, request[1], parts);
            print_frame(0x581, parts[0]);
        }
    }
    const uint32_t status = (uint32_t)brace_parameters_check(&parameters, NULL);
    printf("check %u members %u\\n", (unsigned)status, (unsigned)BRACE_PARAMETER_COUNT);
    for (uint32_t number = 0; number < BRACE_PARAMETER_NUMBERS; number++) {
        uint32_t word;
        const uint32_t index = brace_parameter_index(number);
        memcpy(&word, (const char *)&parameters + 4u * index, 4);
        printf("parameter %u %s %08x %d\\n", (unsigned)number, brace_parameter_key(index), (unsigned)word,
               (int)brace_parameter_in_range(index, 0x7f7fffffu));
    }
    return 0;
}
"""


def text_files(project: Path) -> dict[str, bytes]:
    """Every file that a person or the generator may have written."""
    return {
        str(path.relative_to(project)): path.read_bytes()
        for path in sorted(project.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts and "build" not in path.relative_to(project).parts
    }


COPY_FIRST = Path(__file__).resolve().parent / "copy_first"


class Copy:
    """A copy of the project, with a stand-in for the controller that builds and runs."""

    def __init__(self, project: Path) -> None:
        self.project = project
        for name in COPIED:
            source, target = PROJECT / name, project / name
            target.parent.mkdir(parents=True, exist_ok=True)
            if source.is_dir():
                shutil.copytree(source, target, ignore=shutil.ignore_patterns("__pycache__"))
            else:
                shutil.copy(source, target)
        self.app = project / "firmware" / "app"
        self.app.mkdir(parents=True)
        (self.app / "controller.c").write_text(CONTROLLER)
        lists = (project / "firmware/interface/generated/brace/answering.h").read_text()
        answers = re.findall(r"X\(BRACE_REQUEST_\w+, (\w+)\)", lists)
        (self.app / "there_already.c").write_text(
            '#include "brace/answering.h"\n'
            + "".join(f"int32_t answer_{name}(void *request, const brace_{name}_request_t *asked,\n"
                      f"    brace_{name}_answer_t *answer)\n"
                      "{\n    (void)request;\n    (void)asked;\n    (void)answer;\n    return -1;\n}\n"
                      for name in answers)
        )
        self.before = text_files(project)
        self.generated: set[str] = set()

    def append(self, name: str, text: str, after: str = "") -> None:
        """Adds lines to a file: behind `after`, or at its end."""
        path = self.project / name
        known = path.read_text() if path.is_file() else ""
        assert after in known
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(known.replace(after, after + text, 1) if after else known + text)

    def generate(self) -> None:
        """Runs the generator, as the page says."""
        done = subprocess.run([sys.executable, "-m", "interface"], cwd=self.project / "tools", capture_output=True,
                              text=True, check=False, timeout=60)
        assert done.returncode == 0, done.stderr
        self.generated = {line.removeprefix("wrote ") for line in done.stderr.splitlines()}

    def by_hand(self) -> set[str]:
        """Files that are new or changed, and that the generator did not write."""
        now = text_files(self.project)
        return {name for name, content in now.items() if self.before.get(name) != content} - self.generated

    def run(self) -> list[str]:
        """Compiles the generated C with the controller's stand-in; what it prints."""
        firmware = self.project / "firmware"
        sources = [*firmware.glob("interface/src/*.c"), *firmware.glob("interface/generated/*.c"),
                   *firmware.glob("core/src/limb/limb.c"), *self.app.glob("*.c")]
        includes = ("interface/include", "interface/generated", "interface/src", "core/include", "core/src")
        program = self.project / "build" / "controller"
        program.parent.mkdir(exist_ok=True)
        done = subprocess.run(
            ["gcc", *WARNINGS, *(f"-I{firmware / folder}" for folder in includes), *map(str, sources), "-o",
             str(program), "-lm"], capture_output=True, text=True, check=False, timeout=300,
        )
        assert done.returncode == 0, done.stderr
        return subprocess.run([program], capture_output=True, text=True, check=True, timeout=60).stdout.splitlines()

    def python(self, script: str) -> object:
        """Runs a script with the copy's own tools; the JSON that it prints."""
        environment = os.environ | {"PYTHONPATH": f"{self.project / 'tools'}:{COPY_FIRST}"}
        done = subprocess.run([sys.executable, "-c", script], cwd=self.project / "tools", env=environment,
                              capture_output=True, text=True, check=False, timeout=60)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    def free_register(self) -> int:
        """The first register behind the parameters."""
        with (PROJECT / "firmware/interface/modbus.csv").open(newline="") as file:
            return 2 + max(int(row["address"]) for row in csv.DictReader(file) if row["access"] == "rw")


@pytest.fixture
def copy(tmp_path: Path) -> Copy:
    return Copy(tmp_path / "project")


def after_entry(name: str) -> str:
    """The dictionary's text of an entry, up to its end: a new one may stand anywhere."""
    text = (PROJECT / DICTIONARY).read_text()
    (entry,) = re.findall(rf'\[\[group\.entry\]\]\nname = "{name}"\n(?:(?!\n\[\[|\n\n).)*\n', text, re.S)
    return str(entry)


def test_a_request_is_two_files(copy: Copy) -> None:
    copy.append(MESSAGES, '''
[[request]]
code = 200
name = "throw_away"
description = "doubles a number"
[[request.field]]
name = "number"
bits = 8
description = "the number"
[[request.answer]]
number = 200
[[request.answer.field]]
name = "doubled"
bits = 16
description = "twice that number"
''')
    answer = "firmware/app/answer_throw_away.c"
    copy.append(answer, '''#include "brace/answering.h"

int32_t answer_throw_away(void *request, const brace_throw_away_request_t *asked, brace_throw_away_answer_t *answer)
{
    (void)request;
    answer->doubled = 2u * asked->number;
    return 0;
}
''')
    copy.generate()
    assert copy.by_hand() == {MESSAGES, answer}
    assert "581 c8090e0000000000" in copy.run()
    database: Any = cantools.database.load_file(copy.project / "firmware/interface/brace.dbc", strict=True)
    decoded = database.decode_message("answer", bytes.fromhex("c8090e0000000000"))
    assert decoded["throw_away_0_doubled"] == 14 and decoded["token"] == 9
    assert copy.python(
        "import json; from brace.wire.frames import ANSWERS;"
        "print(json.dumps(ANSWERS['throw_away'][0].decode(bytes.fromhex('c8090e0000000000'))))"
    ) == {"doubled": 14}
    assert "| 200 | `throw_away` |" in (copy.project / "docs/protocol.md").read_text()


def test_a_message_is_one_file(copy: Copy) -> None:
    copy.append(MESSAGES, '''
[[multiplexed.group]]
name = "throw_away"
rate = "controller.posture_hz"
description = "the load at a joint"
[[multiplexed.group.part]]
number = 200
[[multiplexed.group.part.signal]]
name = "load"
from = "load_femur"
bits = 16
signed = true
kind = "value"
step = 0.5
unit = "N mm"
description = "the load that the joint's gap transmits"
''', after='description = "one sigma of k_across"\n')  # the last of details: its first place in the file
    copy.generate()
    assert copy.by_hand() == {MESSAGES}
    assert "201 00c8fdff00000000" in copy.run()
    database: Any = cantools.database.load_file(copy.project / "firmware/interface/brace.dbc", strict=True)
    decoded = database.decode_message("details", bytes.fromhex("00c8fdff00000000"))
    assert decoded == {"sequence": 0, "part": "THROW_AWAY", "throw_away_load": -1.5}


def joint_entry(copy: Copy) -> tuple[str, str, str]:
    first = copy.free_register()
    return "gap_rad", "joint.femur.throw_away_rad", f'''
[[group.entry]]
name = "throw_away_rad"
register = {[first, first + 2, first + 4]}
unit = "rad"
range = [0.0, 0.25]
default = 0.125
description = "a throw-away angle at @"
'''


def controller_entry(copy: Copy) -> tuple[str, str, str]:
    return "tick_us", "controller.throw_away_s", f'''
[[group.entry]]
name = "throw_away_s"
register = {copy.free_register()}
unit = "s"
range = [0.0, 10.0]
default = 0.125
description = "a throw-away time"
'''


@pytest.mark.parametrize("entry", [joint_entry, controller_entry])
def test_a_parameter_is_one_file(entry: Callable[[Copy], tuple[str, str, str]], copy: Copy) -> None:
    """Set between others in a table and in a struct, it takes a free register, and all others keep theirs."""
    neighbour, key, text = entry(copy)
    members = copy.python("import json; from brace.wire.names import PARAMETERS; print(json.dumps(len(PARAMETERS)))")
    copy.append(DICTIONARY, text, after=after_entry(neighbour))
    copy.generate()
    assert copy.by_hand() == {DICTIONARY}
    said = copy.run()
    added = 3 if key.startswith("joint") else 1
    assert f"check 0 members {int(str(members)) + added}" in said
    number = (copy.free_register() + (2 if added == 3 else 0)) // 2
    (line,) = [line.split() for line in said if line.split()[:2] == ["parameter", str(number)]]
    assert line[2:] == [key, "3e000000", "-5"]  # 0.125, and the greatest float is refused

    with (copy.project / "firmware/interface/modbus.csv").open(newline="") as file:
        now = {row["name"]: row["address"] for row in csv.DictReader(file)}
    with (PROJECT / "firmware/interface/modbus.csv").open(newline="") as file:
        assert {row["name"]: row["address"] for row in csv.DictReader(file)}.items() <= now.items()
    assert now[key] == str(2 * number)

    limb = copy.project / "build" / "limb.toml"
    table, _, leaf = key.rpartition(".")
    limb.write_text("format = 1\n[geometry]\nfemur_mm = 100.0\ntibia_mm = 100.0\n[base]\nx_mm_per_n = 1.0\n"
                    f"z_mm_per_n = 1.0\n[{table}]\n{leaf} = 0.25\n")
    read = (
        "import json, pathlib; from brace.model.limb import load_limb;"
        f"print(json.dumps(load_limb(pathlib.Path({str(limb)!r})).values[{key!r}]))"
    )
    assert copy.python(read) == 0.25
    assert f"| {number} | `{leaf}` |" in (copy.project / "docs/limb-keys.md").read_text()

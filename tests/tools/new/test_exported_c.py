"""`brace export --c`: from a limb.toml to K in somebody's C program in three commands, by strict compilers, to the last
bit of what `brace k` prints."""

from __future__ import annotations

import json
import random
import shutil
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from command_bench import LIMB, PROJECT, Outcome

Brace = Callable[..., Outcome]
BARE_LOOP = PROJECT / "examples" / "bare_loop"
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion", "-Wdouble-promotion", "-Wcast-qual", "-Werror")
BENT_RAD = (0.5, 1.0, 1.25)  # theta0, theta1, theta2 as commanded; exact in binary, as the zero offsets below
E_CHECKSUM, E_SCHEMA = -13, -14  # brace/status.h

# A base that yields unequally, beams, tilts, weights, zero offsets.
GENERAL = """
format = 1
name = "ends a comment */ and \\\\ begins one /* ?\\u003f/"
[geometry]
femur_mm = 120.1
tibia_mm = 173.3
[link.femur]
axial_mm_per_n = 0.0007
bending_mm_per_n = 0.0333
tilt_rad = 0.1
moment_transfer = 0.3
[link.tibia]
axial_mm_per_n = 1e-7
bending_mm_per_n = 0.123456789
moment_transfer = true
[joint.femur]
compliance_rad_per_n_mm = 1.7e-5
zero_offset_rad = 0.125
[joint.tibia]
compliance_rad_per_n_mm = 3.3e-5
zero_offset_rad = -0.25
[base]
x_mm_per_n = 0.01
z_mm_per_n = 0.02
rotation_rad_per_n_mm = 1e-6
[gravity]
femur_n = 1.5
tibia_n = 0.7
knee_n = 2.1
"""
SPATIAL = (
    GENERAL.replace("femur_mm =", "coxa_mm = 57.0\nfemur_mm =", 1)
    + """
[joint.coxa]
compliance_rad_per_n_mm = 1.1e-5
[link.coxa]
lateral_mm_per_n = 0.013
"""
)

MAIN = """#include <stdio.h>
#include "leg.h"

static float commanded(int joint, float command_rad)
{
    return brace_limb_true_angle(&leg, joint, command_rad);
}

int main(void)
{
    const brace_status_t checked = leg_check();
    if (checked != BRACE_OK) {
        printf("%d\\n", (int)checked);
        return 0;
    }
    const float theta1_rad = commanded(BRACE_FEMUR, 1.0f), theta2_rad = commanded(BRACE_TIBIA, 1.25f);
    brace_stiffness_t k = {0};
    brace_status_t status = @AT_NO_LOAD@;
    const brace_loaded_joint_t hip = {@HIP@, @HIP@}, knee = {@KNEE@, @KNEE@};
    const brace_load_t load = {{2.0f, 5.0f}, {0.0f, -1.0f}, hip, knee};
    brace_loaded_stiffness_t loaded = {0};
    if (status == BRACE_OK) {
        status = brace_loaded_stiffness(&leg_loaded, theta1_rad, theta2_rad, &load, &loaded);
    }
    if (status == BRACE_OK) {
        printf("%.9g %.9g %.9g ", (double)k.k_xx_n_per_mm, (double)k.k_xz_n_per_mm, (double)k.k_zz_n_per_mm);
        printf("%.9g %.9g %.9g ", (double)loaded.stiffness.k_xx_n_per_mm, (double)loaded.stiffness.k_xz_n_per_mm,
               (double)loaded.stiffness.k_zz_n_per_mm);
        @SPATIAL@
    }
    return (int)status;
}
"""
IN_SPACE = """brace_stiffness_spatial_t space;
        status = brace_spatial_stiffness(&leg_spatial, commanded(BRACE_COXA, 0.5f), theta1_rad, theta2_rad, &space);
        printf("%.9g %.9g %.9g", (double)space.k_xy_n_per_mm, (double)space.k_yy_n_per_mm,
               (double)space.k_yz_n_per_mm);"""
HIP = "leg.joint[BRACE_FEMUR].compliance_rad_per_n_mm"
KNEE = "leg.joint[BRACE_TIBIA].compliance_rad_per_n_mm"


def program(form: str, in_space: bool) -> str:
    """What a user writes, by what the header says."""
    springs = "" if form == "planar" else f" {HIP} + leg.base.rotation_rad_per_n_mm, {KNEE},"
    call = f"brace_{form}_stiffness(&leg_{form}, theta1_rad, theta2_rad,{springs} &k)"
    text = MAIN.replace("@AT_NO_LOAD@", call).replace("@HIP@", HIP).replace("@KNEE@", KNEE)
    return text.replace("@SPATIAL@", IN_SPACE if in_space else "")


@dataclass(frozen=True)
class Machine:
    """A compiler of C, one of C++, their flags, and what runs their programs."""

    c: str
    cpp: str = ""
    flags: tuple[str, ...] = ()
    link: tuple[str, ...] = ()
    run: tuple[str, ...] = ()

    def compile(self, source: Path, core: Path, *more: str, compiler: str = "") -> Path:
        out = source.with_suffix(f".{compiler or self.c}.o")
        command = [compiler or self.c, *self.flags, "-O2", *more, f"-I{core}", "-c", str(source), "-o", str(out)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        return out

    def output_of(self, objects: list[Path], folder: Path) -> str:
        """What their program prints."""
        built = folder / f"program.{self.c}"
        command = [self.cpp or self.c, *self.flags, *map(str, objects), *self.link, "-lm", "-o", str(built)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=300)
        assert done.returncode == 0, done.stderr
        done = subprocess.run([*self.run, str(built)], capture_output=True, text=True, timeout=60)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout


M4F = ("-mthumb", "-mcpu=cortex-m4", "-mfloat-abi=hard", "-mfpu=fpv4-sp-d16")
LINK_M4F = ("--specs=rdimon.specs", "-Wl,-u,_printf_float,-u,vectors,--section-start=.vectors=0")
EMULATOR = ("qemu-system-arm", "-machine", "mps2-an386", "-display", "none", "-monitor", "none", "-serial", "null",
            "-semihosting-config", "enable=on,target=native", "-kernel")  # fmt: skip
MACHINES = {
    "gcc": Machine("gcc", "g++"),
    "clang": Machine("clang", "clang++"),
    "m4f": Machine("arm-none-eabi-gcc", "", M4F, LINK_M4F, EMULATOR),
}


@pytest.fixture(scope="module")
def core(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first command: the core's two files."""
    folder = tmp_path_factory.mktemp("core")
    script = PROJECT / "tools" / "release" / "two_files.py"
    subprocess.run([sys.executable, "-I", str(script), "--out", str(folder)], check=True, timeout=60)
    return folder


@pytest.fixture(scope="module", params=MACHINES)
def machine(request: pytest.FixtureRequest, core: Path) -> tuple[Machine, list[Path]]:
    """A machine, and the core's objects for it."""
    found = MACHINES[request.param]
    for tool in (found.c, found.cpp, *found.run[:1]):
        if tool and shutil.which(tool) is None:
            pytest.skip(f"no {tool}")
    objects = [found.compile(core / "brace_core.c", core, "-std=c11")]
    if request.param == "m4f":
        start = core / "cortex_m.c"
        shutil.copyfile(BARE_LOOP / "cortex_m.c", start)
        objects.append(found.compile(start, core, "-std=c11"))
    return found, objects


def exported(brace: Brace, folder: Path, text: str, *options: object) -> Path:
    """The second command."""
    limb = folder / "limb.toml"
    limb.write_text(text)
    done = brace("export", "--model", limb, "--c", folder / "leg.c", *options)
    assert done.code == 0, done.err
    return limb


def asked(brace: Brace, limb: Path, *options: object) -> list[float]:
    """K by `brace k`."""
    angles = ("--theta1", BENT_RAD[1], "--theta2", BENT_RAD[2])
    done = brace("k", "--model", limb, *angles, *options, "--json")
    assert done.code == 0, done.err
    entries = ("xy", "yy", "yz") if "--theta0" in options else ("xx", "xz", "zz")
    return [float(json.loads(done.out)[f"k_{entry}_n_per_mm"]) for entry in entries]


@pytest.mark.parametrize("name", ["paper", "general", "spatial"])
def test_k_in_somebody_s_program_is_brace_k_s(
    brace: Brace, core: Path, machine: tuple[Machine, list[Path]], tmp_path: Path, name: str
) -> None:
    limb = exported(brace, tmp_path, {"paper": LIMB, "general": GENERAL, "spatial": SPATIAL}[name])
    (tmp_path / "main.c").write_text(program("planar" if name == "paper" else "general", name == "spatial"))
    place, objects = machine
    mine = [place.compile(tmp_path / file, core, "-std=c11", *STRICT) for file in ("main.c", "leg.c")]
    printed = [float(word) for word in place.output_of([*mine, *objects], tmp_path).split()]
    expected = asked(brace, limb) + asked(brace, limb, "--fx", 2.0, "--fz", 5.0)
    if name == "spatial":
        expected += asked(brace, limb, "--theta0", BENT_RAD[0])
    assert np.array(printed, np.float32).tolist() == np.array(expected, np.float32).tolist()


def test_as_cpp(brace: Brace, core: Path, machine: tuple[Machine, list[Path]], tmp_path: Path) -> None:
    """The same two files as C++17, with the two-file core and with the library's headers."""
    place, objects = machine
    if not place.cpp:
        pytest.skip("no C++ library is installed for it")
    limb = exported(brace, tmp_path, SPATIAL)
    (tmp_path / "main.c").write_text(program("general", True).replace("= {0}", "= {}"))
    as_cpp = ("-x", "c++", "-std=c++17", *STRICT)
    (tmp_path / "headers").symlink_to(PROJECT / "firmware" / "core" / "include")
    for headers in (core, tmp_path / "headers"):
        mine = [place.compile(tmp_path / file, headers, *as_cpp, compiler=place.cpp) for file in ("main.c", "leg.c")]
        printed = place.output_of([*mine, *objects], tmp_path).split()
        assert np.float32(printed[0]) == np.float32(asked(brace, limb)[0])


def test_with_the_library_s_headers(brace: Brace, machine: tuple[Machine, list[Path]], tmp_path: Path) -> None:
    exported(brace, tmp_path, SPATIAL)
    machine[0].compile(tmp_path / "leg.c", PROJECT / "firmware" / "core" / "include", "-std=c11", *STRICT)


def test_for_a_processor_without_an_fpu(
    brace: Brace, core: Path, machine: tuple[Machine, list[Path]], tmp_path: Path
) -> None:
    limb = exported(brace, tmp_path, LIMB, "--arith", "fixed")
    (tmp_path / "main.c").write_text(
        '#include <stdio.h>\n#include "leg.h"\nint main(void) { brace_stiffness_t k = {0};\n'
        "if (leg_check() != BRACE_OK ||\n"
        "    brace_planar_fixed_stiffness(&leg_fixed, 1 << 28, 5 << 26, &k) != BRACE_OK) { return 1; }\n"
        'printf("%.9g\\n", (double)k.k_xx_n_per_mm); return 0; }\n'
    )
    place, objects = machine
    mine = [place.compile(tmp_path / file, core, "-std=c11", *STRICT) for file in ("main.c", "leg.c")]
    printed = float(place.output_of([*mine, *objects], tmp_path))
    assert np.float32(printed) == np.float32(asked(brace, limb, "--arith", "fixed")[0])
    refused = brace(
        "export", "--model", exported(brace, tmp_path, GENERAL), "--c", tmp_path / "o.c", "--arith", "fixed"
    )
    assert refused.code == 3 and "--arith fixed" in refused.err and not (tmp_path / "o.c").exists()


def test_a_changed_number_is_found(
    brace: Brace, core: Path, machine: tuple[Machine, list[Path]], tmp_path: Path
) -> None:
    """A number of the limb edited by hand, and a constant."""
    exported(brace, tmp_path, LIMB)
    text = (tmp_path / "leg.c").read_text()
    place, objects = machine
    (tmp_path / "main.c").write_text(program("planar", False))
    main = place.compile(tmp_path / "main.c", core, "-std=c11")
    constant = next(line for line in text.splitlines() if "rest_per_mean */" in line)
    for before, after, status in (
        ("0.06f, /* link[BRACE_FEMUR]", "0.061f, /* link[BRACE_FEMUR]", E_CHECKSUM),
        (constant, constant.replace("0.006f", "0.007f"), E_SCHEMA),
    ):
        assert text.count(before) == 1 and before != after
        (tmp_path / "leg.c").write_text(text.replace(before, after))
        leg = place.compile(tmp_path / "leg.c", core, "-std=c11")
        assert place.output_of([main, leg, *objects], tmp_path).split() == [str(status)]


def test_a_core_of_another_version_is_found_by_the_compiler(brace: Brace, core: Path, tmp_path: Path) -> None:
    exported(brace, tmp_path, LIMB)
    other = tmp_path / "other"
    other.mkdir()
    header, members = (core / "brace_core.h").read_text(), "    float axial_mm_per_n;\n"
    assert header.count(members) == 1
    swapped = header.replace(members, "").replace("    float tilt_rad;\n", "    float tilt_rad;\n" + members, 1)
    (other / "brace_core.h").write_text(swapped)
    command = ["gcc", "-std=c11", f"-I{other}", "-fsyntax-only", str(tmp_path / "leg.c")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode != 0 and "export the limb again" in done.stderr


def test_any_limb_s_numbers_come_back_bit_for_bit(brace: Brace, core: Path, tmp_path: Path) -> None:
    """Random limbs, each checked by its own checksum and against constants made anew: both compare bits."""
    draw = random.Random(20)
    sources = []
    for index in range(12):
        text = GENERAL if index % 2 else SPATIAL
        for number in ("0.0007", "0.0333", "0.123456789", "1.7e-5", "3.3e-5", "120.1", "173.3", "1e-7"):
            text = text.replace(f"= {number}\n", f"= {float(number) * draw.uniform(0.3, 3.0)!r}\n")
        limb = tmp_path / "limb.toml"
        limb.write_text(text)
        assert brace("export", "--model", limb, "--c", tmp_path / f"leg{index}.c").code == 0
        sources.append(tmp_path / f"leg{index}.c")
    calls = " + ".join(f"(leg{index}_check() == BRACE_OK)" for index in range(12))
    includes = "".join(f'#include "leg{index}.h"\n' for index in range(12))
    main = tmp_path / "main.c"
    main.write_text(f'#include <stdio.h>\n{includes}int main(void) {{ printf("%d\\n", {calls}); return 0; }}\n')
    here = MACHINES["gcc"]
    objects = [here.compile(source, core, "-std=c11", "-Werror") for source in (main, *sources)]
    core_object = here.compile(core / "brace_core.c", core, "-std=c11")
    assert here.output_of([*objects, core_object], tmp_path).strip() == "12"


def test_its_crc_is_the_controller_s(brace: Brace, tmp_path: Path) -> None:
    limb = exported(brace, tmp_path, SPATIAL)
    packed = json.loads(brace("params", "pack", "--model", limb, "--out", tmp_path / "block.bin", "--json").out)
    assert f"LEG_PARAMETER_CRC 0x{packed['parameter_crc']}u" in (tmp_path / "leg.h").read_text()


@pytest.mark.parametrize(
    ("file", "fitting"),
    [("my-leg.c", "my_leg.c"), ("2legs.c", "limb_2legs.c"), ("int.c", "limb_int.c"),
     ("brace_limb.c", "limb_brace_limb.c"),
     ("leg.h", "leg.c"), ("status.c", "limb_status.c")],
)  # fmt: skip
def test_names_that_c_does_not_take(brace: Brace, tmp_path: Path, file: str, fitting: str) -> None:
    limb = exported(brace, tmp_path, LIMB)
    refused = brace("export", "--model", limb, "--c", tmp_path / file)
    assert refused.code == 2 and f"--c {tmp_path / fitting}" in refused.err
    assert brace("export", "--model", limb, "--c", tmp_path / fitting).code == 0


def test_what_c_has_no_member_for_is_said(brace: Brace, tmp_path: Path) -> None:
    text = LIMB.replace("[joint.tibia]", "[joint.tibia]\ncoulomb_n_mm = 40.0\ngap_rad = 0.004")
    limb = tmp_path / "limb.toml"
    limb.write_text(text)
    done = brace("export", "--model", limb, "--c", tmp_path / "leg.c", "--json")
    assert json.loads(done.out)["left_out"] == ["joint.tibia.coulomb_n_mm"]  # the core's brace_limb_t has the play
    assert "joint.tibia.coulomb_n_mm = 40.0" in (tmp_path / "leg.h").read_text()


def test_the_example_is_what_the_command_writes(brace: Brace, paper_limb: Path, tmp_path: Path) -> None:
    assert brace("export", "--model", paper_limb, "--c", tmp_path / "limb.c").code == 0
    for name in ("limb.c", "limb.h"):
        assert (tmp_path / name).read_text() == (BARE_LOOP / name).read_text(), "export it again, see the Makefile"

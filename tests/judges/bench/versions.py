"""The versions under test: which function is counted, what it is made of, with which flags."""

from dataclasses import dataclass
from pathlib import Path

import fetch
from postures import Limb, coxa_limb, paper_limb, tilted_limb
from toolchain import BENCH, CORE, M3, M4F, Processor


@dataclass(frozen=True)
class Version:
    """One row of the bench. `sources` are what the function is made of, `job` feeds it the postures."""

    name: str
    group: str
    processor: Processor
    function: str
    sources: tuple[Path, ...]
    job: Path
    flags: tuple[str, ...] = ("-O2",)
    job_flags: tuple[str, ...] = ()
    flash_with: tuple[str, ...] = ()  # further functions whose flash belongs to it
    limb: Limb | None = None
    ours: bool = False

    @property
    def key(self) -> str:
        """A file name."""
        return "".join(c if c.isalnum() else "_" for c in f"{self.group} {self.name}").lower()


PEERS = BENCH / "peers"
OURS = BENCH / "ours"
EIGEN_FLAGS = ("-DNDEBUG", "-I/usr/include/eigen3")
FLOAT_FUNCTIONS = ("-include", str(PEERS / "float_functions.h"), "-fsingle-precision-constant")
SPATIAL_LIMB = "-DBENCH_PEER_LIMB=BENCH_COXA_LIMB"

PLANAR = "planar K, Cortex-M4F"
PLANAR_NO_FPU = "planar K, Cortex-M3 without FPU"
SPATIAL = "spatial K, Cortex-M4F"
COLLAPSE = "parameter change, Cortex-M4F"
GROUPS = (PLANAR, PLANAR_NO_FPU, SPATIAL, COLLAPSE)


def core_sources() -> tuple[Path, ...]:
    """Everything of firmware/core; the linker keeps what is called."""
    return tuple(sorted((CORE / "src").glob("*/*.c")))


def _ours(name: str, group: str, function: str, job: str, limb: str = "PAPER", processor: Processor = M4F,
          flash_with: tuple[str, ...] = ()) -> Version:
    limbs = {"PAPER": paper_limb, "TILTED": tilted_limb, "COXA": coxa_limb}
    job_flags = (f"-DBENCH_LIMB=BENCH_{limb}_LIMB",)
    return Version(name, group, processor, function, core_sources(), OURS / job, (), job_flags, flash_with,
                   limbs[limb](), True)


def ours() -> list[Version]:
    """The core's own paths."""
    collapse = "brace_planar_collapse"
    return [
        _ours("Brace", PLANAR, "brace_planar_stiffness", "planar_job.c", flash_with=(collapse,)),
        _ours("Brace, tilted limb", PLANAR, "brace_planar_stiffness", "planar_job.c", "TILTED", flash_with=(collapse,)),
        _ours("Brace, fixed point", PLANAR_NO_FPU, "brace_planar_fixed_stiffness", "planar_fixed_job.c", processor=M3),
        _ours("Brace, fixed point, tilted limb", PLANAR_NO_FPU, "brace_planar_fixed_stiffness", "planar_fixed_job.c",
              "TILTED", M3),
        _ours("Brace, rigid coxa link", SPATIAL, "brace_spatial_stiffness", "spatial_job.c",
              flash_with=("brace_spatial_collapse",)),
        _ours("Brace, coxa link yields", SPATIAL, "brace_spatial_stiffness", "spatial_job.c", "COXA",
              flash_with=("brace_spatial_collapse",)),
        _ours("Brace, collapse", COLLAPSE, collapse, "collapse_job.c"),
    ]


def _peer(name: str, group: str, function: str, sources: tuple[Path, ...], job: Path, flags: tuple[str, ...],
          processor: Processor = M4F) -> Version:
    limb = coxa_limb() if group == SPATIAL else paper_limb()
    job_flags = (SPATIAL_LIMB, f"-DBENCH_SPATIAL={function}") if group == SPATIAL else (f"-DBENCH_PLANAR={function}",)
    return Version(name, group, processor, function, sources, job, flags, job_flags, limb=limb)


def peers(casadi_code: Path) -> list[Version]:
    """The others, each as its users would write it; casadi_code: folder of the generated C."""
    casadi = PEERS / "casadi_job.c"
    plain = PEERS / "plain_job.c"
    eigen = PEERS / "eigen_job.cpp"
    dsp = fetch.cmsis_dsp()
    dsp_sources = tuple(dsp / "Source" / name for name in (
        "MatrixFunctions/arm_mat_init_f32.c", "MatrixFunctions/arm_mat_mult_f32.c",
        "MatrixFunctions/arm_mat_add_f32.c", "MatrixFunctions/arm_mat_trans_f32.c",
        "MatrixFunctions/arm_mat_inverse_f32.c", "FastMathFunctions/arm_sin_f32.c",
        "FastMathFunctions/arm_cos_f32.c", "FastMathFunctions/arm_atan2_f32.c",
        "CommonTables/arm_common_tables.c", "SupportFunctions/arm_copy_f32.c"))
    # The library's own switch for building without CMSIS-Core's headers, which its float functions do not need;
    # -fno-math-errno gives back the square-root instruction that those headers would have chosen.
    dsp_flags = ("-O2", f"-I{dsp / 'Include'}", f"-I{dsp / 'PrivateInclude'}", "-D__GNUC_PYTHON__", "-fno-math-errno")
    planar_text, spatial_text = casadi_code / "casadi_planar.c", casadi_code / "casadi_spatial.c"
    eigen_planar = "_Z15eigen_stiffnessRK12plain_limb_tffR17plain_stiffness_t"
    eigen_spatial = "_Z23eigen_spatial_stiffnessRK12plain_limb_tfffR15plain_spatial_t"
    return [
        _peer("CasADi C, float functions", PLANAR, "casadi_planar", (planar_text,), casadi, ("-O2", *FLOAT_FUNCTIONS)),
        _peer("CasADi C, as generated", PLANAR, "casadi_planar", (planar_text,), casadi, ("-O2",)),
        _peer("Eigen fixed size, -O2", PLANAR, eigen_planar, (PEERS / "eigen.cpp",), eigen, ("-O2", *EIGEN_FLAGS)),
        _peer("Eigen fixed size, -O3", PLANAR, eigen_planar, (PEERS / "eigen.cpp",), eigen, ("-O3", *EIGEN_FLAGS)),
        _peer("CMSIS-DSP", PLANAR, "cmsis_dsp_stiffness", (PEERS / "cmsis_dsp.c", *dsp_sources), plain, dsp_flags),
        _peer("plain C, newlib, -O2", PLANAR, "plain_stiffness", (PEERS / "plain.c",), plain, ("-O2",)),
        _peer("plain C, newlib, -O3", PLANAR, "plain_stiffness", (PEERS / "plain.c",), plain, ("-O3",)),
        _peer("plain C, soft float", PLANAR_NO_FPU, "plain_stiffness", (PEERS / "plain.c",), plain, ("-O2",), M3),
        _peer("CasADi C, soft float", PLANAR_NO_FPU, "casadi_planar", (planar_text,), casadi, ("-O2", *FLOAT_FUNCTIONS),
              M3),
        _peer("CasADi C, float functions", SPATIAL, "casadi_spatial", (spatial_text,), casadi,
              ("-O2", *FLOAT_FUNCTIONS)),
        _peer("Eigen fixed size, -O2", SPATIAL, eigen_spatial, (PEERS / "eigen.cpp",), eigen, ("-O2", *EIGEN_FLAGS)),
        _peer("plain C, newlib, -O2", SPATIAL, "plain_spatial_stiffness", (PEERS / "plain_spatial.c",), plain,
              ("-O2",)),
    ]

"""The one list of postures and limbs that every version in the bench is run on, from a fixed seed."""

from dataclasses import dataclass, replace

import numpy as np

SEED = 20170
COUNT = 200
THETA0_RAD = (-0.8, 0.8)
THETA1_RAD = (-1.0, 1.5)
THETA2_RAD = (0.2, 2.9)
Q28_PER_RAD = float(1 << 28)


@dataclass(frozen=True)
class Link:
    """A link's compliance ellipsoid; fields and units as in brace/limb.h."""

    axial_mm_per_n: float = 0.0
    bending_mm_per_n: float = 0.0
    tilt_rad: float = 0.0
    lateral_mm_per_n: float = 0.0
    torsion_rad_per_n_mm: float = 0.0
    moment_transfer: float = 0.0


@dataclass(frozen=True)
class Limb:
    """Lengths [mm], links and joint compliances [rad/(N mm)], coxa first."""

    coxa_mm: float
    femur_mm: float
    tibia_mm: float
    coxa: Link
    femur: Link
    tibia: Link
    joint_rad_per_n_mm: tuple[float, float, float]
    base_mm_per_n: tuple[float, float] = (0.0, 0.0)

    @property
    def links(self) -> tuple[Link, Link, Link]:
        """The links, coxa first."""
        return (self.coxa, self.femur, self.tibia)


def paper_limb() -> Limb:
    """The paper's limb of docs/physics.md with moment transfer on; nothing tilted."""
    return Limb(
        57.0, 185.0, 313.5,
        coxa=Link(),
        femur=Link(0.001, 0.06, 0.0, 0.06, 2.0e-6, 1.0),
        tibia=Link(0.002, 0.25, 0.0, 0.25, 3.0e-6, 0.0),
        joint_rad_per_n_mm=(1.2e-5, 1.0e-5, 1.6e-5),
    )


def coxa_limb() -> Limb:
    """The paper's limb with a coxa link that yields too: the spatial model with every term in use."""
    return replace(paper_limb(), coxa=Link(0.0005, 0.004, 0.0, 0.005, 1.0e-6, 1.0))


def tilted_limb() -> Limb:
    """A limb with both ellipsoids tilted and half the moment transfer: what the peers' model leaves out."""
    limb = paper_limb()
    return replace(
        limb,
        femur=replace(limb.femur, tilt_rad=0.21, moment_transfer=0.5),
        tibia=replace(limb.tibia, tilt_rad=-0.33),
    )


def beam_limb() -> Limb:
    """The paper's limb with beams for links: what K under a load is counted and judged on."""
    limb = paper_limb()
    return replace(limb, tibia=replace(limb.tibia, moment_transfer=1.0))


def random_limbs(count: int = 64) -> list[Limb]:
    """Limbs of every kind for the parameter change: slender to round, tilted or not, with and without springs and
    moment transfer, legs of equal length among them."""
    rng = np.random.default_rng(SEED + 1)
    limbs = [paper_limb(), tilted_limb()]
    while len(limbs) < count:
        ratio = 10.0 ** rng.uniform(-3.0, 0.0, 2) * rng.choice([0.0, 1.0], 2, p=[0.1, 0.9])
        bending = 10.0 ** rng.uniform(-2.0, 0.0, 2)
        tilt = rng.uniform(-0.5, 0.5, 2) * rng.integers(0, 2, 2)
        joints = 10.0 ** rng.uniform(-6.0, -3.0, 3) * rng.integers(0, 2, 3)
        femur_mm = float(rng.uniform(80, 300))
        tibia_mm = femur_mm if rng.random() < 0.25 else float(rng.uniform(80, 400))
        limbs.append(Limb(
            57.0, femur_mm, tibia_mm,
            coxa=Link(),
            femur=Link(float(bending[0] * ratio[0]), float(bending[0]), float(tilt[0]), float(bending[0]), 1e-6,
                       float(rng.choice([0.0, 0.5, 1.0]))),
            tibia=Link(float(bending[1] * ratio[1]), float(bending[1]), float(tilt[1]), float(bending[1]), 1e-6),
            joint_rad_per_n_mm=(float(joints[0]), float(joints[1]), float(joints[2])),
        ))
    return limbs


def postures() -> np.ndarray:
    """theta0, theta1, theta2 [rad], shape (COUNT, 3), float32: exactly the numbers the images are given."""
    rng = np.random.default_rng(SEED)
    low, high = np.array([THETA0_RAD, THETA1_RAD, THETA2_RAD]).T
    return rng.uniform(low, high, (COUNT, 3)).astype(np.float32)


def workspace() -> np.ndarray:
    """Postures from the whole workspace, straight and folded knees included, shape (COUNT, 3), float32: for what
    must hold everywhere (one path, one count)."""
    edge = np.pi - 1.0e-6
    theta1 = [-edge, -np.pi / 2, 0.0, np.pi / 2, edge]
    theta2 = [-edge, -1.0, -1.0e-6, 0.0, 1.0e-6, 1.0e-3, np.pi / 2, np.pi - 1.0e-3, edge]
    corners = np.array([(0.0, a, b) for a in theta1 for b in theta2])
    rng = np.random.default_rng(SEED + 2)
    return np.vstack([corners, rng.uniform(-edge, edge, (COUNT - len(corners), 3))]).astype(np.float32)


def q28(angles_rad: np.ndarray) -> np.ndarray:
    """Angles in fixed point, int32 [rad * 2^28]."""
    return np.rint(angles_rad.astype(np.float64) * Q28_PER_RAD).astype(np.int32)


def _float(value: float) -> str:
    return f"{float(np.float32(value)).hex()}f"


def _limb_initialiser(limb: Limb) -> str:
    links = ", ".join(
        "{" + ", ".join(map(_float, (link.axial_mm_per_n, link.bending_mm_per_n, link.tilt_rad, link.lateral_mm_per_n,
                                     link.torsion_rad_per_n_mm, link.moment_transfer))) + "}"
        for link in limb.links)
    joints = ", ".join("{" + f"{_float(c)}, 0.0f, 0.0f" + "}" for c in limb.joint_rad_per_n_mm)
    base = ", ".join(map(_float, (*limb.base_mm_per_n, 0.0)))
    lengths = ", ".join(map(_float, (limb.coxa_mm, limb.femur_mm, limb.tibia_mm)))
    return "{" + f"{lengths}, {{{links}}}, {{{joints}}}, {{{base}}}, {{0.5f, 0.003f, 0.05f, 0.005f}}" + "}"


def _list(name: str, rows: list[str]) -> str:
    return f"#define {name} {{ \\\n" + ", \\\n".join("    " + row for row in rows) + " }\n"


def header() -> str:
    """C text with the postures and limbs, in the layout of brace/limb.h; included by every image and host program."""
    both = np.vstack([postures(), workspace()])
    limbs = random_limbs()

    def floats(rows: np.ndarray) -> list[str]:
        return ["{" + ", ".join(map(_float, row)) + "}" for row in rows]

    def integers(rows: np.ndarray) -> list[str]:
        return ["{" + ", ".join(str(int(v)) for v in row) + "}" for row in rows]

    return "".join((
        "/* Generated by tests/judges/bench/postures.py. _ALL: the postures, then as many from the whole workspace. */\n",
        f"#define BENCH_POSTURE_COUNT {COUNT}\n",
        _list("BENCH_POSTURES", floats(postures())),
        f"#define BENCH_ALL_COUNT {2 * COUNT}\n",
        _list("BENCH_ALL", floats(both)),
        _list("BENCH_ALL_Q28", integers(q28(both))),
        f"#define BENCH_PAPER_LIMB {_limb_initialiser(paper_limb())}\n",
        f"#define BENCH_TILTED_LIMB {_limb_initialiser(tilted_limb())}\n",
        f"#define BENCH_BEAM_LIMB {_limb_initialiser(beam_limb())}\n",
        f"#define BENCH_COXA_LIMB {_limb_initialiser(coxa_limb())}\n",
        f"#define BENCH_LIMB_COUNT {len(limbs)}\n",
        _list("BENCH_LIMBS", [_limb_initialiser(limb) for limb in limbs]),
    ))

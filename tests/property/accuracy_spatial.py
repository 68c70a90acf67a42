"""How far K in space is from double precision, limb by limb over the whole workspace.

K within 1e-5 of lambda_max, each eigenvalue within 1e-5 of itself, the stiff axis an eigenvector within 1e-5, or the
posture is flagged or the limb refused. Exit code 1 beyond that.
"""
from __future__ import annotations

import argparse
import ctypes
import sys
from dataclasses import replace

import numpy as np

import planar_oracle as plane
import spatial_oracle as oracle
from core_library import core_library, floats_of

LIMIT = 1e-5
NEAR_SINGULAR = 2


def limbs() -> list[plane.Limb]:
    """The planar limbs standing on a coxa: rigid, round, slender and tilted, passing moments on; an unequal base."""
    def side(link: plane.Link) -> plane.Link:
        return replace(link, lateral=max(link.bending, 1e-3), torsion=2e-6)

    coxas = [
        plane.Link(lateral=0.004),
        plane.Link(0.0005, 0.004, lateral=0.005, torsion=1e-6, moment_transfer=1.0),
        plane.Link(0.01, 0.01, 0.3, lateral=0.02),
        plane.Link(2e-4, 0.08, -0.4, lateral=0.05, torsion=3e-6, moment_transfer=0.6),
    ]
    found = []
    for index, limb in enumerate(plane.limbs()):
        bases = (limb.base_x, limb.base_z) if index % 3 else (0.03, 0.002)
        found.append(replace(limb, coxa=coxas[index % 4], femur=side(limb.femur), tibia=side(limb.tibia),
                             joints=(1.2e-5 * (index % 5), *limb.joints[1:]), base_x=bases[0], base_z=bases[1]))
    return found


def random_limb(rng: np.random.Generator) -> plane.Limb:
    """Any sane limb, with a coxa."""
    limb = plane.random_limb(rng)
    coxa = plane.random_limb(rng)

    def side(link: plane.Link) -> plane.Link:
        return replace(link, lateral=10 ** rng.uniform(-3, 0), torsion=rng.choice([0.0, 10 ** rng.uniform(-7, -5)]))

    return replace(limb, coxa=side(coxa.femur), femur=side(limb.femur), tibia=side(limb.tibia),
                   joints=(rng.choice([0.0, 10 ** rng.uniform(-7, -4)]), *limb.joints[1:]),
                   base_x=rng.choice([0.0, 10 ** rng.uniform(-4, -1)]),
                   base_z=rng.choice([0.0, 10 ** rng.uniform(-4, -1)]))


def errors(library: ctypes.CDLL, limb: plane.Limb, postures: list[np.ndarray]) -> tuple[np.ndarray, float] | None:
    """Worst errors [K, eigenvalues, axis] of the postures without flag, and the others' share; None: a refused limb.

    postures: theta0, theta1, theta2 [rad], float32, shape (n,).
    """
    count = postures[0].size
    rows = np.empty((count, 13), np.float32)
    if library.spatial_rows(limb.floats(), ctypes.c_size_t(count), *map(floats_of, postures), floats_of(rows)):
        return None
    flagged = (rows[:, 12].astype(int) & NEAR_SINGULAR) != 0
    if np.all(flagged):
        return np.zeros(3), 1.0
    truth = oracle.spatial(limb, *(p[~flagged].astype(float) for p in postures))
    got = rows[~flagged].astype(float)
    k = got[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(-1, 3, 3)
    most = truth.eigenvalues[:, 2]
    axis = got[:, 9:12]
    off = np.einsum("nij,nj->ni", truth.k, axis) - most[:, None] * axis
    unit = abs(np.linalg.norm(axis, axis=1) - 1)
    worst = np.array([np.max(abs(k - truth.k) / most[:, None, None]), np.max(abs(got[:, 6:9] / truth.eigenvalues - 1)),
                      max(np.max(np.linalg.norm(off, axis=1) / most), np.max(unit))])
    return worst, float(np.mean(flagged))


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--postures", type=int, default=5000)
    parser.add_argument("--random", type=int, default=60, help="random limbs besides the named ones")
    options = parser.parse_args()
    rng = np.random.default_rng(11)
    library = core_library()
    named = limbs()
    print(f"{'limb':16s} {'K':>9s} {'lambda':>9s} {'axis':>9s}")
    failed, refused, worst_random, most_flagged = 0, 0, np.zeros(3), 0.0
    for index, limb in enumerate(named + [random_limb(rng) for _ in range(options.random)]):
        theta1, theta2 = plane.postures(rng, options.postures)
        theta0 = rng.uniform(-np.pi, np.pi, theta1.size).astype(np.float32)
        result = errors(library, limb, [theta0, theta1, theta2])
        if result is None:
            refused += 1
            print(f"{limb.name:16s} refused")
            continue
        found, flagged = result
        most_flagged = max(most_flagged, flagged)
        bad = bool(np.any(~(found <= LIMIT)))
        failed += bad
        if index < len(named) or bad:
            print(f"{limb.name:16s} " + " ".join(f"{e:9.1e}" for e in found)
                  + (f"  {flagged:.1%} of postures flagged" if flagged else "") + ("  FAIL" if bad else ""))
        if index >= len(named):
            worst_random = np.maximum(worst_random, found)
    print(f"{options.random:4d} random      " + " ".join(f"{e:9.1e}" for e in worst_random))
    print(f"refused {refused} of {len(named) + options.random}, at most {most_flagged:.1%} of a limb's postures "
          f"flagged; {failed} beyond the limits")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

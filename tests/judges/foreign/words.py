"""What may be said of each trouble of the instruments and of each outsider. The one table by which naming is judged."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class May:
    """`names`: effects or rival causes that name the trouble, also as members of a class that was named. `verdicts`:
    those that count without a name. `finding`: what a data fault, a note or the description of what is unexplained
    must hold, as a regular expression, to count as naming it. `silence`: saying that nothing is missing is right,
    too."""

    names: tuple[str, ...]
    verdicts: tuple[str, ...]
    finding: str
    silence: bool
    reason: str
    also: tuple[str, ...] = ()  # names that are right, but do not name the trouble


TROUBLES: dict[str, May] = {
    "gain_step": May(("gain_step",), ("data_fault",), r"gain.*(step|chang|other)", False,
                     "the sensor is no longer the one that was calibrated: neither the limb nor a constant gain"),
    "zero_per_part": May(("zero_step", "zero_per_run"), ("data_fault",), r"zero.*(step|differ|other|chang)", False,
                         "zeros that differ from part to part are no drift in time and no bias"),
    "pose_error": May(("pose_error",), ("data_fault",), r"posture|pose error", True,
                      "where repeats show it, it is noise of the record, and a sound limb is sound"),
    "lag": May(("lag",), ("data_fault",), r"\blag\b|reads? late|delay|\blate\b", False,
               "a loop whose height grows with the speed; exporting it as friction or creep gives the limb what the "
               "recorder has"),
    "clock_origin": May((), (), r"clock|origin of time", True,
                        "no number of the limb depends on where a clock begins: nothing needs to be said"),
    "outliers": May(("outliers",), ("data_fault",), r"outlier|slipped|stand out|single reading", False,
                    "the readings must be listed, since the next user of the file would fit them"),
    "coarse_resolution": May((), (), r"resolution|count|rounding|coarse", True,
                             "the resolution is part of the noise: a sound limb is sound"),
    "rig_rotation": May(("rig_rotation",), ("data_fault",), r"rig.*turned|axes.*turned", False,
                        "equal to a turned sensor with a turned femur; only the class names it"),
    "rig_compliance": May(("rig_compliance",), ("data_fault",), r"rig.*yield", False,
                          "equal to a base or a link that yields; only the class names it"),
    "posture_clearance": May(("hold_clearance",), ("data_fault", "unknown"), r"clearance|config(uration)? \d+", False,
                             "no entry has play at one posture only; play of a joint or of the contact is exported to "
                             "every posture, which is wrong, so that unknown is the right word"),
    "coarse_encoder": May((), (), r"resolution|count|encoder|coarse", True,
                          "the encoder's step is part of the noise: a sound joint is sound"),
    "free_travel_left_in": May(("free_travel",), ("data_fault", "unknown"), r"free|unlocked|not loaded|no load", False,
                               "rows of another experiment: whatever is fitted to them is none of the joint"),
    "other_units": May((), ("data_fault",), r"unit|N m\b|revolution", False,
                       "nothing can be named before the units are right"),
}  # fmt: skip

OUTSIDERS: dict[str, May] = {
    "cogging": May(("cogging",), ("unknown",), r"cogging|every .* rad", False, "a shape, described and not exported"),
    "one_sided": May(("one_sided_spring", "asymmetric_spring"), ("unknown",), r"one.sided|one direction|side", False,
                     "a shape, described and not exported"),
    "end_stop": May(("end_stop",), ("unknown",), r"stop|one.sided|side", False, "a shape"),
    "softening": May(("joint_softening",), ("unknown",), r"soft", False,
                     "no spring of the catalogue becomes softer; negative hardening is refused by limb.toml"),
    "series_slip": May(("series_slip",), ("unknown",), r"slip", False, "free slip in series, by the contracts' name",
                       also=("coulomb_friction",)),
    "damper": May(("series_slip", "backlash"), ("unknown",), r"slip|free travel", False,
                  "the free travel is what its makers call backlash, and the friction behind it is dry friction; there "
                  "is no spring that could harden", also=("coulomb_friction",)),
    "viscosity": May(("viscosity", "viscous_friction"), ("unknown",), r"visc|speed", True,
                     "a shape; the spring is the believed one, so that naming nothing is right"),
}  # fmt: skip

# Friction in a loading record: of a law with or without a way before it slides. A record of readings at rest cannot show
# which, so that either name is right.
FRICTION = ("coulomb_friction", "presliding_friction")

"""The catalogue: one row for every effect that a diagnosis can name, instruments before physics.

Loading records, joint tests and tables of K read the same rows. row.py says what the fields mean, docs/adding.md what
else a new effect needs.
"""

from __future__ import annotations

from brace.effects.record import LoadingPlace
from brace.effects.row import Effect, InJointTest, Limits, Number, Tries, Turn, Way

JOINTS = ("joint.femur", "joint.tibia")
LINKS = ("link.femur", "link.tibia")
LINK_INDEX = {"link.femur": 1.0, "link.tibia": 2.0}  # as change.link counts

FRICTION_TURN = "friction_turn_rad"  # over which a joint's friction changes sign; a joint test's own, not of limb.toml

MOST_GAP = 0.95  # of the angles that a joint test visits: a small test may hardly leave a large gap
USUAL_LOAD_RATIO = 0.2  # friction over load: a gear with an efficiency of two thirds; more needs evidence to match
FADES_SHRINK = 0.005  # of the rms: by how much less a fading share must leave; physics expects it, so this is little
FADING_STARTS = ((8.0, 0.4), (40.0, 0.6))  # of one over the range of torques; and the share where nothing is carried
MOST_TIMES = 40  # at which a link's change is tried
CLIPPED_SIGMAS = 3.0  # of noise: by how much a clipped reading may lie below the level
READINGS_CLIPPED = (4, 8, 16, 32, 64, 128, 256)  # of which a saturation is tried


def between(low: float, high: float) -> Limits:
    """The same limits in every record."""
    return lambda at: (low, high)


def times_believed(low: float, high: float, reaching: float = 0.0) -> Limits:
    """Multiples of the believed value; the upper limit is at least `reaching`."""
    return lambda at: (low * at.believed, max(high * at.believed, reaching))


def tried_at(*values: float) -> Tries:
    """The same first tries in every record."""
    return lambda at: values


def cubic_n_mm_per_rad3(at: LoadingPlace) -> float:
    """A hardening that takes up all of the joint's torque at the deflection that this record reaches."""
    return at.torque_n_mm / at.deflection_rad**3


def saturation_limits(at: LoadingPlace) -> tuple[float, float]:
    """Up to about the largest reading. One clipped reading is enough: of all readings a glitch seldom hits the largest
    one, pulls it down and yet leaves it the largest."""
    highest = float(at.size.force_n[-1])
    return 0.05 * highest, highest + CLIPPED_SIGMAS * at.size.force_sigma_n


def saturation_tries(at: LoadingPlace) -> tuple[float, ...]:
    """A few sigmas below the largest reading, and where the largest few lie."""
    force_n = at.size.force_n
    low, high = saturation_limits(at)
    below = (float(force_n[-1]) - count * at.size.force_sigma_n for count in range(7))
    counted = (float(force_n[-count]) for count in READINGS_CLIPPED if count < force_n.size)
    return tuple(sorted({min(level, high) for level in (*below, *counted) if level > low}))


def change_limits(at: LoadingPlace) -> tuple[float, float]:
    """From the second run to the last."""
    starts_s = at.size.run_starts_s[1:]
    return starts_s[0] - 0.5 * at.size.dwell_s, starts_s[-1]


def change_tries(at: LoadingPlace) -> tuple[float, ...]:
    """The starts of the runs, thinned out where there are many."""
    starts_s = at.size.run_starts_s[1:]
    return tuple(starts_s[:: max(1, len(starts_s) // MOST_TIMES)])


def softening_limits(at: LoadingPlace) -> tuple[float, float]:
    """No joint gets a negative compliance at any temperature of the record."""
    most = 0.9 / at.size.temperature_range_degc
    return -most, max(most, 1.0)


EFFECTS: tuple[Effect, ...] = (
    Effect(
        "sensor_bias",
        ("sensor",),
        words="a sensor bias",
        meaning="the force sensor reads something when there is no force",
        law="reading = force + bias",
        told_by="the same offset at every load and posture; runs that are zeroed hide it",
        numbers=(
            Number("bias_x_n", 0.1, between(-1e3, 1e3)),
            Number("bias_z_n", 0.1, between(-1e3, 1e3)),
        ),
        ways=(Way(("bias_x_n",)), Way(("bias_z_n",)), Way(("bias_x_n", "bias_z_n"))),
        loading_seen=lambda size, where: not size.zeroed,
    ),
    Effect(
        "sensor_drift",
        ("sensor",),
        words="sensor drift",
        meaning="the force sensor's zero moves with time",
        law="reading = force + drift * t",
        told_by="an offset that grows with time, whatever the load",
        numbers=(
            Number("drift_x_n_per_s", 1e-4, between(-10.0, 10.0)),
            Number("drift_z_n_per_s", 1e-4, between(-10.0, 10.0)),
        ),
        ways=(Way(("drift_x_n_per_s",)), Way(("drift_z_n_per_s",)), Way(("drift_x_n_per_s", "drift_z_n_per_s"))),
        follows_time=True,
    ),
    Effect(
        "sensor_gain",
        ("sensor",),
        words="a sensor gain",
        meaning="every force reads too large or too small by one ratio",
        law="reading = gain * force",
        told_by="one ratio between readings and model everywhere, which encoders or a base gauge do not see",
        numbers=(Number("gain", 0.01, between(0.1, 10.0), trust="uncertainty.gain_rel"),),
        ways=(Way(("gain",)),),
    ),
    Effect(
        "sensor_rotation",
        ("sensor",),
        words="a turned sensor",
        meaning="the force sensor's axes are turned against the limb's",
        law="reading = [[cos, -sin], [sin, cos]] * force",
        told_by="each axis reads a share of the other, with opposite signs, at every posture",
        numbers=(Number("rotation_rad", 0.02, between(-0.8, 0.8)),),
        ways=(Way(("rotation_rad",)),),
    ),
    Effect(
        "sensor_crosstalk",
        ("sensor",),
        words="sensor cross-talk",
        meaning="force along one axis shows in the other's reading",
        law="reading = [[1, xz], [zx, 1]] * force",
        told_by="one axis reads a share of the other at every posture, and the other reads true",
        numbers=(
            Number("crosstalk_xz", 0.02, between(-0.9, 0.9)),
            Number("crosstalk_zx", 0.02, between(-0.9, 0.9)),
        ),
        ways=(Way(("crosstalk_xz",)), Way(("crosstalk_zx",)), Way(("crosstalk_xz", "crosstalk_zx"))),
    ),
    Effect(
        "sensor_saturation",
        ("sensor",),
        words="a saturated sensor",
        meaning="the force sensor's reading ends at a limit",
        law="each axis of the reading within +-limit",
        told_by="the largest readings are all the same, on both axes and for both signs",
        numbers=(Number("saturation_n", 1.0, saturation_limits, saturation_tries, still=True),),
        ways=(Way(("saturation_n",)),),
        loading_seen=lambda size, where: size.force_n.size > 1,
    ),
    Effect(
        "joint_zero_offset",
        JOINTS,
        words="a shifted joint zero",
        meaning="the joint stands at another angle than it is commanded to",
        law="true angle = commanded + offset",
        told_by="levers that fit another posture, at every posture by the same angle",
        numbers=(Number("zero_offset_rad", 0.01, between(-0.4, 0.4), trust="uncertainty.angle_rad"),),
        ways=(Way(("zero_offset_rad",)),),
    ),
    Effect(
        "link_length_error",
        ("geometry",),
        words="a link of another length",
        meaning="a link is longer or shorter than the model says",
        law="levers follow the true lengths",
        told_by="levers that are off by one ratio, at every posture",
        numbers=(
            Number("femur_mm", 1.0, times_believed(0.5, 2.0), trust="uncertainty.length_mm"),
            Number("tibia_mm", 1.0, times_believed(0.5, 2.0), trust="uncertainty.length_mm"),
        ),
        ways=(Way(("femur_mm",)), Way(("tibia_mm",)), Way(("femur_mm", "tibia_mm"))),
    ),
    Effect(
        "contact_play",
        ("contact",),
        words="play in the contact",
        meaning="the tip moves in its ball joint before it meets force",
        law="along each axis the tip stays until the imposed displacement is play/2 ahead of it",
        told_by="the same displacement is lost at every turn of the rig, at every posture and on both axes",
        numbers=(
            Number(
                "play_mm",
                0.05,
                lambda at: (0.0, 2.0 * at.size.displacement_mm),
                lambda at: tuple(at.size.displacement_mm * share for share in (0.001, 0.003, 0.01, 0.03, 0.1, 0.3)),
            ),
        ),
        ways=(Way(("play_mm",)),),
    ),
    Effect(
        "joint_compliance",
        JOINTS,
        words="another spring than believed",
        meaning="the joint's drive yields more or less to torque than the model says",
        law="deflection = compliance * torque",
        told_by="a deflection in proportion to the joint's torque; an encoder behind the gearbox reads it",
        numbers=(
            Number(
                "compliance_rad_per_n_mm",
                1e-5,
                times_believed(0.02, 50.0, 1e-3),
                trust="uncertainty.compliance_rel",
            ),
        ),
        ways=(Way(("compliance_rad_per_n_mm",)),),
        joint_test=InJointTest(
            turns=lambda size: (
                Turn(
                    "compliance_rad_per_n_mm",
                    0.2 / size.stiffness_n_mm_per_rad,
                    low=1e-3 / size.stiffness_n_mm_per_rad,
                ),
            ),
            starts=lambda size: ({"compliance_rad_per_n_mm": 1.0 / size.stiffness_n_mm_per_rad},),
            seen=lambda bench: bench.given,
        ),
        in_tables=True,
    ),
    Effect(
        "moment_transfer",
        ("link.femur",),
        words="bending passed on through the knee",
        meaning="the femur's end also turns under load, and the turn is carried on by the tibia's length",
        law="end [deflection; rotation] = [[b, 3b/2L], [3b/2L, 3b/L^2]] [force; moment]",
        told_by="a coupling between the two levers that no ellipsoid and no joint spring can make",
        numbers=(Number("moment_transfer", 1.0, tries=tried_at(0.15, 0.5)),),
        ways=(Way((), lambda where: {"moment_transfer": 1.0}), Way(("moment_transfer",))),
        loading_seen=lambda size, where: size.believed[f"{where}.moment_transfer"] == 0.0,
        in_tables=True,
    ),
    Effect(
        "base_compliance",
        ("base",),
        words="a yielding base",
        meaning="what the limb is mounted on gives way or turns under load",
        law="base displacement = compliance * force; base rotation = compliance * moment about the femur axis",
        told_by="a dial gauge against the base moves; a base that only turns looks like the femur joint's spring",
        numbers=(
            Number("x_mm_per_n", 0.05, between(0.0, 10.0), trust="uncertainty.compliance_rel"),
            Number("z_mm_per_n", 0.05, between(0.0, 10.0), trust="uncertainty.compliance_rel"),
            Number("rotation_rad_per_n_mm", 1e-5, between(0.0, 1e-2), trust="uncertainty.compliance_rel"),
        ),
        ways=(
            Way(("rotation_rad_per_n_mm",)),
            Way(("x_mm_per_n",)),
            Way(("z_mm_per_n",)),
            Way(("x_mm_per_n", "z_mm_per_n")),
            Way(("x_mm_per_n", "z_mm_per_n", "rotation_rad_per_n_mm")),
        ),
        in_tables=True,
    ),
    Effect(
        "link_compliance_error",
        LINKS,
        words="a link of another stiffness",
        meaning="the link yields more or less than its calibration says, by more than that is trusted to",
        law="end displacement = compliance ellipsoid * force",
        told_by="a deflection that turns with the link and that no encoder sees",
        numbers=(
            Number(
                "axial_mm_per_n",
                0.01,
                lambda at: (0.0, max(50.0 * at.believed, 1.0)),
                trust="uncertainty.compliance_rel",
                plausible_times=10.0,  # compliance is length over section: a tenth of the section would be left
            ),
            Number("bending_mm_per_n", 0.1, times_believed(0.02, 50.0, 1.0), trust="uncertainty.compliance_rel"),
            Number("tilt_rad", 0.1, between(-1.5, 1.5)),
        ),
        ways=(
            Way(("bending_mm_per_n",)),
            Way(("axial_mm_per_n",)),
            Way(("tilt_rad",)),
            Way(("bending_mm_per_n", "axial_mm_per_n")),
            Way(("bending_mm_per_n", "axial_mm_per_n", "tilt_rad")),
        ),
        in_tables=True,
    ),
    Effect(
        "link_change",
        LINKS,
        words="a link that changed",
        meaning="the link became softer or stiffer in the middle of the record",
        law="bending compliance is today's from at_s on, and times bending_factor before",
        told_by="the limb is one limb before a moment, and another after it",
        numbers=(
            Number("bending_factor", 0.1, between(0.05, 50.0), tried_at(1.05), table="change", still=True),
            Number("at_s", 100.0, change_limits, change_tries, table="change", stepwise=True, still=True),
            Number("link", 1.0, table="change", still=True),
        ),
        ways=(
            Way(
                ("bending_factor", "at_s"),
                lambda where: {"link": LINK_INDEX[where]},
                multiplies={"bending_factor": "bending_mm_per_n"},
                became=("stiffer in bending", "softer in bending"),
            ),
        ),
        loading_seen=lambda size, where: len(size.run_starts_s) > 1
        and size.believed[f"{where}.bending_mm_per_n"] > 0.0,
        follows_time=True,
        inspect="a crack or a loose joint",
    ),
    Effect(
        "backlash",
        JOINTS,
        words="backlash",
        meaning="the joint moves freely through its play before it carries torque",
        law="no torque while the deflection is within +-gap/2, a spring beyond",
        told_by="no rise of torque about zero, the same angle at every load",
        numbers=(
            Number(
                "gap_rad",
                0.002,
                tries=lambda at: tuple(at.deflection_rad * share for share in (0.01, 0.03, 0.1, 0.3, 1.0)),
                strained=True,
            ),
        ),
        ways=(Way(("gap_rad",)),),
        inspect="worn teeth or a loose coupling",
        wears=True,
        joint_test=InJointTest(
            turns=lambda size: (
                Turn("gap_rad", 0.1 * size.angle_rad, high=min(MOST_GAP * size.angle_rad, size.swing_rad)),
            ),
            starts=lambda size: tuple(
                {"gap_rad": share * min(size.angle_rad, size.swing_rad)} for share in (0.1, 0.3, 0.8)
            ),
            # a gap leaves less way to the spring
            spring_factor=lambda values, size: max(1.0 - values["gap_rad"] / size.angle_rad, 0.1),
            lost_rad=lambda values, size, compliance_rad_per_n_mm: values["gap_rad"],
        ),
    ),
    Effect(
        "coulomb_friction",
        JOINTS,
        words="dry friction",
        meaning="the joint's deflection sticks until the torque out of balance exceeds a bound: force depends on "
        "direction",
        law="deflection changes only where the torque out of balance exceeds coulomb + ratio * |spring torque|",
        told_by="force differs between the way out and the way back, at every load, and does not relax with time",
        numbers=(
            Number(
                "coulomb_n_mm",
                100.0,
                between(0.0, 1e7),
                lambda at: tuple(at.torque_n_mm * share for share in (0.003, 0.01, 0.03, 0.1, 0.3)),
            ),
            Number("coulomb_per_load_ratio", 0.1, strained=True),
        ),
        ways=(Way(("coulomb_n_mm",)),),
        joint_test=InJointTest(
            turns=lambda size: (
                Turn("coulomb_n_mm", 0.05 * size.torque_n_mm),
                Turn("coulomb_per_load_ratio", 0.1, prior_sigma=USUAL_LOAD_RATIO),
                Turn(
                    FRICTION_TURN,
                    0.01 * size.angle_rad,
                    1e-4 * size.angle_rad,
                    min(1.0, 0.25 * size.angle_rad),
                    start=0.01 * size.angle_rad,
                ),
            ),
            starts=lambda size: (
                {"coulomb_n_mm": 0.05 * size.torque_n_mm, "coulomb_per_load_ratio": 0.05},
                {"coulomb_n_mm": 0.05 * size.torque_n_mm, FRICTION_TURN: 0.1 * size.angle_rad},
            ),
            lost_rad=lambda values, size, compliance_rad_per_n_mm: 2.0
            * compliance_rad_per_n_mm
            * values["coulomb_n_mm"],
        ),
    ),
    Effect(
        "joint_hardening",
        JOINTS,
        words="a spring that hardens",
        meaning="the joint gets stiffer the more it is loaded",
        law="torque = deflection / compliance + hardening * deflection^3",
        told_by="torque that grows faster than the deflection, alike for both signs",
        numbers=(
            Number(
                "hardening_n_mm_per_rad3",
                1e7,
                lambda at: (0.0, 1e3 * cubic_n_mm_per_rad3(at)),
                lambda at: tuple(cubic_n_mm_per_rad3(at) * share for share in (0.01, 0.05, 0.3, 1.0)),
            ),
        ),
        ways=(Way(("hardening_n_mm_per_rad3",)),),
        joint_test=InJointTest(
            turns=lambda size: (Turn("hardening_n_mm_per_rad3", size.stiffness_n_mm_per_rad / size.angle_rad**2),),
            starts=lambda size: tuple(
                {"hardening_n_mm_per_rad3": share * size.stiffness_n_mm_per_rad / size.angle_rad**2}
                for share in (1.0, 10.0)
            ),
            # hardening takes torque from the spring: the same torque at the ends
            spring_factor=lambda values, size: 3.0,
            # a tenth of what it would be if the cubic carried all of the torque
            lost_rad=lambda values, size, compliance_rad_per_n_mm: compliance_rad_per_n_mm
            * values["hardening_n_mm_per_rad3"]
            * (0.5 * size.angle_rad) ** 3
            * 0.1,
        ),
    ),
    Effect(
        "creep",
        ("creep",),
        words="creep",
        meaning="the joints go on yielding after the load is on, so the force relaxes",
        law="delayed' = (ratio * elastic - delayed) / time constant, for each joint",
        told_by="force that relaxes while the tip is held, and more the longer it is held",
        numbers=(
            Number("ratio", 0.05, between(0.0, 10.0), tried_at(0.01, 0.1), strained=True),
            Number(
                "time_constant_s",
                30.0,
                lambda at: (0.2 * at.dwell_s, 1e3 * at.dwell_s),
                lambda at: tuple(at.dwell_s * factor for factor in (0.7, 2.5, 8.0, 25.0, 80.0)),
                still=True,
                strained=True,
            ),
        ),
        ways=(Way(("ratio", "time_constant_s")),),
        follows_time=True,
        inspect="a loose screw or a clamp that slips",
        wears=True,
        joint_test=InJointTest(
            turns=lambda size: (
                Turn("ratio", 0.1, high=1.0),
                Turn("time_constant_s", 0.1 * size.length_s, 0.01 * size.length_s, 0.5 * size.length_s),
            ),
            starts=lambda size: tuple(
                {"ratio": 0.1, "time_constant_s": share * size.length_s} for share in (0.05, 0.3)
            ),
            seen=lambda bench: bench.rests,
        ),
    ),
    Effect(
        "thermal_softening",
        ("thermal",),
        words="softening with temperature",
        meaning="the joints' compliance changes with temperature",
        law="joint compliance * (1 + rate * (temperature - reference))",
        told_by="a limb that gets softer or stiffer with the temperature, not with the time",
        numbers=(Number("joint_compliance_per_degc", 0.01, softening_limits),),
        ways=(Way(("joint_compliance_per_degc",)),),
        loading_seen=lambda size, where: size.temperature_range_degc > 0.1,
        follows_time=True,
        joint_test=InJointTest(
            turns=lambda size: (
                Turn("joint_compliance_per_degc", 0.005, -0.5 / size.temp_degc, 0.5 / size.temp_degc),
            ),
            starts=lambda size: ({"joint_compliance_per_degc": 0.005},),
            seen=lambda bench: bench.size.temp_degc >= 2.0,
        ),
    ),
    Effect(
        "gravity",
        ("gravity",),
        words="weight of the links",
        meaning="the weight of links and knee loads joints, links and base, by posture",
        law="weights along the links, and at the knee, act downwards on all that bends",
        told_by="an offset that is the same at every load and changes with the posture as the levers of weights do",
        numbers=(
            Number("knee_n", 1.0, between(0.0, 1e4)),
            Number("tibia_n", 1.0, between(0.0, 1e4)),
            Number("femur_n", 1.0, between(0.0, 1e4)),
        ),
        # Femur and knee load the same joint in the same proportion, so the knee stands for both; the femur's weight
        # hangs at half its length. They bend the femur differently, which a limb shows that turns.
        ways=(
            Way(("knee_n", "tibia_n"), stands_for={"knee_n": ("femur_n", 2.0)}),
            Way(("knee_n", "tibia_n", "femur_n"), seen=lambda size: size.turns),
        ),
    ),
)

for _effect in EFFECTS:
    _effect.check()

BY_NAME = {effect.name: effect for effect in EFFECTS}

# What steps of a diagnosis ask for: every number of an effect by its key, and keys of numbers with some property.
NUMBER_BY_KEY = {
    number.key(where): number for effect in EFFECTS for where in effect.places for number in effect.numbers
}
STILL_KEYS = frozenset(key for key, number in NUMBER_BY_KEY.items() if number.still)
TIME_KEYS = frozenset(key for effect in EFFECTS if effect.follows_time for key in effect.keys)

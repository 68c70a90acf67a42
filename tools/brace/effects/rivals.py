"""Causes outside the catalogue that a loading record cannot tell from an effect of it: one row for each.

They are never searched. Where the search has chosen an effect that such a cause would look like, the diagnosis asks
whether the cause explains the record as well (brace.diagnose.loading.rivals)."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

ROTATION, CROSSTALK = "sensor_rotation@sensor", "sensor_crosstalk@sensor"
FEMUR_ZERO, KNEE_ZERO = "joint_zero_offset@joint.femur", "joint_zero_offset@joint.tibia"
LENGTHS = "link_length_error@geometry"
BIAS, WEIGHT = "sensor_bias@sensor", "gravity@gravity"
BASE = "base_compliance@base"
FEMUR_LINK, TIBIA_LINK = "link_compliance_error@link.femur", "link_compliance_error@link.tibia"


@dataclass(frozen=True)
class Size:
    """A number of a rival: its key in diagnosis.json (seldom one of limb.toml), its unit, how far a fit may turn it.
    Up to `usual` it is no surprise. `plausible_times` as much is rare, and more needs evidence to match."""

    key: str
    unit: str
    low: float
    high: float
    usual: float = inf
    plausible_times: float = 10.0


@dataclass(frozen=True)
class RivalCause:
    """One row.

    words, meaning   as for an effect of the catalogue
    looks_like       sets of labels that this cause may stand in for, all of a set together
    ways             the sizes that are fitted, one way after the other
    in_limb          it is of the limb, so that its numbers are exported; else of the rig, and the limb is left alone
    same_because     why the record shows no difference, as the rest of a sentence that begins with "because"
    would_tell       the measurement that shows it, as an order
    twin             the effect of the catalogue that does the same to every reading ("" where there is none)
    rarer            than an effect of the catalogue it is, before a record is seen
    """

    name: str
    where: str
    words: str
    meaning: str
    looks_like: tuple[frozenset[str], ...]
    ways: tuple[tuple[Size, ...], ...]
    in_limb: bool
    same_because: str
    would_tell: str
    twin: str = ""
    rarer: float = 3.0  # whoever plans a test looks at rig and instruments first, and at the limb because of the test

    @property
    def label(self) -> str:
        """`rig_compliance@rig`."""
        return f"{self.name}@{self.where}"


_YIELDS_X = Size("rig.x_mm_per_n", "mm/N", 0.0, 10.0)
_YIELDS_Z = Size("rig.z_mm_per_n", "mm/N", 0.0, 10.0)
_YIELDS = Size("rig.mm_per_n", "mm/N", 0.0, 10.0)
_TURNED = Size("rig.rotation_rad", "rad", -0.4, 0.4)
_BESIDE = Size("geometry.knee_beside_femur_mm", "mm", -60.0, 60.0)
_BOW = Size("geometry.tibia_bow_mm", "mm", -120.0, 120.0)


def _off_centre_play(joint: str) -> RivalCause:
    play = f"backlash@joint.{joint}"
    return RivalCause(
        "off_centre_play",
        f"joint.{joint}",
        words="play that lies to one side at rest",
        meaning="the joint has play, and where nothing moves the tip it stands nearer to one side of it",
        looks_like=tuple(
            frozenset({play, other}) for other in (BIAS, WEIGHT, TIBIA_LINK, FEMUR_LINK, ROTATION, CROSSTALK)
        ),
        ways=(
            (
                Size(f"joint.{joint}.gap_rad", "rad", 0.0, 0.5),
                Size(f"joint.{joint}.gap_centre_rad", "rad", -0.25, 0.25),
            ),
        ),
        in_limb=True,
        same_because="a force that is there before the tip moves carries the play to one side as well",
        would_tell="push the unloaded tip to and fro by hand and read how far the joint is free on either side",
    )


RIVAL_CAUSES: tuple[RivalCause, ...] = (
    RivalCause(
        "rig_compliance",
        "rig",
        words="a test rig that yields",
        meaning="the rig between its displacement reading and the tip gives way under load; the limb is as believed",
        looks_like=(frozenset({BASE}), frozenset({TIBIA_LINK}), frozenset({FEMUR_LINK})),
        ways=((_YIELDS,), (_YIELDS_X, _YIELDS_Z)),
        in_limb=False,
        same_because="rig, limb and base carry the same force one after the other, and the record reads only how much "
        "they give way together",
        would_tell="put a dial gauge on the base (dataset columns base_x_mm, base_z_mm): it moves with a base that "
        "yields and stands still where the rig does",
        twin=BASE,
        rarer=1.0,  # rigs yield as often as bases do
    ),
    RivalCause(
        "rig_rotation",
        "rig",
        words="a test rig whose axes are turned",
        meaning="the rig moves the tip along axes that are turned against the limb's; the limb is as believed",
        looks_like=(
            frozenset({ROTATION, FEMUR_ZERO}),
            frozenset({CROSSTALK, FEMUR_ZERO}),
            frozenset({ROTATION}),
            frozenset({CROSSTALK}),
        ),
        ways=((_TURNED,),),
        in_limb=False,
        same_because="a limb that stands turned by an angle, read by a sensor turned back by it, gives every reading "
        "of a rig whose axes are turned by it",
        would_tell="turn the sensor by a quarter and load again, or read the direction in which the rig moves the tip "
        "against the robot's frame",
    ),
    RivalCause(
        "knee_offset",
        "joint.tibia",
        words="a knee beside the femur's line",
        meaning="the knee's axis stands beside the line that the femur's angle is measured along; K is the same",
        looks_like=(
            frozenset({FEMUR_ZERO, KNEE_ZERO}),
            frozenset({FEMUR_ZERO, KNEE_ZERO, LENGTHS}),
            frozenset({FEMUR_ZERO, KNEE_ZERO, FEMUR_LINK}),
        ),
        ways=((_BESIDE,),),
        in_limb=True,
        same_because="both put knee and tip at the same places at every posture",
        would_tell="measure how far the knee's axis stands beside the line from the femur's axis along the femur",
    ),
    RivalCause(
        "bowed_link",
        "link.tibia",
        words="a bowed tibia",
        meaning="the tibia is bent between knee and tip, so that it yields in turned directions; K is the same",
        looks_like=(frozenset({TIBIA_LINK}),),
        ways=((_BOW,),),
        in_limb=True,
        same_because="a bow turns the directions in which the tibia yields, and the tip shows nothing else of it",
        would_tell="lay a straight edge along the tibia",
    ),
    _off_centre_play("femur"),
    _off_centre_play("tibia"),
)

_SAME_READINGS = "the readings change by the same amounts at nearly the same rows"


def _trouble(
    name: str, where: str, words: str, meaning: str, would_tell: str, size: Size, rarer: float = 3.0
) -> RivalCause:
    return RivalCause(name, where, words, meaning, (), ((size,),), False, _SAME_READINGS, would_tell, rarer=rarer)


# Troubles of the instruments (brace.diagnose.loading.troubles fits them as columns beside the readings).
INSTRUMENT_TROUBLES: tuple[RivalCause, ...] = (
    _trouble(
        "lag", "sensor", "a sensor that reads late",
        "the forces are read a while after the displacements of the same row",
        "load once more with twice the dwell: a lag shows half as much or less, play as much as before",
        Size("sensor.lag_s", "s", -1e3, 1e3, usual=0.1),  # an amplifier's filter and a bus make some 10 to 100 ms
        rarer=1.0,  # a lag of that size is as common as play; its size and the rig's wait say the rest
    ),
    _trouble(
        "gain_step", "sensor", "a sensor whose gain stepped",
        "the force sensor's gain is another one from some run on",
        "hang a known weight on the sensor, before the record and after it",
        Size("sensor.gain_step_ratio", "", -1.0, 10.0),
    ),
    _trouble(
        "zero_step", "sensor", "a sensor whose zero stepped",
        "the force sensor's zero is another one from some run on",
        "read the unloaded sensor before each run",
        Size("sensor.zero_step_n", "N", -1e4, 1e4),
    ),
    _trouble(
        "zero_per_run", "sensor", "a sensor whose zero differs from run to run",
        "the force sensor's zero is another one in every run",
        "read the unloaded sensor before each run",
        Size("sensor.zero_step_n", "N", -1e4, 1e4),
    ),
    _trouble(
        "pose_error", "rig", "postures that differ from the commanded ones",
        "the drives stand at other angles in every run than the record says",
        "measure the joints' angles in every run (columns theta1_rad, theta2_rad)",
        Size("rig.pose_error_rad", "rad", -1.0, 1.0),
    ),
    _trouble(
        "rig_slip", "rig", "a clamp or a base that slipped",
        "the tip's clamp or the limb's base stands elsewhere from some reading on",
        "mark where clamp and base stand before the record, and look whether they moved",
        Size("rig.slip_mm", "mm", -1e3, 1e3),
    ),
    _trouble(
        "outliers", "sensor", "single readings that slipped",
        "single readings stand out of their run",
        "repeat the runs in which they are",
        Size("sensor.outlier_n", "N", -1e4, 1e4),
    ),
)  # fmt: skip

PRESLIDING = "presliding_friction"


def _strained(joint: str) -> RivalCause:
    return RivalCause(
        PRESLIDING,
        f"joint.{joint}",
        words="friction that is strained before it slides",
        meaning="the joint's friction builds up over a way before it slides (generalised Maxwell slip), or is partly "
        "shaken off by a joint that rings",
        looks_like=(),
        ways=((Size(f"joint.{joint}.coulomb_n_mm", "N mm", 0.0, 1e7),),),
        in_limb=True,
        same_because="both joints' friction makes nearly the same loops",
        would_tell="load the joint alone, over several amplitudes (a joint test)",
        rarer=1.0,  # most geared joints have it
    )


# Of the limb, and fitted as columns beside the readings as well: the plant's friction has no way before it slides.
STRAINED_JOINTS: tuple[RivalCause, ...] = (_strained("femur"), _strained("tibia"))

_ALL = (*RIVAL_CAUSES, *INSTRUMENT_TROUBLES, *STRAINED_JOINTS)
RIVAL_BY_NAME = {cause.name: cause for cause in _ALL}
TROUBLE_BY_KIND = {cause.name: cause for cause in INSTRUMENT_TROUBLES} | {one.label: one for one in STRAINED_JOINTS}
RIVAL_UNITS = {size.key: size.unit for cause in _ALL for way in cause.ways for size in way}

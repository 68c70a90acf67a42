"""The decisions that change a number, all in one table: each is a question of `brace import`, which --yes does not answer.
What is said behind the column's name, and the line of the mapping that answers it. What is plain is not asked."""

from __future__ import annotations

UNKNOWN_NAME = "the name says nothing that is known here"
WHICH_ANGLE = "which joint's angle?"
INNER_ANGLE = "an inner angle is 180 deg for a straight leg: then is = theta2_rad, sign = -1, offset = 3.14159265"
FROM_VERTICAL = "an angle from the vertical: theta1 counts from +x, so sign and offset must be said"
SHANKS_ANGLE = (
    "the knee's angle, or the shank's own? The knee's: is = theta2_rad. A record has no column for the shank's "
    "own: theta2 is the thigh's angle minus the shank's; compute it in your file"
)
NUMBERED_ANGLES = (
    "the joints are numbered: 1, 2, 3 may be coxa, femur, tibia (ignore, theta1_rad, theta2_rad), or femur, tibia and "
    "another"
)
PERHAPS_ANGLE = f"an angle of the posture? {UNKNOWN_NAME}"
CURRENT = "the present reading, or an electric current (ignore)? No unit says it"
FILTERED = "a raw or a filtered reading: is it the one to take? If another is, ignore"
SUMMARY = "a least, largest or mean value; a record has single readings (ignore, if others are there)"
NO_RESULTS = (
    "its cells are formulas whose results are not stored: open the file in Excel or LibreOffice and save it there; "
    'is = "ignore" if it was not measured'
)
FORMULAS_FAILED = 'its formulas failed; is = "ignore" if it was not measured'
NO_NUMBERS = 'its entries are no numbers ({}): write them as such; is = "ignore" if it was not measured'
NO_CLOCK = (  # of a whole log: a [[constant]] answers it
    "its entries neither rise nor fall over the file: they are distances from reading to reading (sum them up in your "
    'file), or the rows are out of order (sort them by time); or is = "ignore", and --set dwell=4s if they are even'
)
CLOCKS = 'two clocks that do not agree: is = "t_s" for when the sample was taken, is = "ignore" for the other'
CLOCK = (  # of a whole log: a [[constant]] answers it
    "when were the samples taken? {}. clock = stamp (--set clock=stamp) takes the stamps, and leaves the messages out that "
    "have none in a topic that has some; clock = log takes the times of the log for all topics, each late by its own delay"
)
TWO_MEANINGS = "{} has two meanings: {}"
WRAPPED = (
    "its readings lie at 0 to {:g} and at {:g} to {:g}, and none between: those above are negative numbers that were "
    "read unsigned, or an angle beyond a full turn. wrap = 65536.0 (for 16 bits, times what a count is; 360.0 for a turn "
    "in deg) is subtracted from them, wrap = 0.0 keeps them"
)
BENT_BACK = "all its entries are negative, and theta2 is the femur's angle from +x minus the tibia's"
POINTS_DOWN = "its name says down, and z is up"
FALLS = "it falls as {} grows"
GROWS_WITH_WEIGHT = "it grows with the weight, and z is up"
Y_FORCE = "a force along y: a limb's plane has x outwards and z up; which of them is it, or neither?"
Y_LENGTH = "a displacement along y: a limb's plane has x outwards and z up; which is it, or neither?"

# kind: what is said of the column, and the key of its [[column]] in the mapping that answers it
KINDS: dict[str, tuple[str, str]] = {
    "a unit with two meanings": (TWO_MEANINGS, "unit"),
    "joints that are numbered": (NUMBERED_ANGLES, "is"),
    "an angle of no known joint": (WHICH_ANGLE, "is"),
    "numbers that change as a posture does": (PERHAPS_ANGLE, "is"),
    "an inner angle": (INNER_ANGLE, "is"),
    "an angle from the vertical": (FROM_VERTICAL, "is"),
    "the shank's angle": (SHANKS_ANGLE, "is"),
    "current": (CURRENT, "is"),
    "raw and filtered": (FILTERED, "is"),
    "a summary of readings": (SUMMARY, "is"),
    "formulas without stored results": (NO_RESULTS, "is"),
    "formulas that failed": (FORMULAS_FAILED, "is"),
    "a measurement that is no number": (NO_NUMBERS, "is"),
    "times that are distances": (NO_CLOCK, "is"),
    "two clocks": (CLOCKS, "is"),
    "across the limb's plane": (Y_FORCE, "is"),
    "numbers read unsigned": (WRAPPED, "wrap"),
    "a knee that is negative": (BENT_BACK, "sign"),
    "a name that says down": (POINTS_DOWN, "sign"),
    "a force that falls": (FALLS, "sign"),
    "a displacement that grows with the weight": (GROWS_WITH_WEIGHT, "sign"),
}

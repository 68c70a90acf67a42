"""Stamps in two columns, seconds and nanoseconds, as ROS' tables have them: one time."""

from __future__ import annotations

import re
from dataclasses import replace

from brace.importing.part import Part

_SECONDS = re.compile(r"(.*stamp)[._/ ](?:secs?|seconds)", re.IGNORECASE)
_BELOW = ("nsecs", "nsec", "nanosec", "nanosecs", "nanoseconds")
_WHOLE = re.compile(r"\d{1,12}")


def joined(part: Part) -> Part:
    """The table with each such pair as one column in s, in the place of the seconds. Seconds alone are no time: their
    rows share one for a second."""
    for at, name in enumerate(part.names):
        found = _SECONDS.fullmatch(name)
        if not found:
            continue
        below = [
            other
            for other, each in enumerate(part.names)
            if each.lower() in {f"{found[1]}{mark}{word}".lower() for word in _BELOW for mark in "._/ "}
        ]
        if len(below) != 1:
            continue
        drop = below[0]
        rows = []
        for row in part.rows:
            both = _WHOLE.fullmatch(row[at]) and _WHOLE.fullmatch(row[drop])
            whole = f"{row[at]}{part.decimal}{int(row[drop]):09d}" if both else ""
            rows.append([whole if place == at else cell for place, cell in enumerate(row) if place != drop])
        names = [f"{found[1]} [s]" if place == at else each for place, each in enumerate(part.names) if place != drop]
        units = [each for place, each in enumerate(part.units) if place != drop]
        if units:
            units[at - (drop < at)] = "s"
        note = f"{name!r} and {part.names[drop]!r} are one time, {found[1]!r}"
        return replace(part, names=tuple(names), units=tuple(units), rows=rows, notes=(*part.notes, note))
    return part

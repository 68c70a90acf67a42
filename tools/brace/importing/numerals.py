"""Numbers as people's programs write them: decimal points or commas, thousands, clock times, marks for 'nothing'."""

from __future__ import annotations

import datetime
import math
import re
from collections.abc import Iterable, Sequence

MISSING = frozenset(
    ("", "nan", "na", "n/a", "#n/a", "#nv", "null", "none", "nil", "-", "--", "---", "?", "1.#qnan", "1.#ind",
     "-1.#ind", "-nan", "nan(ind)", "#div/0!", "#value!", "#wert!", "inf", "-inf", "+inf")
)  # fmt: skip
_PLAIN = re.compile(r"[-+]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][-+]?\d+)?")
_GROUPED = re.compile(
    r"[-+]?\d{1,3}(?:(?P<mark>[.,'\u2019\u00a0\u202f ])\d{3})(?:(?P=mark)\d{3})*(?:[.,]\d+)?(?:[eE][-+]?\d+)?"
)
# Without the other sign, or with it between groups of three digits, by the decimal sign.
_THOUSANDS = {
    ".": re.compile(r"[^,]*|[-+]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d*)?(?:[eE][-+]?\d+)?"),
    ",": re.compile(r"[^.]*|[-+]?[1-9]\d{0,2}(?:\.\d{3})+(?:,\d*)?(?:[eE][-+]?\d+)?"),
}
_MINUS = str.maketrans({"\u2212": "-", "\u2013": "-", "\u2012": "-", "\u00a0": " ", "\u202f": " "})
_CLOCK = re.compile(
    r"(?:(?P<date>[\d./-]+)[ T]+)?(?P<h>\d{1,2}):(?P<m>\d{2})(?::(?P<s>\d{2}(?:[.,]\d+)?))?\s*(?P<half>[AaPp][Mm])?"
    r"\s*(?:Z|UTC|GMT|(?P<zone>[+-]\d{2}:?\d{2}))?"
)
_MINUTES = re.compile(r"(\d{1,3}):(\d{2}[.,]\d+)")
_SHORT = re.compile(r"(\d{1,3}):(\d{2})")
_DATE = (("%Y-%m-%d"), ("%d.%m.%Y"), ("%d.%m.%y"), ("%Y/%m/%d"), ("%m/%d/%Y"), ("%d/%m/%Y"), ("%d-%m-%Y"))
DAY_S = 86400.0


def plain(text: str) -> str:
    """Without blanks around, with an ASCII minus, without a quote mark that forces text in spreadsheets."""
    return text.translate(_MINUS).strip().lstrip("'")


def is_missing(text: str) -> bool:
    """Whether the cell says that nothing was read."""
    return plain(text).lower() in MISSING


def is_number(text: str) -> bool:
    """Whether the cell is a number by one of the ways to write them."""
    text = plain(text)
    return bool(_PLAIN.fullmatch(text) or _GROUPED.fullmatch(text))


def decimal_sign(cells: Iterable[str]) -> tuple[str, str, str]:
    """The decimal sign of a file's numbers ("." or ","); "" where it is not known; "?" where numbers contradict one
    another. Behind it an example of each: with a point, with a comma."""
    point = comma = open_text = ""
    for cell in cells:
        text = plain(cell)
        if "," not in text and "." not in text or not is_number(text):
            continue
        body = text.lstrip("+-").lower().partition("e")[0]
        last = max(body.rfind(","), body.rfind("."))
        sign, before, after = body[last], body[:last], body[last + 1 :]
        if body.count(",") and body.count("."):
            decides = True
        elif body.count(sign) > 1:
            sign, decides = ("," if sign == "." else "."), True
        else:
            decides = len(after) != 3 or before in ("", "0") or len(before) > 3
        if not decides:
            open_text = open_text or text
        elif sign == ".":
            point = point or text
        else:
            comma = comma or text
    if point and comma:
        return "?", point, comma
    if point or comma:
        return ("." if point else ","), point, comma
    if not open_text:
        return ".", "", ""
    return ("." if "." in open_text else ""), open_text, open_text


def number(text: str, decimal: str) -> float:
    """The number; NaN where the cell is none, and where a comma or point in it is neither the decimal sign nor one of
    thousands."""
    text = plain(text)
    if not is_number(text):
        return math.nan
    text = re.sub(r"['\u2019 ]", "", text)
    if not _THOUSANDS[decimal].fullmatch(text):
        return math.nan
    text = text.replace("." if decimal == "," else ",", "")
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        return math.nan
    return value if math.isfinite(value) else math.nan


def clock_s(text: str) -> float:
    """Seconds of a clock time or a date with time, since midnight or since the calendar's beginning; NaN otherwise."""
    return clocks_s([text])[0] if ":" in text else math.nan


def clocks_s(texts: Sequence[str]) -> list[float]:
    """The same of a column, whose dates are all of one form. 03/04 may be of March or of April: of the forms that read
    the most dates it is the one in which they lie nearest to each other."""
    clocks = [_clock(text) for text in texts]
    dates = {date for date, _ in clocks if date}
    readings = ({date: day for date in dates if (day := _day(date, form)) is not None} for form in _DATE)
    days = min(readings, key=lambda read: (-len(read), max(read.values(), default=0) - min(read.values(), default=0)))
    return [seconds + (DAY_S * days.get(date, math.nan) if date else 0.0) for date, seconds in clocks]


def short_clock(text: str) -> float:
    """12:34 as 12 and 34 sixtieths, of an hour or of a minute: nothing in it says of which. NaN for any other text."""
    found = _SHORT.fullmatch(text.strip())
    return int(found[1]) + int(found[2]) / 60.0 if found else math.nan


def clocks_are_short(texts: Sequence[str]) -> bool:
    """Whether a column's times have two parts each, of which none has a fraction."""
    return any(_SHORT.fullmatch(text.strip()) for text in texts) and not clocks_are_minutes(texts)


def clocks_are_minutes(texts: Sequence[str]) -> bool:
    """Whether a column has minutes and seconds: 12:34.5."""
    return any(_MINUTES.fullmatch(text.strip()) for text in texts)


def _clock(text: str) -> tuple[str, float]:
    """The date as it is written, '' where there is none, and the seconds since midnight; NaN where it is no clock."""
    if minutes := _MINUTES.fullmatch(text.strip()):
        return "", 60.0 * int(minutes[1]) + float(minutes[2].replace(",", "."))
    found = _CLOCK.fullmatch(text.strip())
    if not found:
        return "", math.nan
    seconds = 3600.0 * int(found["h"]) + 60.0 * int(found["m"]) + float((found["s"] or "0").replace(",", "."))
    if found["half"]:
        seconds += (12 if found["half"].lower() == "pm" else 0) * 3600.0 - (12 * 3600.0 if int(found["h"]) == 12 else 0)
    if zone := found["zone"]:
        east = 3600.0 * int(zone[1:3]) + 60.0 * int(zone[-2:])
        seconds -= east if zone[0] == "+" else -east
    return found["date"] or "", seconds


def _day(date: str, form: str) -> int | None:
    """The day in the calendar; None where the date is of another form."""
    try:
        return datetime.datetime.strptime(date, form).toordinal()
    except ValueError:
        return None

"""What a column's name says: the quantity, the part of the limb, the axis, the unit. English and German."""

from __future__ import annotations

import functools
import re
import unicodedata
from dataclasses import dataclass

from brace.ground.units import UNITS, Unit, meanings_of, unit_of

_BRACKETS = re.compile(r"[\[({<]([^\])}>]*)[\])}>]")
_LAST_BRACKETS = re.compile(r"[\[({<]([^\])}>]*)[\])}>]\s*$")
_BEHIND = re.compile(r"(?:\s+in\s+|\s*/\s*|,\s*|\s+)([^\s,/]+(?:[ *\u00b7][^\s,/]+)?(?:/[a-z]+)?)\s*$")
_TAIL = re.compile(r"_([A-Za-z\u00b0\u00b5\u03bc]+(?:_mm|_m|_per_mm|_per_m)?)$")

_IN = re.compile(r"\s+in$", re.IGNORECASE)  # Weg in [mm]: no inches

LABVIEW_TIME = "x_value"  # of its .lvm files: neither a place nor along x
_CAMEL = re.compile(r"(?<=[a-zA-Z0-9])([A-Z][a-z]*)$")  # tSec, thetaFemurDeg, forceXN
_CAMEL_UNITS = {"Sec": "s", "Ms": "ms", "Deg": "deg", "Rad": "rad", "Mm": "mm", "N": "N", "Lbf": "lbf", "Inch": "in",
                "Nm": "N m", "Nmm": "N mm"}  # fmt: skip
_NO_TAILS = ("h", "F", "C", "k", "K", "n_")
_PREFIX_MOST = 2  # letters before a unit: k, m, da

# word of a name -> what it means
_WORDS: dict[str, tuple[str, ...]] = {
    "force": ("force", "kraft", "kraefte", "krafte", "f", "load", "last", "loadcell", "cell", "kmd", "fuerza", "forza",
              "forces", "grf", "kraftsensor", "kraftmessdose", "lc", "reaction"),
    "length": ("displacement", "disp", "displ", "deflection", "defl", "weg", "verschiebung", "auslenkung",
            "durchbiegung",
               "stroke", "position", "pos", "lvdt", "deplacement", "spostamento", "extension", "crosshead", "traverse",
               "traversenweg", "travel", "d", "u", "wegaufnehmer", "verformung", "einfederung", "tip", "stage",
                       "slide"),
    "angle": ("theta", "angle", "winkel", "ang", "q", "gelenkwinkel", "angulo", "twist", "flexion", "alpha", "beta",
            "gamma", "phi", "pitch", "verdrehung", "drehwinkel",
              "rotation", "th"),
    "torque": ("torque", "moment", "drehmoment", "tau", "couple", "trq", "tq"),
    "time": ("time", "t", "zeit", "timestamp", "elapsed", "clock", "temps", "uhrzeit", "zeitstempel", "datetime",
            "tiempo",
             "stamp", "messzeit", "laufzeit"),
    "temperature": ("temp", "temperature", "temperatur", "degc", "celsius"),
    "mass": ("mass", "masse", "weight", "weights", "gewicht", "gewichte", "hung", "zuladung", "deadweight"),
    "stiffness": ("stiffness", "steifigkeit", "k", "steife"),
    "run": ("run", "lauf", "trial", "versuch", "cycle", "zyklus", "pass", "durchgang", "messung", "messreihe"),
    "rep": ("rep", "repeat", "repetition", "wiederholung", "wdh", "replicate"),
    "step": ("step", "schritt", "stufe"),
    "count": ("index", "nr", "no", "number", "sample", "point", "punkt", "id", "row", "zeile", "lfd", "num", "scan",
            "i", "n"),
    "config": ("config", "configuration", "pose", "posture", "haltung", "konfiguration", "stellung", "cfg"),
    "axis": ("axis", "achse", "direction", "richtung", "dir"),
    "command": ("command", "commanded", "cmd", "soll", "setpoint", "target", "demand", "reference", "ref", "sollwert",
                "goal"),
    "actual": ("actual", "measured", "present", "ist", "gemessen", "meas", "istwert", "act"),
    "encoder": ("encoder", "enc", "output", "abtrieb", "drehgeber"),
    "base": ("base", "basis", "sockel", "gestell", "frame", "mount"),
    "reach": ("r", "reach", "radius", "abstand", "distance", "reichweite"),
    "eigen": ("lambda", "eig", "eigenvalue", "eigenwert"),
    "min": ("min", "minimum", "smaller", "kleinster"),
    "max": ("max", "maximum", "larger", "groesster", "peak"),
    "mean": ("mean", "average", "avg", "mittel", "mittelwert"),
    "femur": ("femur", "hip", "hueft", "huefte", "hueftgelenk", "thigh", "oberschenkel", "hanche",
              "cadera", "quadril", "upper", "theta1", "q1"),
    "tibia": ("tibia", "knee", "knie", "kniegelenk", "shank", "unterschenkel", "genou", "rodilla", "joelho",
              "ginocchio", "lower", "theta2", "q2"),
    "shank": ("shank", "unterschenkel"),
    "coxa": ("coxa", "yaw", "theta0", "q0"),
    "x": ("x", "horizontal", "horiz", "waagrecht", "waagerecht", "fore", "hor"),
    "y": ("y",),
    "z": ("z", "vertical", "vert", "senkrecht", "vertikal", "ver"),
    "interior": ("interior", "inner", "included", "innenwinkel", "inside"),
    "down": ("down", "downward", "downwards", "unten", "abwaerts", "depth", "sag", "indentation", "absenkung"),
    "joint": ("joint", "gelenk", "motor", "servo", "output", "gear", "getriebe"),
    "noise": ("std", "sigma", "stdev", "error", "setting", "voltage", "spannung", "strom", "velocity", "speed",
              "geschwindigkeit", "status", "valid", "acceleration", "accel", "acc", "beschleunigung", "imu"),
    "current": ("current",),  # electric, or the present reading
    "filtered": ("raw", "filtered", "smoothed", "smooth", "lowpass", "roh", "gefiltert"),
    "stamp": ("stamp",),
    "header": ("header",),
    "date": ("date", "datum", "day"),
    "test": ("test",),
}  # fmt: skip
_MEANING: dict[str, list[str]] = {}
for _meaning, _spellings in _WORDS.items():
    for _spelling in _spellings:
        _MEANING.setdefault(_spelling, []).append(_meaning)
_GLUED = re.compile(r"([fdukxt])([xyz]{1,2})")  # fx, dz, uz, kxx
_NUMBERED = re.compile(r"(theta|th|q|joint|angle|winkel|gelenk|enc|encoder|j|alpha|phi|servo|motor|a)_?([0-9]{1,2})")
_COMPOUND = tuple(sorted((word for word in _MEANING if len(word) >= 4), key=len, reverse=True))


@dataclass(frozen=True)
class Name:
    """A column's name, taken apart."""

    words: frozenset[str]  # meanings
    unit: Unit | None
    number: int | None  # of a joint
    entry: str = ""  # "xx", "xz" of a stiffness
    unit_text: str = ""  # as it stands in the name, understood or not
    meanings: tuple[Unit, ...] = ()  # of a unit that may be one of two


# Words of a name in German, where Grad is the degree.
_GERMAN = re.compile(r"winkel|gelenk|knie|h\u00fcft|hueft|schenkel|drehung|drehgeber|abtrieb|stellung", re.IGNORECASE)


@functools.lru_cache(maxsize=4096)
def read(name: str, units_row: str = "") -> Name:
    """The name's meanings; its unit from the row of units, else from the name. Where two units of one quantity are said,
    both are its unit's meanings."""
    bare, unit, text = _without_unit(name)
    told, told_text = (unit, text) if units_row else (None, "")
    if units_row:
        unit, text = unit_of(units_row), units_row
    elif unit is not None and _BRACKETS.search(name):
        _, told, told_text = _without_unit(_IN.sub("", bare.rstrip(" _")))
    if bare.strip().lower() == LABVIEW_TIME:
        return Name(frozenset({"time"}), unit, None, "", text)
    words, number, entry = _meanings(bare)
    both = meanings_of(text)
    if both and text.lower() == "grad" and _GERMAN.search(bare):
        both = (UNITS["deg"],)
    if "temperature" in words and "angle" not in words and unit is not None and unit.text == "deg":
        unit, both = None, (UNITS["degC"], UNITS["degF"])
    if unit is not None and told is not None and told != unit and told.quantity == unit.quantity:
        text, both, unit = f"{told_text} [{text}]", (told, unit), None  # dx_um [mm]: neither is the better word
    fit = [each for each in both if each.quantity in words] if len(both) > 1 else list(both)
    if len(fit) == 1:
        unit, both = fit[0], ()
    return Name(frozenset(words), unit, number, entry, text, both if unit is None else ())


def _known(text: str, name: str = "") -> bool:
    """Whether the text is a unit, or may be one of two. name: behind which it stands; Fx_min is the least Fx."""
    if text.lower() == "min" and name and not re.search(r"time|zeit|elapsed|\bt\b", name.replace("_", " "), re.IGNORECASE):
        return False
    return unit_of(text) is not None or bool(meanings_of(text))


def _without_unit(name: str) -> tuple[str, Unit | None, str]:
    for found in _BRACKETS.finditer(name):
        if _known(found.group(1)):
            bare = name[: found.start()] + " " + name[found.end() :]
            return bare, unit_of(found.group(1)), found.group(1).strip()
    last = _LAST_BRACKETS.search(name)
    if last and any(c.isalpha() or c in "%\u00b0" for c in last.group(1)):
        return name[: last.start()], None, last.group(1).strip()
    tail = _TAIL.search(name)
    if tail:
        pieces = name.split("_")
        for count in (4, 3, 2, 1):
            if len(pieces) > count and (count == 1 or pieces[-count].lower() != "in"):
                text = "_".join(pieces[-count:])
                spoken = text.replace("_per_", "/").replace("_", " ")
                if _known(spoken, name) and not (count == 1 and text in _NO_TAILS):
                    return "_".join(pieces[:-count]), unit_of(spoken), text
    if behind := _BEHIND.search(name):
        text = behind.group(1)
        if _known(text, name) and name[: behind.start()].strip():
            return name[: behind.start()], unit_of(text), text
        end = text.split()[-1]
        if (unit := unit_of(end)) and _known(end, name) and name[: name.rfind(end)].strip():
            return name[: name.rfind(end)], unit, end
    camel = _CAMEL.search(name)
    if camel and camel.group(1) in _CAMEL_UNITS:
        place = camel.start()
        longer = [at for at in range(max(place - _PREFIX_MOST, 0), place) if unit_of(name[at:])]
        if longer or name[place - 1] == "M":
            return name[: longer[0] if longer else place - 1], None, ""  # ForceKN: newtons, or kilonewtons?
        return name[:place], unit_of(_CAMEL_UNITS[camel.group(1)]), camel.group(1)
    return name, None, ""


def _plain(text: str) -> str:
    for letter, pair in (
        ("\u00e4", "ae"),
        ("\u00f6", "oe"),
        ("\u00fc", "ue"),
        ("\u00df", "ss"),
        ("\u00c4", "Ae"),
        ("\u00d6", "Oe"),
        ("\u00dc", "Ue"),
        ("\u03b8", "theta"),
        ("\u03b1", "alpha"),
        ("\u03bb", "lambda"),
        ("\u03c4", "tau"),
        ("\u0394", "d"),
        ("\u03d5", "phi"),
        ("\u2081", "1"),
        ("\u2082", "2"),
    ):
        text = text.replace(letter, pair)  # fmt: skip
    return unicodedata.normalize("NFKD", text).encode("ascii", "ignore").decode()


def _meanings(name: str) -> tuple[set[str], int | None, str]:
    plain = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", _plain(name)).lower()
    found: set[str] = set()
    number: int | None = None
    entry = ""
    for token in re.findall(r"[a-z]+[0-9]*|[0-9]+", plain.replace("_", " ")):
        if glued := _GLUED.fullmatch(token):
            letter, axes = glued.groups()
            if letter == "k":
                found.add("stiffness")
                entry = axes
            elif letter != "t" or token != "tx":
                found |= {"force" if letter == "f" else "torque" if letter == "t" else "length", *axes}
            continue
        if numbered := _NUMBERED.fullmatch(token):
            stem, number = numbered.group(1), int(numbered.group(2))
            found |= (
                {"encoder"}
                if stem in ("enc", "encoder")
                else {"angle"}
                if stem not in ("joint", "gelenk", "j", "servo", "motor")
                else {"joint"}
            )
            continue
        if token.isdigit():
            if found & {"joint", "angle", "encoder"}:
                number = int(token) if len(token) <= 2 else number
            continue
        known = token if token in _MEANING else token.rstrip("0123456789")  # F1
        if known in _MEANING:
            found |= set(_MEANING[known])
            continue
        rest = token
        for word in _COMPOUND:  # Kniewinkel, Kraftmessung
            if word in rest:
                found |= set(_MEANING[word])
                rest = rest.replace(word, " ", 1)
        if rest[-1:] in "xyz" and found & {"force", "length", "stiffness"} and len(rest.strip()) == 1:
            found.add(rest.strip())
    return found, number, entry

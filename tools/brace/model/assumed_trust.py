"""How far the numbers of a limb.toml are trusted that does not say it in [uncertainty].

Nothing said is not exact. A calibration of 5 % is not assumed either: where compliances are guesses and that is
believed of them, a record's whole stiffness is put down to the force sensor's gain, and K becomes worse. What is
assumed is what `brace new` writes for a joint that nobody has measured. So much trust hides a compliance of up to twice
the believed one from being named. The record refits it all the same, so that K is right."""

from __future__ import annotations

from collections.abc import Mapping

from brace.model.limb import LimbModel

GUESSED_REL = 0.5  # one sigma of a compliance that is a guess
ASSUMED: Mapping[str, float] = {
    "uncertainty.length_mm": 0.5,
    "uncertainty.angle_rad": 0.01,
    "uncertainty.compliance_rel": GUESSED_REL,
    "uncertainty.gain_rel": 0.005,
}
_OF = {
    "uncertainty.length_mm": "lengths",
    "uncertainty.angle_rad": "the joints' zeros",
    "uncertainty.compliance_rel": "compliances",
    "uncertainty.gain_rel": "the force sensor's gain",
}


def with_assumed_trust(believed: LimbModel, *, even_if_exact: bool = False) -> LimbModel:
    """The limb with ASSUMED where its file is silent; `even_if_exact`: where it says 0, too."""
    return believed.with_values(
        {
            key: value
            for key, value in ASSUMED.items()
            if key not in believed.given or (even_if_exact and believed.number(key) == 0.0)
        }
    )


def assumption(believed: LimbModel, keys: tuple[str, ...] = tuple(ASSUMED)) -> str:
    """One sentence on what is assumed of these keys, and what to write instead; empty where limb.toml says them all."""
    silent = [key for key in keys if key not in believed.given]
    if not silent:
        return ""
    *most, last = [f"{_OF[key]} ({_size(key)})" for key in silent]
    lines = ", ".join(f"{key.rpartition('.')[2]} = {ASSUMED[key]:g}" for key in silent)
    return (
        f"limb.toml does not say how far it is trusted, so one sigma is assumed of {', '.join(most)}"
        f"{' and ' if most else ''}{last}: write what you know under [uncertainty], {lines} (0: exact), as brace new "
        "does."
    )


def _size(key: str) -> str:
    value, unit = ASSUMED[key], key.rpartition("_")[2]
    return f"{100.0 * value:g} %" if unit == "rel" else f"{value:g} {unit}"

"""The catalogue of effects, and docs/effects.md that is made from it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from brace.effects import BY_NAME
from brace.effects.catalogue import EFFECTS
from brace.effects.page import page
from brace.effects.row import Effect
from brace.model.keys import KEY_BY_NAME

PROJECT = Path(__file__).resolve().parents[3]


def test_the_page_is_the_catalogue() -> None:
    written = (PROJECT / "docs" / "effects.md").read_text()
    assert written == page(), "run: PYTHONPATH=tools .venv/bin/python -m brace.effects > docs/effects.md"


def test_every_law_has_its_header_and_every_header_its_row() -> None:
    """A length error has no header: the plant's kinematics is its law."""
    headers = {path.stem for path in (PROJECT / "host_sim" / "effects").glob("*.h")} - {"effect", "limb_now", "memory"}
    assert headers == {effect.name for effect in EFFECTS} - {"link_length_error"}


def test_a_trusted_number_names_a_key_of_uncertainty() -> None:
    trusts = {number.trust for effect in EFFECTS for number in effect.numbers if number.trust}
    assert trusts == {key for key in KEY_BY_NAME if key.startswith("uncertainty.")}


def test_a_row_without_its_key_in_the_dictionary_is_refused() -> None:
    row = BY_NAME["backlash"]
    with pytest.raises(ValueError, match="joint.femur.slack_rad.*dictionary.toml"):
        replace(row, numbers=(replace(row.numbers[0], leaf="slack_rad"),)).check()


def test_what_changes_with_time_or_temperature_follows_time() -> None:
    """The list `Changes` is what time or temperature changes in the simulated limb: the row of each says so."""
    text = (PROJECT / "host_sim" / "effects" / "limb_now.h").read_text()
    listed = text.partition("using Changes = ChangesBy<")[2].partition(">;")[0]
    names = re.findall(r"(\w+)::Change", listed)
    assert names and set(names) <= {effect.name for effect in EFFECTS}
    forgotten = [name for name in names if not BY_NAME[name].follows_time]
    assert not forgotten, f"follows_time = True is missing in the rows of {forgotten} in effects/catalogue.py"
    thermal = [effect for effect in EFFECTS if "thermal" in effect.places]
    unseen = [effect.name for effect in thermal if effect.loading_seen is Effect.loading_seen]
    assert not unseen, f"loading_seen is missing in the rows of {unseen}: a record at one temperature cannot show them"

"""report.html: whole in itself, in words first, escaped, light; drawn for every verdict and kind of
record."""

from __future__ import annotations

import re
import shutil
import subprocess
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from handmade import FAULT, by_hand, loading_record

from brace.dataset import Dataset
from brace.diagnose.diagnosis import (
    Candidate,
    Diagnosis,
    Gap,
    GapPair,
    Interval,
    NamedEffect,
    Residuals,
    StiffnessAt,
)
from brace.diagnose.digits import with_sigma
from brace.diagnose.plain_words import interval
from brace.diagnose.report.facts import Facts, facts
from brace.diagnose.report.page import page
from brace.diagnose.report.what_k_becomes import k_sigma, what_k_becomes
from brace.diagnose.stiffness_change import stiffness_change
from brace.diagnose.provenance import Provenance, provenance
from brace.diagnose.write import contents
from brace.model import LimbModel, load_limb

VOID = {"meta", "br", "link", "img", "hr", "path", "use", "rect", "input", "wbr"}
BROWSER = shutil.which("chromium") or shutil.which("google-chrome")


@pytest.fixture(scope="module")
def limb() -> Path:
    return Path(__file__).resolve().parents[3] / "tools" / "brace" / "data" / "paper-limb.toml"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory, limb: Path) -> tuple[Dataset, LimbModel, Diagnosis]:
    return by_hand(loading_record(tmp_path_factory.mktemp("record") / "data", limb, 'a <script> & "b"'), limb)


class Reader(HTMLParser):
    """Tags in balance, ids, and everything that would be fetched from elsewhere."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: set[str] = set()
        self.ids: list[str] = []
        self.fetched: list[str] = []
        self.words = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        if tag not in VOID:
            self.open.append(tag)
        for name, value in attrs:
            if name == "id" and value:
                self.ids.append(value)
            if name in ("src", "href", "xlink:href") and value and not value.startswith("#"):
                self.fetched.append(value)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open and self.open[-1] == tag, (tag, self.open[-4:])
            self.open.pop()

    def handle_data(self, data: str) -> None:
        self.words += data


def _read(text: str) -> Reader:
    reader = Reader()
    reader.feed(text)
    assert not reader.open
    return reader


def _origin(dataset: Dataset) -> Provenance:
    return provenance(dataset, "")


def test_one_file_in_balance_without_scripts_or_anything_from_elsewhere(
    made: tuple[Dataset, LimbModel, Diagnosis], limb: Path
) -> None:
    dataset, believed, found = made
    text = contents(dataset, believed, limb.read_text(), found).files["report.html"].decode()
    reader = _read(text)
    assert not reader.fetched and "script" not in reader.tags and "@import" not in text
    assert "url(http" not in text and len(reader.ids) == len(set(reader.ids))
    for used in re.findall(r'url\(#([^)]+)\)|href="#([^"]+)"', text):
        assert (used[0] or used[1]) in reader.ids
    assert len(text) < 1_000_000
    assert 'a <script> & "b"' in reader.words  # the title, as text


@pytest.mark.skipif(BROWSER is None, reason="no chromium here")
@pytest.mark.parametrize("width_px", [400, 800, 1000, 1200])
def test_no_table_is_wider_than_the_page(
    made: tuple[Dataset, LimbModel, Diagnosis], tmp_path: Path, width_px: int
) -> None:
    """With the longest key that there is, and its unit."""
    dataset, believed, found = made
    key = "joint.femur.hardening_n_mm_per_rad3"
    held = next(iter(found.effects[0].parameters.values()))
    large = replace(held, value=1.49e8, low=1.44e8, high=1.53e8)
    effect = replace(found.effects[0], name="joint_hardening", where="joint.femur", parameters={key: large})
    widths = "[...document.querySelectorAll('.wide')].map(e=>e.scrollWidth-e.clientWidth).join(' ')"
    text = page(dataset, believed, replace(found, effects=(effect,)), _origin(dataset))
    (tmp_path / "report.html").write_text(text.replace("</body>", f"<script>document.title={widths}</script></body>"))
    command = [str(BROWSER), "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/profile",
               f"--window-size={width_px},2000", "--dump-dom", f"file://{tmp_path}/report.html"]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    title = re.search(r"<title>([-\d ]+)</title>", done.stdout)
    if title is None:
        pytest.skip(f"the browser does not start here: {done.stderr.strip()[-200:]}")
    assert len(title.group(1).split()) >= 3 and max(map(int, title.group(1).split())) <= 0, title.group(1)


def test_what_it_says_in_order(made: tuple[Dataset, LimbModel, Diagnosis], limb: Path) -> None:
    dataset, believed, found = made
    found = replace(found, data_faults=(FAULT,), indistinguishable=(("a@b", "backlash@joint.tibia"),))
    words = _read(page(dataset, believed, found, _origin(dataset))).words
    order = [
        found.sentence,
        "97 %",
        "Where they disagreed",
        "only when unloading, and only near zero force",
        "What was missing",
        "joint.tibia.gap_rad",
        "0.0057 to 0.0065",
        "The misfit before and after",
        "held out, before",
        "held out, after",
        "What stays unexplained",
        "What looks alike",
        "What to measure next",
        "preloaded",
        "Faults of the record",
        "three times its neighbours <b>",
        "What was tried",
        "data sha256",
        "core",
    ]
    at = 0
    for piece in order:
        assert piece in words[at:], piece
        at = words.index(piece, at)


def test_the_pictures_show_the_gap_shrink_by_the_numbers_given(
    made: tuple[Dataset, LimbModel, Diagnosis], limb: Path
) -> None:
    """The rms printed over each panel is the diagnosis' own, and the residuals drawn have it."""
    dataset, believed, found = made
    words = _read(page(dataset, believed, found, _origin(dataset))).words
    assert found.gap is not None and found.residuals is not None
    for pair, part in ((found.gap.before, found.residuals.before), (found.gap.after, found.residuals.after)):
        held = float(np.sqrt(np.mean(part[found.residuals.held_out] ** 2)))
        assert pair.held_out == pytest.approx(held)
        assert f"{pair.fitted:.3g} N" in words and f"{pair.held_out:.3g} N" in words


@pytest.mark.parametrize("verdict", ["none", "unknown", "ambiguous", "effect", "data_fault"])
def test_every_verdict_with_and_without_its_parts(
    verdict: Any, made: tuple[Dataset, LimbModel, Diagnosis], limb: Path
) -> None:
    dataset, believed, found = made
    bare = Diagnosis(verdict, "A sentence.", believed)
    for diagnosis in (bare, replace(found, verdict=verdict), replace(found, verdict=verdict, residuals=None)):
        assert (
            "A sentence." in (text := page(dataset, believed, diagnosis, _origin(dataset)))
            or diagnosis is not bare
        )
        _read(text)


def test_each_row_of_a_table_has_a_cell_below_each_head(
    made: tuple[Dataset, LimbModel, Diagnosis], limb: Path
) -> None:
    dataset, believed, found = made
    text = page(dataset, believed, found, _origin(dataset))
    tables = re.findall(r"<table>\n(.*?)</table>", text, re.DOTALL)
    assert len(tables) > 2 and any("held out (rms)" in table for table in tables)
    for table in tables:
        assert len({len(re.findall("<t[hd][ >]", row)) for row in table.strip().split("\n")}) == 1, table


def test_odd_residuals_are_left_out_not_drawn_wrong(
    made: tuple[Dataset, LimbModel, Diagnosis], limb: Path
) -> None:
    """Other counts than the record's rows, without saying which rows they are of."""
    dataset, believed, found = made
    assert found.residuals is not None
    cut = Residuals(
        ("fx_n", "fz_n"), found.residuals.before[:5], found.residuals.after[:5], np.zeros(5, bool)
    )
    assert "held out, before" not in page(dataset, believed, replace(found, residuals=cut), _origin(dataset))
    told = replace(found, residuals=cut, details={"rows": np.arange(5)})
    assert "all, before" in page(dataset, believed, told, _origin(dataset)) or "fitted, before" in page(
        dataset, believed, told, _origin(dataset)
    )


def test_nothing_held_out_is_said(made: tuple[Dataset, LimbModel, Diagnosis], limb: Path) -> None:
    dataset, believed, found = made
    gap = Gap("n", 0.1, GapPair(0.5, None), GapPair(0.1, None))
    text = page(dataset, believed, replace(found, gap=gap), _origin(dataset))
    assert "Nothing could be held out" in text


def test_large_records_stay_light(limb: Path, tmp_path: Path) -> None:
    """60,000 rows of a joint test: the page thins what it draws."""
    count = 60_000
    folder = tmp_path / "joint"
    folder.mkdir()
    (folder / "meta.toml").write_text('format = 1\nkind = "joint_test"\ntitle = "long"\n')
    t = np.arange(count) * 0.01
    angle = 0.02 * np.sin(t / 3)
    rows = "\n".join(f"{a:.3f},{b:.6f},{c:.3f}" for a, b, c in zip(t, angle, 1e5 * angle, strict=True))
    (folder / "data.csv").write_text("t_s,angle_rad,torque_n_mm\n" + rows + "\n")
    from brace.dataset import load_dataset

    dataset = load_dataset(folder)
    before = (0.1 * dataset["torque_n_mm"])[:, None]
    found = Diagnosis(
        "effect",
        "A sentence.",
        load_limb(limb),
        Gap("n_mm", 10.0, GapPair(100.0, 100.0), GapPair(10.0, 10.0)),
        residuals=Residuals(("torque_n_mm",), before, 0.1 * before, np.arange(count) > 40_000),
    )
    text = page(dataset, None, found, _origin(dataset))
    _read(text)
    assert len(text) < 700_000


def test_what_is_far_less_likely_is_not_possible(made: tuple[Dataset, LimbModel, Diagnosis], limb: Path) -> None:
    """Fifty times less likely may be, and says so on the first screen; a thousand times less likely may not."""
    dataset, believed, found = made
    tried = [Candidate("backlash@joint.tibia", 412.0, 0.95), Candidate("contact_play@contact", 390.0, 0.019)]
    far = Candidate("joint_hardening@joint.tibia", 120.0, 0.95e-6)
    found = replace(
        found, candidates=(*tried, far), could_be=tuple(one.label for one in (tried[1], far)),
        indistinguishable=(("backlash@joint.tibia", far.label),),
    )
    said = facts(dataset, believed, found, _origin(dataset))
    assert "contact" in said.could_be and "50 times less likely" in said.could_be and "harden" not in said.could_be
    assert "50 times less likely" in said.answers[1].more
    assert "10^6 times less likely" in said.classes[0][1][0]


def test_a_switch_is_said_as_limb_toml_has_it(made: tuple[Dataset, LimbModel, Diagnosis], limb: Path) -> None:
    dataset, believed, found = made
    switch = NamedEffect(
        "moment_transfer", "link.femur", 0.98, {"link.femur.moment_transfer": Interval(1.0, 0.951, 1.0)}, 1.0
    )
    (line,) = facts(dataset, believed, replace(found, effects=(switch,)), _origin(dataset)).parameters
    assert (line.believed, line.found) == ("false", "true")


def test_k_has_its_uncertainty_where_limb_toml_has_one(limb: Path) -> None:
    model = load_limb(limb)
    at = StiffnessAt(0.74, 1.0, 1.0, 0.0, 1.0)
    sure = model.with_values({key: 0.0 for key in model.values if key.startswith("uncertainty.")})
    unsure = sure.with_values({"uncertainty.compliance_rel": 0.05})
    assert k_sigma(sure, at) == () and all(sigma > 0.0 for sigma in k_sigma(unsure, at))


def test_k_of_the_first_screen_is_paired_entry_by_entry(
    made: tuple[Dataset, LimbModel, Diagnosis],
) -> None:
    """Old and new of an entry stand in one line, both to the place of the uncertainty's second digit."""
    dataset, believed, found = made
    model = found.model.with_values({"joint.tibia.compliance_rad_per_n_mm": 2.4e-5})
    found = replace(found, model=model, stiffness=stiffness_change(dataset, believed, model))
    question, short, more = what_k_becomes(believed, found)
    lines = short.split("\n")
    assert question.endswith("[N/mm]") and [line.split()[0] for line in lines] == ["xx", "xz", "zz"]
    for line in lines:
        was, now, sigma = re.fullmatch(r"x?[xz]z? (\S+) → (\S+) ± (\S+)", line).groups()  # type: ignore[union-attr]
        assert len({part.partition(".")[2].__len__() for part in (was, now, sigma)}) == 1, line
    assert "GAP_OPEN" in more and "not valid" not in more  # K of an open gap is a lower bound (docs/errors.md)
    assert "\n" in page(dataset, believed, found, _origin(dataset)).partition("What K becomes")[2].partition("</b>")[0]


def test_what_the_named_effect_does_not_do_to_k_is_not_laid_on_it(
    made: tuple[Dataset, LimbModel, Diagnosis],
) -> None:
    """Backlash leaves K as it is once it is taken up; a softer knee does not; of both, the share of each is said."""
    dataset, believed, found = made
    knee = "joint.tibia.compliance_rad_per_n_mm"
    softer = NamedEffect("joint_compliance", "joint.tibia", 0.97, {knee: Interval(2.4e-5, 2.3e-5, 2.5e-5)}, 0.9)

    def words_of(effects: tuple[NamedEffect, ...], **values: float) -> str:
        model = found.model.with_values(values)
        change = stiffness_change(dataset, believed, model)
        return what_k_becomes(believed, replace(found, effects=effects, model=model, stiffness=change))[2]

    assert "The cause is not backlash (knee joint), but" in words_of(found.effects, **{knee: 2.4e-5})
    assert "refits" not in words_of((softer,), **{knee: 2.4e-5})
    both = words_of((softer,), **{knee: 2.4e-5, "link.tibia.bending_mm_per_n": 0.35})
    assert "Alone, " in both and "the rest comes from" in both
    assert "The cause is limb.toml" in words_of((), **{knee: 2.4e-5})


def answers(said: Facts) -> dict[str, str]:
    """What each tile of the first screen says, by its question."""
    return {one.question: f"{one.short}. {one.more}" for one in said.answers}


def test_a_record_without_an_effect_says_what_was_compared_and_which_file_to_use(
    made: tuple[Dataset, LimbModel, Diagnosis],
) -> None:
    """No number of the first screen is of a model that the same screen says was not made."""
    dataset, believed, found = made
    gap = Gap("n", 0.1, GapPair(0.2, 0.15), GapPair(0.1, 0.105))
    model = believed.with_values({"link.tibia.bending_mm_per_n": 0.24})
    none = replace(found, verdict="none", effects=(), gap=gap, model=model, details={"refit_pull_sigma": 1.0})
    said = facts(dataset, believed, none, _origin(dataset))
    sure, next_ = answers(said)["How sure"], answers(said)["What to do next"]
    assert "1.5 times the noise as believed, and by 1.05 times the noise with its numbers refitted" in sure
    assert "Go on with limb.toml" in next_ and "params push limb.toml" in next_
    assert "configurations that took no part in the fit: 0.15 N" in said.misfit
    assert "0.105 N with its numbers refitted" in said.misfit
    assert "Where they disagreed" not in page(dataset, believed, none, _origin(dataset))
    unknown = facts(dataset, believed, replace(none, verdict="unknown", model=believed), _origin(dataset))
    assert "which limb.toml does not have" in unknown.misfit and "as found" not in unknown.misfit
    same = facts(dataset, believed, replace(none, model=believed), _origin(dataset))
    next_ = answers(same)["What to do next"]
    assert "Go on with your model" in next_ and "push" not in next_


def test_two_equal_k_are_no_change(made: tuple[Dataset, LimbModel, Diagnosis]) -> None:
    dataset, believed, found = made
    faulty = replace(
        found, verdict="data_fault", effects=(), data_faults=(FAULT,), model=believed, gap=None,
        stiffness=stiffness_change(dataset, believed, believed),
    )  # fmt: skip
    said = facts(dataset, believed, faulty, _origin(dataset))
    assert said.k_lines == () and "What was refitted" not in page(dataset, believed, faulty, _origin(dataset))
    assert "No probability" in answers(said)["How sure"]


def test_a_sensor_may_be_the_rigs(made: tuple[Dataset, LimbModel, Diagnosis]) -> None:
    """A drift is said by the hour, too; and whoever uploads its [sensor] is asked whose sensor it is."""
    dataset, believed, found = made
    key = "sensor.drift_x_n_per_s"
    drift = NamedEffect("sensor_drift", "sensor", 0.98, {key: Interval(2.42e-5, 2.04e-5, 2.79e-5)}, 0.9)
    said = facts(dataset, believed, replace(found, effects=(drift,)), _origin(dataset))
    assert "0.0871 N in an hour" in answers(said)["What is missing"] and "90 %: " in answers(said)["What is missing"]
    assert "leave it out if that is the rig" in answers(said)["What to do next"]
    assert "leave it out" not in answers(facts(dataset, believed, found, _origin(dataset)))["What to do next"]


def test_of_several_explanations_limb_toml_has_one(made: tuple[Dataset, LimbModel, Diagnosis]) -> None:
    """It is not said to have all that may be missing; and no line ends within a number."""
    dataset, believed, found = made
    held = {"base.rotation_rad_per_n_mm": Interval(2.63e-5, 2.52e-5, 2.74e-5)}
    other = NamedEffect("base_compliance", "base", 0.33, held, 0.9)
    several = replace(found, verdict="ambiguous", effects=(*found.effects, other))
    said = answers(facts(dataset, believed, several, _origin(dataset)))
    assert "with one of them added" in said["What to do next"] and "what was missing" not in said["What to do next"]
    assert '<span class="whole">2.74e-5</span>' in page(dataset, believed, several, _origin(dataset))
    assert '<span class="whole">90 %</span>' in page(dataset, believed, several, _origin(dataset))


def test_both_ends_of_an_interval_have_one_notation() -> None:
    assert interval(Interval(0.00106, 9.84e-4, 0.00114)) == "0.000984 to 0.00114"
    assert interval(Interval(2.4e-5, 2.04e-5, 2.79e-5)) == "2.04e-5 to 2.79e-5"


@pytest.mark.parametrize(
    ("value", "sigma", "words"),
    [(20.984, 0.62, "20.98 ± 0.62"), (10.919, 0.4, "10.92 ± 0.40"), (0.0123, 0.12, "0.01 ± 0.12"),
     (3.4, 0.0996, "3.40 ± 0.10"), (1234.5, 57.0, "1234 ± 57")],
)  # fmt: skip
def test_a_value_has_the_digits_of_its_uncertainty(value: float, sigma: float, words: str) -> None:
    assert with_sigma(value, sigma) == words

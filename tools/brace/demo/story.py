"""The demo in order: the table's faults, the limb behind it, and the paper's figures; each step says what it found."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from brace.dataset.write import csv_text
from brace.demo import contact, cyclic, four_limbs, paper_table, postures, soft_knee, weight, wire_loop
from brace.demo.band import band
from brace.identify import report
from brace.model import LimbModel, load_limb
from brace.plots.contact_plot import Footing, contact_figure
from brace.plots.cyclic_plot import cyclic_figure
from brace.plots.eigenvalue_plot import eigenvalue_figure
from brace.plots.figure import png_bytes
from brace.plots.limb_plot import ellipse_figure
from brace.stance.picture import picture
from brace.stiffness.at_rest import planar_limb
from brace.stiffness.workspace import compute

Advance = Callable[[int], None]


@dataclass
class Story:
    """What to write (name -> content) and the numbers behind it."""

    files: dict[str, bytes] = field(default_factory=dict)
    facts: dict[str, object] = field(default_factory=dict)


def narrate(story: Story, advance: Advance) -> Iterator[str]:
    """Runs the demo; yields what a person is to read, step by step."""
    table = paper_table.examine(advance)
    yield "1. The paper's Table I, as printed: what is wrong with it"
    yield from (f"   {fault}" for fault in table.faults)
    yield "2. The limb behind the table, the misprint corrected"
    text = report.as_text(table.identification).splitlines()
    yield from ("   " + line for line in text)
    story.files["limb.toml"] = table.limb.to_toml(report.header(table.identification)).encode()
    story.facts |= {"faults": table.faults, "repairs": table.repairs,
                    "identification": report.as_json(table.identification)}
    yield "3. Eigenvalues over the reach (the paper's Fig. 10 and 13) -> eigenvalues.png, table.csv"
    yield from _eigenvalues(story, table)
    yield "4. Compliance ellipses as the limb reaches out (Fig. 9) -> ellipses.png"
    limb = planar_limb(table.limb)
    reach = postures.reach(table.limb, table.tip_height_mm, 9)
    drawn = [postures.posed_limb(table.limb, limb, float(r), table.tip_height_mm) for r in reach[[1, 4, 7]]]
    story.files["ellipses.png"] = png_bytes(ellipse_figure(drawn))
    yield "5. The cyclic test (Fig. 12) on a simulated limb with 20 arcmin of play in both joints -> cyclic.png"
    yield from _cyclic(story, load_limb(paper_table.DATA / "paper-limb.toml"))
    yield "6. Choice of stiffness for a foot on a ledge (Fig. 2) -> contact.png"
    yield from _contact(story, table.limb, table.tip_height_mm)
    yield "7. A weight hangs on the limb: K that the controller reports, the limb's own, and K without the load [N/mm]"
    yield from _weight(story, load_limb(paper_table.DATA / "paper-limb.toml"))
    yield "8. The loop over the wire: a controller whose model lacks something, tested, diagnosed, mended -> wire/"
    yield from _wire(story)
    yield "9. A robot on four limbs: the foot that will slip is named before it does -> robot.png, robot.csv"
    yield from _robot(story)
    yield "10. One knee of the robot goes soft: its limb is named by the forces, tested, diagnosed, mended -> soft/"
    yield from _soft_knee(story)


def _eigenvalues(story: Story, table: paper_table.PaperTable) -> Iterator[str]:
    reach = postures.reach(table.limb, table.tip_height_mm, 240)
    model = postures.curve(table.limb, table.tip_height_mm, reach)
    known = band(table.identification.information, reach[4:-2:4])
    at_rows = np.array([_at(model.r_mm, curve, table.r_mm) for curve in (model.smallest, model.largest)])
    figure = eigenvalue_figure(table.r_mm, table.largest, table.smallest, table.corrected, model.r_mm, model.largest,
                               model.smallest, known.r_mm, known.largest, known.smallest,
                               coupling_low_ratio=paper_table.coupling_low_ratio(table.k, at_rows[0]))
    story.files["eigenvalues.png"] = png_bytes(figure)
    story.files["table.csv"] = csv_text({
        "row": np.arange(1, table.r_mm.size + 1), "r_mm": table.r_mm,
        "lambda_min_n_per_mm": table.smallest.value, "lambda_min_low_n_per_mm": table.smallest.low,
        "lambda_min_high_n_per_mm": table.smallest.high,
        "lambda_min_determined": table.smallest.determined.astype(int),
        "lambda_min_model_n_per_mm": at_rows[0],
        "lambda_max_n_per_mm": table.largest.value, "lambda_max_low_n_per_mm": table.largest.low,
        "lambda_max_high_n_per_mm": table.largest.high, "lambda_max_model_n_per_mm": at_rows[1],
        "not_strictly_convex": table.largest.bent.astype(int), "corrected": table.corrected.astype(int),
    }, dict.fromkeys(("r_mm",), 0)).encode()
    bent = table.r_mm[table.largest.bent]
    breaks = table.r_mm[table.largest.breaks]
    lowest = table.r_mm[int(np.argmin(table.largest.value))]
    story.facts |= {"not_strictly_convex_r_mm": bent, "quasi_convex_breaks_r_mm": breaks}
    yield (f"   lambda_max falls to r = {lowest:.0f} mm and then rises; not strictly convex at r = "
           + ", ".join(f"{r:.0f}" for r in bent) + " mm")
    yield ("   quasi-convexity holds within print rounding everywhere" if not breaks.size else
           "   quasi-convexity does not hold, beyond print rounding, arriving at r = "
           + ", ".join(f"{r:.0f}" for r in breaks) + " mm")
    turns = int(np.sum(np.diff(np.sign(np.diff(model.largest))) != 0))
    inside = (table.smallest.high >= at_rows[0]) & (table.smallest.low <= at_rows[0])
    yield (f"   lambda_min of the identified limb agrees with the table within print rounding in {int(inside.sum())} "
           f"of {inside.size} rows; the measurement's own scatter is larger than its print")
    yield f"   the identified limb's lambda_max turns {turns} time{'s' if turns != 1 else ''}: " + (
        "quasi-convex" if turns <= 1 else "not quasi-convex")


def _at(r_mm: np.ndarray, curve: np.ndarray, rows_mm: np.ndarray) -> np.ndarray:
    at_rows: np.ndarray = np.interp(rows_mm, r_mm, curve, left=np.nan, right=np.nan)
    return at_rows


def _cyclic(story: Story, model: LimbModel) -> Iterator[str]:
    test = cyclic.cyclic_test(model)
    story.files["cyclic.png"] = png_bytes(cyclic_figure(
        test.displacement_mm, test.force_n, test.without_play_n, test.shift_mm, test.crossings_mm,
        "Cyclic test at theta1 = 70 deg, theta2 = 50 deg"))
    story.facts["zero_force_shift_mm"] = test.shift_mm
    yield (f"   zero force moves by {test.shift_mm:.2f} mm (gap times lever, both joints: {test.expected_mm:.2f} mm); "
           "the paper saw 2.5 mm")


def _contact(story: Story, model: LimbModel, height_mm: float) -> Iterator[str]:
    limb = planar_limb(model)
    firm, loose = contact.firmest_and_loosest(limb, postures.reach(model, height_mm, 24)[1:-1], height_mm)
    footings = [Footing(f"foot at r = {stand.r_mm:.0f} mm", postures.points_mm(model, *stand.theta_rad), stand.force_n,
                        stand.margin_n, stand.holds) for stand in (firm, loose)]
    grid = compute(model, 8000, (-np.pi / 2, np.pi / 2), (0.15, np.pi - 0.35))
    needed = np.abs(grid.values["k_xz_n_per_mm"]) / grid.values["k_zz_n_per_mm"]
    femur, tibia = model.number("geometry.femur_mm"), model.number("geometry.tibia_mm")
    theta1, theta2 = grid.theta1_rad[None, :].astype(float), grid.theta2_rad[:, None].astype(float)
    x_mm = femur * np.cos(theta1) + tibia * np.cos(theta1 - theta2)
    z_mm = femur * np.sin(theta1) + tibia * np.sin(theta1 - theta2)
    story.files["contact.png"] = png_bytes(contact_figure(footings, contact.FRICTION_RATIO, contact.SAG_MM, x_mm, z_mm,
                                                          needed))
    story.facts["footings"] = [{"r_mm": stand.r_mm, "force_n": stand.force_n, "margin_n": stand.margin_n}
                               for stand in (firm, loose)]
    for stand in (firm, loose):
        yield (f"   foot at r = {stand.r_mm:.0f} mm: the ledge pushes with ({stand.force_n[0]:+.2f}, "
               f"{stand.force_n[1]:+.2f}) N; {'holds' if stand.holds else 'slides'}, margin {stand.margin_n:+.2f} N")


def _weight(story: Story, model: LimbModel) -> Iterator[str]:
    hung = [weight.hang(model, weight_n) for weight_n in weight.WEIGHTS_N]
    story.facts["weights"] = [
        {"weight_n": each.weight_n, "carried_n": each.carried_n, "sag_mm": each.sag_mm,
         "told_n_per_mm": each.reported, "truth_n_per_mm": each.truth,
         "unloaded_n_per_mm": each.unloaded, "told_off": each.off(each.reported),
         "unloaded_off": each.off(each.unloaded)}
        for each in hung
    ]
    theta1, theta2 = weight.POSTURE_RAD
    posture = f"(theta1 = {theta1:g}, theta2 = {theta2:g} rad)"
    yield f"   tip bears   it sags by                    k_xx     k_xz     k_zz    off by   {posture}"
    for each in hung:
        head = f"   {each.carried_n:6.1f} N   {each.sag_mm:6.1f} mm"
        for words, k in (("reported", each.reported), ("the limb's own", each.truth), ("without load", each.unloaded)):
            off = "" if k is each.truth else f"   {each.off(k):7.3%}"
            yield f"{head:23}  {words:15}" + "".join(f" {entry:8.3f}" for entry in k) + off
            head = ""
    yield "   The motors give way too, so the posture, and with it K without load, is another one in each row."


def _wire(story: Story) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as name:
        turn = yield from wire_loop.play(Path(name))
        _keep(story, "wire", Path(name))
    theta1, theta2 = turn.posture
    yield f"   K at theta1 = {theta1:g}, theta2 = {theta2:g} rad [N/mm]:   k_xx     k_xz     k_zz    off by"
    for words, k in (("the limb's own", turn.truth), ("reported before", turn.before), ("reported after", turn.after)):
        yield f"     {words:34}" + "".join(f"{entry:9.3f}" for entry in k) + f"{100 * turn.off(k):8.1f} %"
    story.facts["wire"] = {"verdict": turn.diagnosis["verdict"], "effects": turn.diagnosis["effects"],
                           "k_before_n_per_mm": turn.before, "k_after_n_per_mm": turn.after,
                           "k_true_n_per_mm": turn.truth, "off_before_ratio": turn.off(turn.before),
                           "off_after_ratio": turn.off(turn.after)}


def _soft_knee(story: Story) -> Iterator[str]:
    with tempfile.TemporaryDirectory() as name:
        mended = yield from soft_knee.play(four_limbs.Scene(), Path(name))
        _keep(story, "soft", Path(name))
        diagnosis = json.loads((Path(name) / "diagnosis" / "diagnosis.json").read_text())
    named = None
    if mended.named is not None:
        limb, soft, at_s = mended.named
        named = {"limb": limb, "joint": soft.joint, "stiffness_ratio": soft.ratio, "low": soft.low, "high": soft.high,
                 "at_s": at_s}  # fmt: skip
    story.facts["soft_knee"] = {
        "true": {"limb": four_limbs.NAMES[soft_knee.LIMB], "joint": soft_knee.JOINT,
                 "stiffness_ratio": soft_knee.RATIO},
        "named": named, "verdict": diagnosis["verdict"], "effects": diagnosis["effects"],
        "off_before_n": mended.off_before_n, "off_after_n": mended.off_after_n}


def _keep(story: Story, kept: str, folder: Path) -> None:
    """All files of a folder, under this name."""
    for path in sorted(folder.rglob("*")):
        if path.is_file():
            story.files[f"{kept}/{path.relative_to(folder).as_posix()}"] = path.read_bytes()


def _robot(story: Story) -> Iterator[str]:
    scene = four_limbs.Scene()
    first = scene.foretold.first_slip
    yield (f"   hidden: footholds off by {four_limbs.OFFSET_MM:g} mm, zeros by {1e3 * four_limbs.ZERO_RAD:g} mrad, "
           f"compliances by {100 * four_limbs.COMPLIANCE_REL:g} %; the tips' forces are read with "
           f"{four_limbs.SENSOR_N:g} N before the payload")
    yield (f"   foretold: {first.limb} slips first, at {first.payload_factor:.2f} times the payload "
           f"({first.low:.2f} to {first.high:.2f} with 90 %)")
    steps, slid = scene.hang_on()
    story.files["robot.png"] = picture(scene.foretold)
    story.files["robot.csv"] = four_limbs.table(steps).encode()
    yield f"   payload   margin of {first.limb} [N]: foretold    true   has slipped"
    for step in steps:
        # a foot that has slipped has no margin but for rounding
        foretold = "  none" if step.foretold_n is None else f"{abs(step.foretold_n):6.2f}"
        indent = " " * (len(first.limb or "") + 18)
        yield f"   {step.factor:7.2f}{indent}{foretold}  {abs(step.true_n):6.2f}   {', '.join(step.slid)}".rstrip()
    yield "   no foot slipped" if slid is None else f"   {slid.limb} slipped at {slid.factor:.2f} times the payload"
    lifted, before, then = scene.lift_one()
    yield f"   {lifted.name} lifted, no payload; each foot presses [N]:   before  foretold    true"
    for i, limb in enumerate(scene.stance.limbs):
        presses = (before[i, 2], lifted.force_n[i, 2], then[i, 2])
        yield f"     {limb.name:{len(lifted.name) + 46}} " + "{:9.2f} {:9.2f} {:7.2f}".format(*presses)
    story.facts["robot"] = {
        "foretold": first.as_json(), "slipped": None if slid is None else {"limb": slid.limb, "factor": slid.factor},
        "steps": [{"payload_factor": step.factor, "margin_foretold_n": step.foretold_n, "margin_true_n": step.true_n,
                   "slipped": list(step.slid)} for step in steps],
        "lifted": lifted.name, "lifted_foretold_n": lifted.force_n, "lifted_true_n": then, "lifted_before_n": before}

"""One limb's card, drawn by the page's own script from views that nobody sent: what a reader sees of numbers, of noise
and of silence."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

PAGE = Path(__file__).resolve().parents[3] / "tools" / "brace" / "live" / "page"
CHROMIUM = shutil.which("chromium")
KINDS = {".js": "text/javascript", ".css": "text/css", ".html": "text/html"}
VIEW: dict[str, Any] = {
    "node": 1, "name": "", "lengths_mm": [57.0, 185.0, 313.5], "lengths_why": "", "load_why": "not sent", "play": [],
    "mode": "monitor", "mode_text": "", "faults": [], "flags": [], "silent_s": None, "rate_hz": 200.0, "age_ms": 0,
    "is_valid": True, "k_n_per_mm": [3.9512, -0.66, 0.43], "sigma_k_n_per_mm": [0.11, 0.04, 0.018],
    "lambda_n_per_mm": [0.3191, 4.07], "stiff_axis_rad": -0.17, "relative_sigma": [0.03, 0.03],
    "theta_rad": [None, 1.0, 1.4], "k_space_n_per_mm": None, "lambda_space_n_per_mm": None,
    "sigma_lambda_space_n_per_mm": None, "load": None,
}  # fmt: skip
SHOW = """async ([views, waits_ms]) => {
    const { Limb } = await import("/limb.js");
    const limb = new Limb(document.getElementById("limb").content.firstElementChild.cloneNode(true));
    document.getElementById("limbs").replaceChildren(limb.element);
    for (const view of views) {
        limb.show(view);
        await new Promise((done) => setTimeout(done, waits_ms));
    }
    const rows = [...limb.element.querySelectorAll("dt")].filter((row) => !row.hidden);
    return {
        rows: Object.fromEntries(rows.map((row) => [row.textContent, row.nextElementSibling.textContent])),
        caption: limb.find("figcaption").textContent,
        arrow: getComputedStyle(limb.find(".force")).display,
        colour: getComputedStyle(limb.find("dd")).color,
    };
}"""


@pytest.fixture(scope="module")
def page() -> Iterator[Any]:
    api = pytest.importorskip("playwright.sync_api")
    if CHROMIUM is None:
        pytest.skip("no chromium here")

    def serve(route: Any) -> None:
        name = route.request.url.partition("//")[2].partition("/")[2] or "index.html"
        if name == "page.js":  # which would listen
            route.fulfill(content_type="text/javascript", body="")
        else:
            route.fulfill(content_type=KINDS[Path(name).suffix], body=(PAGE / name).read_text())

    with api.sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        opened = browser.new_page(viewport={"width": 400, "height": 800})
        opened.route("**/*", serve)
        opened.goto("http://limb.test/")
        yield opened
        browser.close()


def shown(page: Any, *views: dict[str, Any], waits_ms: int = 0) -> dict[str, Any]:
    """The card after these views, one after the other; each is what differs from VIEW."""
    seen: dict[str, Any] = page.evaluate(SHOW, [[{**VIEW, **view} for view in views], waits_ms])
    return seen


def loads(*forces_n: tuple[float, float]) -> list[dict[str, Any]]:
    return [
        {"load": {"force_n": list(force), "moved_mm": [0.0, 0.0], "unloaded_k_n_per_mm": [4.38, -0.34, 0.333],
                  "buckling_factor": None}}
        for force in forces_n
    ]  # fmt: skip


def test_a_number_has_the_digits_of_its_uncertainty_and_keeps_it_in_its_line(page: Any) -> None:
    rows = shown(page, {})["rows"]
    assert rows["K xx, xz, zz"] == "3.95 ± 0.11, −0.660 ± 0.040, 0.430 ± 0.018 N/mm".replace(" ± ", "\xa0±\xa0")
    unsure = shown(page, *loads((-0.11, 0.0431), (0.1, 0.0431)))["rows"]
    assert unsure["force x, z"].startswith("0.00\xa0±\xa0") and unsure["K without load"] == "4.38, −0.340, 0.333 N/mm"


def test_a_force_within_its_scatter_has_no_arrow(page: Any) -> None:
    assert shown(page, *loads((0.2, 0.1), (-0.15, -0.12), (0.1, -0.1)))["arrow"] == "none"
    assert shown(page, *loads((2.0, 0.1), (2.1, 0.0), (1.9, -0.1)))["arrow"] != "none"
    assert shown(page, {})["arrow"] == "none"


def test_the_history_says_why_a_line_is_not_there(page: Any) -> None:
    assert "softest (dashed)" in shown(page, {})["caption"]
    assert "softest is 0: no line" in shown(page, {"lambda_n_per_mm": [0.0, 2.65]})["caption"]
    assert shown(page, {"lambda_n_per_mm": [-0.1, 0.0]})["caption"] == "no K above zero in the last minute"
    assert shown(page, {"silent_s": 9.0})["caption"] == "no K has come in the last minute"


def test_old_numbers_look_old(page: Any) -> None:
    now, old = shown(page, {}), shown(page, {"silent_s": 9.0})
    assert old["colour"] != now["colour"] and old["rows"]["K comes"] == "nothing for 9 s"


def test_a_silent_limb_keeps_the_scatter_of_its_last_second(page: Any) -> None:
    """The same old force comes thirty times a second; its mean has no scatter but rounding."""
    heard = loads((-30.126, 3.943), (-30.0, 3.9), (-30.2, 4.0))
    old = [{**heard[-1], "silent_s": 5.0} for _ in range(9)]
    assert shown(page, *heard, *old)["rows"]["force x, z"] == shown(page, *heard)["rows"]["force x, z"]
    assert shown(page, *loads(*[(-30.126, 3.943)] * 9))["rows"]["force x, z"] == "−30.1, 3.94 N, last second"
    assert page.evaluate("document.documentElement.scrollWidth") <= 400

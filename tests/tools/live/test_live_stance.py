"""`brace monitor --web --stance`: what each foot of a simulated robot bears, on the page."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command_bench import PROJECT, Outcome, spawn

from brace.bus.open import open_bus
from brace.bus.url import parse
from brace.live.feed import Feed
from brace.live.stance_view import StanceFeed
from brace.stance.stance_file import load_stance

CHROMIUM = shutil.which("chromium")
STANCE = PROJECT / "examples" / "stance" / "stance.toml"
NAMES = ["front left", "front right", "rear left", "rear right"]
START_S = 30.0  # of a command, on a busy machine
WEIGHT_N = 30.0 + 4 * 1.7  # of body and limbs


@contextlib.contextmanager
def robot() -> Iterator[str]:
    """A simulated robot in step with the clock, without a payload; where its bus is."""
    options = ("--json", "--modbus", "none", "--can", "tcp://127.0.0.1:0", "--payload", "0@0", "--seconds", "300")
    process = spawn("sim", "--stance", STANCE, *options)
    try:
        assert process.stdout is not None
        yield str(json.loads(process.stdout.readline())["limbs"][0]["can"])
    finally:
        process.kill()
        process.wait()


def test_the_feet_bear_the_weight_and_the_page_gets_it() -> None:
    stance = StanceFeed(load_stance(STANCE), "tcp://nowhere:1")
    feed = Feed(parse("tcp://nowhere:1"), 1_000_000, stance=stance)
    assert stance.numbers["waits_for"] == NAMES and stance.numbers["feet"] == []
    with robot() as where:
        bus = open_bus(parse(where))
        until = time.monotonic() + START_S
        while len(stance.numbers["feet"]) < len(NAMES) and time.monotonic() < until:
            time.sleep(0.03)
            stance.take(bus.receive_all(), time.time())
        bus.close()
    numbers = json.loads(feed.messages()[1])["stance"]
    assert numbers["waits_for"] == [] and numbers["trouble"] == ""
    assert [foot["name"] for foot in numbers["feet"]] == NAMES
    up_n = sum(foot["force_n"][2] for foot in numbers["feet"])
    # feet share what is not known of each: their intervals add at most
    assert abs(up_n - WEIGHT_N) < sum(foot["half_n"][2] for foot in numbers["feet"])
    assert all(foot["margin_n"] > 0.0 and foot["margin_half_n"] > 0.0 for foot in numbers["feet"])
    assert numbers["next_limb"] in NAMES and numbers["next_factor"] > 1.0


def test_a_stance_needs_the_page_and_all_limbs(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    log = tmp_path / "run.log"
    log.write_text("(100.000000) can0 703#0505000000000000\n")
    for options in ((), ("--web", "0", "--node", "3")):
        outcome = brace("monitor", "--bus", f"log:{log}", "--stance", STANCE, *options)
        assert outcome.code == 2 and "try:" in outcome.err, outcome.err


@pytest.mark.minutes
@pytest.mark.skipif(CHROMIUM is None, reason="no chromium here")
def test_the_card_in_a_browser(tmp_path: Path) -> None:
    api = pytest.importorskip("playwright.sync_api")
    with robot() as where:
        process = spawn("monitor", "--bus", where, "--stance", STANCE, "--web", "0")
        try:
            assert process.stdout is not None
            address = process.stdout.readline().split()[1]
            with api.sync_playwright() as playwright:
                options = ["--no-sandbox", "--disable-gpu"]
                browser = playwright.chromium.launch(executable_path=CHROMIUM, args=options)
                page = browser.new_page(viewport={"width": 1200, "height": 900})
                wrong = list[str]()
                page.on("console", lambda message: wrong.append(message.text))
                page.on("pageerror", lambda error: wrong.append(str(error)))
                page.goto(address)
                page.wait_for_selector("#stance tbody tr:nth-of-type(4)", timeout=2000 * START_S)
                rows = page.eval_on_selector_all("#stance tbody tr", "rows => rows.map(row => row.innerText)")
                assert all(name in row and "\u00b1" in row for name, row in zip(NAMES, rows, strict=True))
                assert "next to let go: " in page.inner_text("#stance .next")
                pictures = os.environ.get("BRACE_PICTURES", str(tmp_path))
                for width in (1200, 400):
                    page.set_viewport_size({"width": width, "height": 900})
                    assert page.evaluate("document.documentElement.scrollWidth") <= width
                    page.screenshot(path=f"{pictures}/stance-{width}.png", full_page=True)
                assert not wrong, wrong
                browser.close()
        finally:
            process.terminate()
            process.wait(timeout=START_S)

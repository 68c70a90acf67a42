"""`brace monitor --web`: what the page is told, who may read it, and the page in a real browser."""

from __future__ import annotations

import json
import os
import re
import shutil
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from command_bench import FREE, LIMB, Outcome, running, spawn

from brace.bus.load import LOAD_ENTRIES, Load
from brace.bus.sigma import sigma_of
from brace.bus.snapshot import Heartbeat, Snapshot
from brace.bus.url import parse
from brace.bus.watch import NodeState
from brace.ground.errors import NoDeviceError
from brace.live.card import Card, card_from, card_of
from brace.live.feed import Feed
from brace.live.limb_view import LimbNumbers, LimbWords, limb_numbers, limb_words
from brace.model import LimbModel, load_limb
from brace.stiffness.at_rest import planar_limb

CHROMIUM = shutil.which("chromium")
START_S = 30.0  # of a command, on a busy machine
FIRST_PAINT_MS = 1000.0  # the quickest of three times, because other work may delay any of them
FREE_PORT = "0"


@pytest.fixture
def limb_file(tmp_path: Path) -> Path:
    path = tmp_path / "limb.toml"
    path.write_text(LIMB.replace("[joint.tibia]", "[joint.tibia]\ngap_rad = 0.006"))
    return path


def snapshot(**changes: object) -> Snapshot:
    told = Snapshot(
        node=3, time_s=100.0, sequence=7, k_xx=3.9, k_xz=-0.6, k_zz=0.4, flags=("GAP_OPEN",), age_ms=1.0,
        play=("engaged_positive", "crossing"), has_posture=True, lambda_min=0.31, lambda_max=4.0, stiff_axis=-0.17,
        theta1=1.0, theta2=1.4, mode="monitor", faults=("encoder_stuck",),
    )
    return told._replace(**changes)  # type: ignore[arg-type]


def view_of(newest: Snapshot, card: Card, now_s: float = 100.5) -> tuple[LimbWords, LimbNumbers]:
    state = NodeState(
        snapshot=newest, posture=newest, mode=newest.mode, faults=newest.faults, last_s=newest.time_s
    )
    return limb_words(3, state, card), limb_numbers(3, state, card, now_s)


def test_a_limb_is_told_with_its_place_and_its_trust(limb_file: Path) -> None:
    words, view = view_of(snapshot(), card_of(load_limb(limb_file)))
    assert view["is_valid"] and view["silent_s"] is None
    assert words["lengths_mm"] == [57.0, 185.0, 313.5] and view["theta_rad"] == [None, 1.0, 1.4]
    assert view["relative_sigma"] is not None and all(0.01 < sigma < 0.2 for sigma in view["relative_sigma"])
    (play,) = words["play"]  # the femur has none
    assert (play["joint"], play["state"]) == ("tibia", "crossing")
    assert play["text"] == "backlash is open; brace take-up tibia- --bus URL (or tibia+) takes it up"
    assert words["faults"][0]["name"] == "ENCODER_STUCK" and words["faults"][0]["text"].endswith(".")
    assert words["flags"][0]["name"] == "GAP_OPEN" and words["mode_text"]
    assert "load_hz" in words["load_why"] and "params push" in words["load_why"]  # what it is, and how to get it
    json.dumps([words, view], allow_nan=False)


def test_the_trust_in_k_is_that_of_the_knee_s_angle(limb_file: Path) -> None:
    """Turning the whole limb turns K's axes and leaves its eigenvalues; bending the knee changes them."""
    card = card_of(load_limb(limb_file))
    here, turned, bent = (card.relative_sigmas(*theta_rad) for theta_rad in ((0.4, 1.4), (1.2, 1.4), (0.4, 0.2)))
    assert here == pytest.approx(turned) and here != pytest.approx(bent, rel=0.05)


def test_what_is_not_known_is_told_as_that() -> None:
    nothing = snapshot(k_xx=None, lambda_min=None, lambda_max=None, theta1=None, theta2=None)
    words, view = view_of(nothing, Card(why_not="nobody told"), now_s=110.0)
    assert not view["is_valid"] and view["silent_s"] == 10.0
    assert words["lengths_mm"] is None and view["relative_sigma"] is None and view["theta_rad"][1] is None
    assert words["lengths_why"] == "nobody told"
    assert view["k_n_per_mm"][0] is None


def test_the_controller_s_own_uncertainty_is_what_the_page_shows(limb_file: Path) -> None:
    """Of late; else the one that the limb's file gives."""
    values = {"k_xx": 0.1, "k_xz": 0.05, "k_zz": 0.02, "lambda_min": 0.031, "lambda_max": 0.2, "stiff_axis": 0.01}
    newest, card = snapshot(), card_of(load_limb(limb_file))
    by_file = limb_numbers(3, NodeState(snapshot=newest, posture=newest, last_s=100.0), card, 100.5)
    for age_s in (0.5, 5.0):
        told = snapshot(sigma=sigma_of(values), time_s=100.0 - age_s)
        view = limb_numbers(3, NodeState(snapshot=newest, posture=newest, sigma=told, last_s=100.0), card, 100.5)
        is_new = age_s < 1.0
        assert view["sigma_k_n_per_mm"] == ([0.1, 0.05, 0.02] if is_new else None)
        assert view["relative_sigma"] == ([0.1, 0.05] if is_new else by_file["relative_sigma"])


def test_what_the_limb_s_file_gives_holds_without_load_only(limb_file: Path) -> None:
    counted = dict.fromkeys(
        (*LOAD_ENTRIES, "gravity_lean", "counted_force_x", "counted_force_z", "moved_x", "moved_z"), 0.5
    )
    newest, card = snapshot(), card_of(load_limb(limb_file))
    for force, is_known in ((0.5, False), (None, True)):  # no force: K counts no load
        pressed = snapshot(load=Load({**counted, "counted_force_x": force}))
        view = limb_numbers(3, NodeState(snapshot=newest, posture=newest, load=pressed, last_s=100.0), card, 100.5)
        assert (view["load"] is None) == is_known and (view["relative_sigma"] is not None) == is_known


def test_heartbeats_alone_make_a_limb() -> None:
    state = NodeState(
        heartbeat=Heartbeat(3, 100.0, "operational", "fault", "bench", 2, 0), mode="fault", faults=("sensor_femur",),
        last_s=100.0,
    )
    words = limb_words(3, state, Card())
    assert words["mode"] == "fault" and words["faults"][0]["name"] == "SENSOR_FEMUR"
    assert not limb_numbers(3, state, Card(), 100.0)["is_valid"]


def test_words_are_sent_again_where_they_changed_only(limb_file: Path) -> None:
    feed = Feed(parse("tcp://nowhere:1"), 1_000_000)
    first = snapshot()
    state = feed.watch.nodes[3] = NodeState(snapshot=first, posture=first, last_s=first.time_s)
    feed.cards[3] = card_of(load_limb(limb_file))
    words, numbers = feed.messages()
    state.posture = snapshot(k_xx=3.8)
    same, others = feed.messages()
    assert same is words and others != numbers
    state.posture = snapshot(flags=())
    assert "GAP_OPEN" in words and "GAP_OPEN" not in feed.messages()[0]
    feed.trouble = "the connection is lost"
    assert "the connection is lost" in feed.messages()[0]


def test_who_cannot_be_asked_leaves_an_empty_card() -> None:
    def ask() -> LimbModel:
        raise NoDeviceError("no answer", where="can0")

    card = card_from(ask)
    assert card.lengths_mm is None and "no answer" in card.why_not


@contextmanager
def page_of(*arguments: object) -> Iterator[str]:
    """The page's address while the command serves it."""
    process = spawn("monitor", *arguments, "--web", FREE_PORT)
    try:
        assert process.stdout is not None
        line = process.stdout.readline()
        assert line.startswith("open http://127.0.0.1:"), line
        yield line.split()[1]
    finally:
        process.terminate()
        assert process.wait(timeout=START_S) == 0


def refused(address: str, **headers: str) -> int:
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=headers), timeout=START_S) as answer:
            return int(answer.status)
    except urllib.error.HTTPError as error:
        return error.code


def test_only_a_browser_on_this_computer_reads(tmp_path: Path) -> None:
    log = tmp_path / "run.log"
    log.write_text("(100.000000) can0 703#0505000000000000\n")
    with page_of("--bus", f"log:{log}") as address:
        assert refused(address) == 200
        assert refused(address, Host="limb.example") == 403  # a name that was made to mean this computer
        assert refused(address + "live", Origin="http://limb.example") == 403
        with urllib.request.urlopen(address, timeout=START_S) as answer:
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
            assert "//" not in answer.read().decode().replace("<!doctype", "")  # nothing from elsewhere


def test_a_port_that_is_taken_is_told(brace: Callable[..., Outcome], tmp_path: Path) -> None:
    log = tmp_path / "run.log"
    log.write_text("(100.000000) can0 703#0505000000000000\n")
    with page_of("--bus", f"log:{log}") as address:
        port = address.rstrip("/").rpartition(":")[2]
        outcome = brace("monitor", "--bus", f"log:{log}", "--web", port)
    assert outcome.code == 2 and port in outcome.err and "--web 0" in outcome.err


@pytest.mark.minutes
@pytest.mark.skipif(CHROMIUM is None, reason="no chromium here")
def test_the_page_in_a_browser(limb_file: Path, tmp_path: Path) -> None:
    """Two limbs, drawn, at two widths; nothing asked for but what this computer serves."""
    api = pytest.importorskip("playwright.sync_api")
    with running(limb_file, "--limbs", "2", *FREE) as (_, ready), page_of("--bus", ready["limbs"][0]["can"]) as address:
        with api.sync_playwright() as playwright:
            browser = playwright.chromium.launch(
                executable_path=CHROMIUM,
                args=["--no-sandbox", "--disable-gpu", "--disable-background-networking", "--disable-sync",
                      "--disable-component-update", "--no-first-run"],
            )
            page = browser.new_page(viewport={"width": 1280, "height": 900})
            asked, wrong, updates = list[str](), list[str](), list[str]()
            page.on("request", lambda request: asked.append(request.url))
            page.on("console", lambda message: wrong.append(message.text))
            page.on("pageerror", lambda error: wrong.append(str(error)))
            page.on("websocket", lambda one: one.on("framereceived", lambda text: updates.append(str(text))))
            page.goto(address)
            for number in (1, 2):
                drawn = f"article:nth-of-type({number}) .ellipse[d]"
                page.wait_for_selector(drawn, state="attached", timeout=1000 * START_S)
            words = page.inner_text("main")
            assert "Node 1" in words and "Node 2" in words and "N/mm" in words
            assert "NaN" not in page.content() and "undefined" not in page.content()
            picture = os.environ.get("BRACE_PICTURES", str(tmp_path))
            page.screenshot(path=f"{picture}/page-wide.png", full_page=True)
            page.set_viewport_size({"width": 400, "height": 900})
            assert page.evaluate("document.documentElement.scrollWidth") <= 400
            page.screenshot(path=f"{picture}/page-narrow.png", full_page=True)
            assert not wrong, wrong
            assert asked and all(url.startswith(address) for url in asked), asked
            assert len(updates) > 2
            drawn = page.eval_on_selector(".links", "line => line.getAttribute('points')")
            angles = next(json.loads(text)["numbers"][0]["theta_rad"] for text in updates[::-1] if "numbers" in text)
            limb = load_limb(limb_file)
            (knee_x, knee_z), (tip_x, tip_z) = planar_limb(limb).pose(*angles[1:])
            corners = [float(number) for number in re.split("[ ,]", drawn)]
            coxa = [-limb.number("geometry.coxa_mm"), 0.0]
            assert corners == pytest.approx([*coxa, 0.0, 0.0, knee_x, -knee_z, tip_x, -tip_z], abs=1.0)  # y points down
            assert page.eval_on_selector_all(".name", "names => names.map(name => name.textContent)")[:3] == [
                "coxa", "femur", "tibia"
            ]  # fmt: skip
            paints_ms = [first_paint_ms(page) for _ in range(3)]
            assert min(paints_ms) < FIRST_PAINT_MS, paints_ms
            browser.close()


def first_paint_ms(page: Any) -> float:
    """From the call for the page to the first that the browser shows of it."""
    page.reload()
    page.wait_for_selector(".ellipse[d]", state="attached", timeout=1000 * START_S)
    return float(page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime"))

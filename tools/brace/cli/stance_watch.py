"""`brace stance watch`: who carries what, from what the limbs' controllers send."""

from __future__ import annotations

import argparse
import contextlib
import json
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from brace.cli import common
from brace.cli.bus_options import Ended, add_bus, bus_url, ended_by_signal
from brace.cli.options import Subcommands
from brace.ground.errors import EXIT_CHECK_FAILED, EXIT_OK, DeviceFaultError, NoDeviceError, UsageError

if TYPE_CHECKING:
    from brace.bus.frame import Bus, Frame
    from brace.stance.watching import Shown, Watching

_FETCH_S = 0.01  # waking up is dear on an idle machine; a frame is at most so much older than its time says
_LINE_S = 1.0
_SILENCE_S = 3.0


def add(actions: Subcommands, sensor_sd_n: float) -> None:
    """Declares the action."""
    parser = actions.add_parser(
        "watch",
        help="what each foot bears now, from the bus: forces, margins, events, alarms",
        description="Listens to the controllers of all limbs. Measured forces say what each foot bears, each limb's K "
        "how that changes; what is carried, a foot that moves, a lift and a landing are events. A controller sends its "
        "forces only if load_hz is above 0: write load_hz = 50 under [controller] in limb.toml and send the file with "
        "brace params push. Prints a line for each foot each second, with --json one object every --every seconds; an "
        "event is printed at once.",
        epilog="Exit codes: 0 done, 1 with --alarm-ends: an alarm, 2 usage, 3 bad file, 4 a limb is not heard, 5 the "
        "limbs do not hold the body, 6 another dictionary, 130 Ctrl-C.",
    )
    parser.add_argument("stance", type=common.path, metavar="STANCE.toml", help="the stance; `node` of each limb")
    add_bus(parser)
    parser.add_argument("--seconds", type=common.duration, metavar="S", help="how long; default until Ctrl-C")
    parser.add_argument("--every", type=common.duration, default=_LINE_S, metavar="S", help="a line; default 1")
    parser.add_argument(
        "--alarm",
        type=common.positive_force,
        metavar="N",
        help="a foot whose margin is not surely above this is an alarm; default 2 %% of the weight",
    )
    parser.add_argument("--alarm-ends", action="store_true", help="the first alarm ends the command, with exit code 1")
    parser.add_argument(
        "--measured-sd", type=common.positive_force, default=sensor_sd_n, metavar="N",
        help=f"one sigma of a tip sensor's reading; default {sensor_sd_n:g}",
    )  # fmt: skip
    common.add_json(parser)
    parser.set_defaults(run=_run)


def _run(arguments: argparse.Namespace) -> int:
    from brace.bus.open import open_bus
    from brace.stance.stance_file import load_stance
    from brace.stance.watching import Watching

    stance = load_stance(arguments.stance)
    url = bus_url(arguments, frames_for="a stance")
    if arguments.node is not None:
        raise UsageError(
            "--node with `stance watch`",
            why="a stance listens to all of its limbs, whose nodes stance.toml names",
            next_step="leave --node out",
        )
    watching = Watching(stance, url.text, arguments.measured_sd, arguments.alarm)
    bus = open_bus(url, arguments.bit_rate)
    try:
        with ended_by_signal() as ended:
            return _follow(arguments, bus, watching, ended)
    finally:
        bus.close()


def _follow(arguments: argparse.Namespace, bus: Bus, watching: Watching, ended: Ended) -> int:
    """Until the time, the end of a log, an alarm that shall end it, or a signal."""
    from brace.stance.statics import LooseError

    next_s, started_s, is_heard = -float("inf"), None, False
    try:
        for frames, now_s in _periods(bus):
            started_s = now_s if started_s is None else started_s
            is_heard = watching.take(frames, now_s)
            _print_events(arguments, watching)
            if is_heard and now_s >= next_s:
                _print(arguments, watching.shown())
                next_s = now_s + arguments.every
            if watching.alarms and arguments.alarm_ends:
                return EXIT_CHECK_FAILED
            if ended.is_set() or (arguments.seconds is not None and now_s - started_s >= arguments.seconds):
                break
            if not is_heard and now_s - started_s > _SILENCE_S:
                break
    except LooseError as error:
        raise DeviceFaultError(
            f"no stance: {error}",
            where=bus.url,
            why="the limbs' stiffness, as their controllers report it, does not hold the body",
            next_step="brace monitor shows each K; docs/stance.md says what a body of two feet needs",
        ) from None
    if not is_heard and not ended.is_set():
        raise _unheard(bus, watching)
    return EXIT_OK


def _periods(bus: Bus) -> Iterator[tuple[list[Frame], float]]:
    """What has come in each period, and when: by the clock, or by a log's own times until it ends."""
    from brace.bus.frame import EndOfLog
    from brace.bus.log import LogBus
    from brace.stance.watching import PERIOD_S

    if not isinstance(bus, LogBus):
        while True:
            until_s, came = time.monotonic() + PERIOD_S, bus.receive_all()
            while (left_s := until_s - time.monotonic()) > 0.0:
                time.sleep(min(_FETCH_S, left_s))
                came += bus.receive_all()
            yield came, time.time()
    frames: list[Frame] = []
    with contextlib.suppress(EndOfLog):
        while (frame := bus.receive(0.0)) is not None:
            if frames and frame.time_s - frames[0].time_s >= PERIOD_S:
                yield frames, frames[-1].time_s
                frames = []
            frames.append(frame)
    if frames:
        yield frames, frames[-1].time_s


def _unheard(bus: Bus, watching: Watching) -> Exception:
    missing = ", ".join(watching.missing())
    return NoDeviceError(
        f"nothing heard from {missing}",
        where=bus.url,
        why="brace stance watch begins when the controller of each limb has sent its K",
        next_step="check each limb's `node` in stance.toml; brace monitor shows who is heard",
    )


def _print_events(arguments: argparse.Namespace, watching: Watching) -> None:
    from brace.stance.watching import event_json, event_line

    for event in watching.new_events():
        if arguments.json:
            common.emit(json.dumps(common.json_ready(event_json(event))))
        else:
            common.emit(event_line(event))


def _print(arguments: argparse.Namespace, shown: Shown) -> None:
    if arguments.json:
        common.emit(json.dumps(common.json_ready(shown.as_json())))
    else:
        common.emit("\n".join(shown.lines()))

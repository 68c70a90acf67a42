"""`brace sim`: controllers over simulated limbs, on the wire."""

from __future__ import annotations

import argparse
import json
import math
import re
import signal
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from brace.cli import common, sim_stance_options, sim_values
from brace.cli.bus_options import Ended, ended_by_signal, key_of
from brace.cli.options import Subcommands, refused
from brace.cli.subcommands import SUBCOMMANDS
from brace.ground.errors import EXIT_INTERRUPTED, EXIT_OK, UsageError
from brace.sim import spec

if TYPE_CHECKING:
    from brace.model import LimbModel
    from brace.sim.node import LimbSetup, Node
    from brace.sim.robot import Robot

    AnyNode = TypeVar("AnyNode", bound=Node)

CAN_PORT = 29536
MODBUS_PORT = 1502
_POLL_S = 0.2
OWNER_SILENCE_S = 0.5  # of the wall clock, where limbs run at a speed of their own
_FAST_SLICE_S = 0.5


def add(commands: Subcommands) -> None:
    """Declares the subcommand."""
    parser = commands.add_parser(
        "sim",
        help=SUBCOMMANDS["sim"],
        description="Starts controllers over simulated limbs and says where to connect, one line a limb; with --json "
        "one JSON object a line: 'ready' with the places, 'end' with the last tick. Ctrl-C or --seconds ends it. The "
        "controller believes --model, its parameter block; what is true is --plant. A limb in which something "
        "yields across its plane (joint.coxa, a link's lateral compliance or torsion) has a coxa joint, and reports K "
        "in space.",
        epilog=f"Faults: {', '.join(spec.FAULTS)}; values: current_offset in N mm, force_offset in N, "
        "tick_late in ms; joint_soft:LIMB.tibia=0.6: the knee has 0.6 of its stiffness.",
    )
    limbs = parser.add_mutually_exclusive_group(required=True)
    common.add_model(limbs, "what the controllers believe; and what is true, without --plant", required=False)
    limbs.add_argument(
        "--stance",
        type=common.path,
        metavar="STANCE.toml",
        help="instead of --model: all limbs of a stance under one body, each with its own controller",
    )
    parser.add_argument("--plant", type=common.path, metavar="TRUE.toml", help="the true limb")
    parser.add_argument("--limbs", type=common.count(1, 16), default=1, metavar="N", help="default 1")
    parser.add_argument(
        "--can",
        metavar="URL",
        help=f"tcp://HOST:PORT (SLCAN; default 127.0.0.1:{CAN_PORT}), slcan:pty, slcan:/dev/ttyX, can0, none",
    )
    parser.add_argument(
        "--modbus",
        metavar="URL",
        help=f"modbus-tcp://HOST:PORT[/UNIT] (default 127.0.0.1:{MODBUS_PORT}; further limbs the next ports), "
        "modbus:pty, modbus:/dev/ttyX[@BAUD[/UNIT]], none",
    )
    parser.add_argument(
        "--serial",
        action="append",
        default=[],
        metavar="PORT=WHERE",
        help="console or slcan = stderr, file:PATH, pty, /dev/ttyX[@BAUD], tcp://HOST:PORT; may be repeated",
    )
    parser.add_argument(
        "--key",
        type=Path,
        metavar="FILE",
        help="the controllers are guarded by this key, 32 hexadecimal digits: commands need it (docs/security.md)",
    )
    parser.add_argument("--seed", type=common.count(0, 2**63 - 1), default=0, help="of the noise; default 0")
    parser.add_argument("--seconds", type=common.duration, metavar="S", help="how long; default until Ctrl-C")
    pace = parser.add_mutually_exclusive_group()
    pace.add_argument("--realtime", action="store_true", help="in step with the clock (default)")
    pace.add_argument(
        "--speed", type=common.positive_ratio, default=1.0, metavar="X", help="so many times faster than the clock"
    )
    pace.add_argument("--fast", action="store_true", help="as fast as possible; needs --seconds")
    parser.add_argument(
        "--fault",
        type=sim_values.fault,
        action="append",
        default=[],
        metavar="SPEC",
        help="NAME[:[LIMB.]JOINT][=VALUE][@SECONDS[+DURATION]], e.g. encoder_stuck:femur@2.0+1.5; may be repeated",
    )
    parser.add_argument(
        "--posture",
        type=sim_values.posture,
        action="append",
        default=[],
        metavar="T1,T2[@S]",
        help="set-points [rad]; the first is where the limbs stand, further ones move them; default 1.0,1.4",
    )
    parser.add_argument(
        "--contact",
        type=sim_values.contact,
        default=math.inf,
        metavar="KIND",
        help="planted (default), free, wall:K [N/mm]",
    )
    parser.add_argument(
        "--press",
        type=sim_values.pair_mm,
        default=(0.0, 0.0),
        metavar="X,Z",
        help="where the contact holds the tip, from where the unloaded limb has it [mm]",
    )
    parser.add_argument(
        "--press-across",
        type=common.length,
        default=0.0,
        metavar="Y",
        help="the same across the limb's plane [mm], of a limb with a coxa joint",
    )
    parser.add_argument(
        "--theta0",
        type=common.angle,
        default=0.0,
        metavar="RAD",
        help="where the coxa joint stands, of a limb that has one; default 0",
    )
    parser.add_argument("--node", type=common.count(1, 127), metavar="ID", help="CAN node of the first limb")
    parser.add_argument(
        "--nvm", metavar="FILE", help="keeps the controllers' memory; what it holds goes before --model"
    )
    parser.add_argument("--no-force-sensor", action="store_true", help="the tip has none")
    parser.add_argument("--link-encoders", action="store_true", help="encoders behind the gears too")
    parser.add_argument(
        "--servos",
        metavar="WHERE",
        help="joints by Dynamixel servos (Protocol 2.0): sim, simulated MX-106 behind the boards' own driver; or "
        "/dev/ttyUSB0[@BAUD], real ones, which nothing moves but the controller's own tests; docs/joints.md",
    )
    parser.add_argument(
        "--servo-ids",
        type=_servo_ids,
        default=(11, 12, 13),
        metavar="COXA,FEMUR,TIBIA",
        help="default 11,12,13; a limb without a coxa joint does not ask the first",
    )
    parser.add_argument(
        "--servos-hold", action="store_true", help="switches the torque of real servos on, where they stand"
    )
    sim_stance_options.add(parser)
    common.add_json(parser)
    parser.set_defaults(run=run)


def _servo_ids(text: str) -> tuple[int, int, int]:
    """Three different ids of servos."""
    found = re.fullmatch(r"(\d+),(\d+),(\d+)", text)
    ids = [int(part) for part in found.groups()] if found else []
    if len(set(ids)) != 3 or max(ids) > 252:
        raise refused(f"{text}: not three ids", why="each is 0 to 252, none twice", way="OPTION 11,12,13")
    return ids[0], ids[1], ids[2]


def run(arguments: argparse.Namespace) -> int:
    """Executes the subcommand."""
    if arguments.fast and arguments.seconds is None:
        raise UsageError("--fast without --seconds", why="it would never end", next_step="add --seconds 10")
    sim_stance_options.refuse_mixture(arguments)
    return _run_stance(arguments) if arguments.stance is not None else _run_alone(arguments)


def _run_alone(arguments: argparse.Namespace) -> int:
    from brace.model import load_limb
    from brace.sim.node import Node

    model = load_limb(arguments.model)
    plant = load_limb(arguments.plant) if arguments.plant else model

    def made(can: str, modbus: str) -> Node:
        return Node(_setups(arguments, _alike(arguments, model, plant), modbus), can, arguments.seed)

    with _make_node(arguments, made) as node:
        if (arguments.press_across or arguments.theta0) and not node.has_coxa_joint():
            raise UsageError(
                "--press-across and --theta0 are of a limb with a coxa joint",
                where=str(arguments.plant or arguments.model),
                why="nothing in this limb yields across its plane",
                next_step="give joint.coxa.compliance_rad_per_n_mm or a link's lateral_mm_per_n, or drop the option",
            )
        for fault in arguments.fault:
            node.add_fault(fault)
        for posture in arguments.posture[1:]:
            node.add_posture(posture)
        return _run_to_the_end(arguments, node)


def _run_stance(arguments: argparse.Namespace) -> int:
    from brace.cli import sim_stance
    from brace.sim.robot import Robot
    from brace.stance.simulated import SERVO_N_MM_PER_RAD

    stance = sim_stance.read(arguments)
    arguments.limbs = len(stance.names)
    body = stance.body

    def made(can: str, modbus: str) -> Robot:
        setups = _setups(arguments, stance.limbs, modbus)
        for setup in setups:
            setup.drive["servo_n_mm_per_rad"] = SERVO_N_MM_PER_RAD
        return Robot(body, setups, can, arguments.seed)

    with _make_node(arguments, made) as robot:
        stance.happen(robot, arguments.payload, arguments.move, arguments.lift)
        for fault in arguments.fault:
            robot.add_fault(fault)
        with sim_stance.Watch(robot, arguments.truth, arguments.json) as watch:
            return _run_to_the_end(arguments, robot, robot, watch.look)


def _run_to_the_end(
    arguments: argparse.Namespace, node: Node, robot: Robot | None = None, look: Callable[[], None] = lambda: None
) -> int:
    """robot: the node, where its limbs are a robot's. look: called often."""
    # Signals are caught before anyone can know that this command runs. Ctrl-C sets `ended` and raises nothing, because
    # Python may lose an exception that a handler raises inside an import.
    with ended_by_signal(signal.SIGTERM, signal.SIGINT) as ended:
        _say_ready(arguments, node)
        (_run_fast if arguments.fast else _run_in_real_time)(arguments, node, ended, look)
        node.stop()
        look()
        _say_end(arguments, node, robot)
    return EXIT_INTERRUPTED if ended.by == signal.SIGINT else EXIT_OK


# ------------------------------------------------------------------------------------------------ making


def _make_node(arguments: argparse.Namespace, made: Callable[[str, str], AnyNode]) -> AnyNode:
    """The node, by its CAN and Modbus URLs; a default port that is taken is left for any free one."""
    from brace.sim.node import PortBusy

    can = "slcan:pty" if arguments.can == "pty" else arguments.can or f"tcp://127.0.0.1:{CAN_PORT}"
    modbus = arguments.modbus or f"modbus-tcp://127.0.0.1:{MODBUS_PORT}"
    for _ in range(3):
        try:
            return made(can, modbus)
        except PortBusy as busy:
            if busy.url == can and arguments.can is None:
                _say_taken(busy.url)
                can = "tcp://127.0.0.1:0"
            elif busy.url.startswith("modbus-tcp:") and arguments.modbus is None:
                _say_taken(busy.url)
                modbus = "modbus-tcp://127.0.0.1:0"
            else:
                raise
    raise AssertionError("unreachable")


def _say_taken(url: str) -> None:
    common.say(f"note: {url} is taken, by another brace sim perhaps; a free port is used instead")


def _usual_posture(model: LimbModel) -> spec.Posture:
    """A leg half bent; a joint whose travel does not reach there stands in the middle of it."""
    angles = []
    for joint, usual_rad in (("femur", 1.0), ("tibia", 1.4)):
        low, high = (model.number(f"motor.{joint}.angle_{end}_rad") for end in ("min", "max"))
        angles.append(usual_rad if low <= usual_rad <= high else (low + high) / 2)
    return spec.Posture(angles[0], angles[1], 0.0)


def _alike(arguments: argparse.Namespace, model: LimbModel, plant: LimbModel) -> list[spec.OneLimb]:
    """--limbs of them."""
    first = arguments.posture[0] if arguments.posture else _usual_posture(model)
    base = arguments.node or int(model.number("controller.node_id")) or 1
    if base + arguments.limbs - 1 > 127:
        raise UsageError(
            f"no node numbers for {arguments.limbs} limbs from {base} on",
            why="CAN nodes are 1 to 127",
            next_step=f"--node {128 - arguments.limbs}",
        )
    theta_rad = (arguments.theta0, first.theta1_rad, first.theta2_rad)
    return [spec.OneLimb(model, plant, base + limb, theta_rad) for limb in range(arguments.limbs)]


def _setups(arguments: argparse.Namespace, limbs: Sequence[spec.OneLimb], modbus: str) -> list[LimbSetup]:
    from brace.sim.node import LimbSetup

    ports = _serial_ports(arguments.serial)
    setups = []
    for limb, one in enumerate(limbs):
        changes: dict[str, float] = {"controller.node_id": one.node}
        setup = LimbSetup(
            one.believed,
            one.plant,
            changes,
            theta_rad=one.theta_rad,
            hold_n_per_mm=arguments.contact,
            press_mm=arguments.press,
            press_y_mm=arguments.press_across,
            has_force_sensor=not arguments.no_force_sensor,
            has_link_encoder=arguments.link_encoders,
            nvm_path=_numbered(arguments.nvm, limb, arguments.limbs),
            console=_next_port(ports.get("console", "none"), limb),
            slcan_line=_next_port(ports.get("slcan", "none"), limb),
            servos=_with_baud(arguments.servos),
            servo_ids=arguments.servo_ids,
            servos_hold=arguments.servos_hold,
            key=key_of(arguments),
            owner_silence_s=0.0 if arguments.speed == 1.0 else OWNER_SILENCE_S * arguments.speed,
        )
        _give_modbus(setup, modbus, limb)
        setups.append(setup)
    return setups


def _with_baud(servos: str | None) -> str | None:
    """A device without a baud rate has the one that docs/joints.md sets the servos to."""
    return f"{servos}@3000000" if servos and servos.startswith("/") and "@" not in servos else servos


def _serial_ports(texts: list[str]) -> dict[str, str]:
    ports: dict[str, str] = {}
    for text in texts:
        name, equals, where = text.partition("=")
        if name not in ("console", "slcan") or not equals or not where:
            raise UsageError(
                f"--serial {text}: not a port",
                where="sim",
                why="the form is PORT=WHERE, PORT console or slcan (Modbus has --modbus)",
                next_step="--serial console=stderr",
            )
        ports[name] = where
    return ports


def _numbered(path: str | None, limb: int, limbs: int) -> str | None:
    """A file for each limb."""
    return path if path is None or limbs == 1 else f"{path}.{limb + 1}"


def _next_port(url: str, limb: int) -> str:
    """tcp://host:5000 is port 5000 for the first limb, 5001 for the second; port 0 stays any free one."""
    found = re.fullmatch(r"(.*tcp://.*:)(\d+)(/.*)?", url)
    if found is None or int(found[2]) == 0:
        return url
    return f"{found[1]}{int(found[2]) + limb}{found[3] or ''}"


def _give_modbus(setup: LimbSetup, url: str, limb: int) -> None:
    """Modbus URL to the limb's line or listener, and what it says of rate and address to its parameters."""
    if url == "none":
        return
    if url.startswith("modbus-tcp://"):
        place, _, unit = url[len("modbus-tcp://") :].partition("/")
        setup.modbus_tcp = _next_port(f"modbus-tcp://{place}", limb)
    elif url.startswith("modbus:"):
        found = re.fullmatch(r"modbus:(pty|/.*?)(?:@(\d+))?(?:/(\d+))?", url)
        place, baud, unit = (found[1], found[2], found[3] or "") if found else ("", None, "")
        setup.modbus_line = place + (f"@{baud}" if baud else "")
        if baud:
            setup.changes["controller.modbus_baud"] = int(baud)
    else:
        place = unit = ""
    if not place or (unit and not (unit.isdigit() and 1 <= int(unit) <= 247)):
        raise UsageError(
            f"--modbus {url}: not a Modbus URL",
            where="sim",
            why="the forms are modbus-tcp://HOST:PORT[/UNIT], modbus:pty, modbus:/dev/ttyX[@BAUD[/UNIT]], none",
            next_step=f"--modbus modbus-tcp://127.0.0.1:{MODBUS_PORT}/1",
        )
    if unit:
        setup.changes["controller.modbus_address"] = int(unit)


# ----------------------------------------------------------------------------------------------- running


def _run_fast(arguments: argparse.Namespace, node: Node, ended: Ended, look: Callable[[], None]) -> None:
    with common.progress("simulating", int(arguments.seconds)) as advance:
        done = 0.0
        while done < arguments.seconds and not ended.is_set():
            part = min(_FAST_SLICE_S, arguments.seconds - done)
            node.step(part)
            look()
            done += part
            advance(int(done))


def _run_in_real_time(arguments: argparse.Namespace, node: Node, ended: Ended, look: Callable[[], None]) -> None:
    from brace.sim.status import LiveLine

    line = LiveLine()
    try:
        node.start(arguments.seconds if arguments.seconds is not None else math.inf, arguments.speed)
        while not ended.is_set() and not node.wait(_POLL_S):
            look()
            if line.wanted:
                stats = node.stats()
                line.show(stats["time_us"] * 1e-6, [node.state(i) for i in range(arguments.limbs)], stats)
    finally:
        line.clear()


# ------------------------------------------------------------------------------------------------ saying


def _places(node: Node, limb: int) -> dict[str, str]:
    """Where clients connect, as the URLs that other commands take."""
    can = node.can_place
    if can.startswith("/"):
        can = f"slcan:{can}"
    places = {"can": can, "modbus_tcp": node.serial_place(limb, "modbus_tcp")}
    line = node.serial_place(limb, "modbus")
    places["modbus"] = f"modbus:{line}" if line else ""
    places["console"] = node.serial_place(limb, "console")
    places["slcan"] = node.serial_place(limb, "slcan")
    return {name: place for name, place in places.items() if place}


def _emit_now(text: str) -> None:
    """A line that whoever waits for it gets at once."""
    common.emit(text)
    if sys.stdout is not None:
        sys.stdout.flush()


def _emit_event(event: str, data: dict[str, object]) -> None:
    _emit_now(json.dumps(common.json_ready({"event": event, **data})))


def _say_ready(arguments: argparse.Namespace, node: Node) -> None:
    limbs: list[dict[str, object]] = [
        {
            "limb": limb + 1,
            **({"name": node.names[limb]} if node.names else {}),
            "node": node.state(limb)["node"],
            **_places(node, limb),
        }
        for limb in range(arguments.limbs)
    ]
    if arguments.json:
        _emit_event("ready", {"seed": arguments.seed, "limbs": limbs})
        return
    for entry in limbs:
        places = ", ".join(f"{name} {place}" for name, place in entry.items() if name not in ("limb", "name", "node"))
        called = f" ({entry['name']})" if node.names else ""
        _emit_now(f"limb {entry['limb']}{called}: node {entry['node']}, {places or 'no ports'}")


def _say_end(arguments: argparse.Namespace, node: Node, robot: Robot | None) -> None:
    from brace.sim.status import line_of

    states = [node.state(limb) for limb in range(arguments.limbs)]
    if arguments.json:
        entries = [{**state, "truth": node.truth(limb)} for limb, state in enumerate(states)]
        whole = {"truth": robot.robot_truth()} if robot else {}
        _emit_event("end", {"limbs": entries, **whole, **node.stats()})
        return
    for state in states:
        _emit_now(line_of(state))
    if robot:
        from brace.cli.sim_stance import end_lines

        for line in end_lines(robot.robot_truth()):
            _emit_now(line)

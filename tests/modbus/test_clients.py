"""Three independent clients against the simulated controller (TCP, RTU on a pty) and the firmware on emulated boards
(RTU on a pty): the same registers, the same K, the same refusals."""

from __future__ import annotations

import math
import time
import tomllib

import pytest
from clients import Client, Libmodbus, Place, Pymodbus, Refused
from values import MAP, PROJECT, block, enter, get, put, registers_of, store
from wire_by_hand import expected

from brace.wire.frames import DICTIONARY_HASH

F32 = 2e-6  # of the largest entry: what the core is held to
OWNED = 7  # negative acknowledge: somebody else owns what is asked for
LAST = "modbus_refused"
MEASURED_END = 2 + max(
    int(row["address"]) for row in MAP.values() if row["table"] == "input" and int(row["address"]) < 4096
)
END = 2 + max(int(row["address"]) for row in MAP.values() if row["table"] == "holding" and row["access"] == "rw")
POSTURE_RAD = (0.7, 1.1)


def wait_for_k(client: Client) -> dict[str, float]:
    """The whole block once K is valid: the first samples have to come in."""
    end = time.monotonic() + 10.0
    while True:
        values = block(client, "probe_f32", LAST)
        if values["k_is_valid"] == 1:
            return values
        assert time.monotonic() < end, f"no valid K within 10 s: {values}"


# First: an emulated board works as long as it is there, and the one of the tests below stays until the last of them.
def test_a_parameter_is_staged_committed_read_back_and_rolled_back(client_of_fresh_server: Client) -> None:
    client = client_of_fresh_server
    name, wanted = "geometry.tibia_mm", 231.25
    enter(client, "CONFIGURATION")
    before, crc = get(client, name), get(client, "parameter_crc")
    with pytest.raises(Refused) as refused:
        put(client, name, -1.0)
    assert refused.value.code == 3
    put(client, name, wanted)
    assert get(client, name) == wanted and get(client, "parameter_crc") == crc
    store(client, "commit")
    assert get(client, name) == wanted
    enter(client, "MONITOR")
    values = wait_for_k(client)
    assert values["parameter_crc"] != crc and get(client, name) == wanted
    enter(client, "CONFIGURATION")
    store(client, "rollback")
    assert get(client, name) == before
    enter(client, "MONITOR")
    assert wait_for_k(client)["parameter_crc"] == crc


def version() -> str:
    """The project's."""
    text = (PROJECT / "tools/pyproject.toml").read_text()
    return str(tomllib.loads(text)["project"]["version"])


def test_probes_report_the_word_order(client: Client) -> None:
    assert client.read("input", 0, 4) == [0x4640, 0xE600, 0x0102, 0x0304]
    assert get(client, "probe_f32") == 12345.5 and get(client, "probe_u32") == 0x01020304
    assert get(client, "dictionary_hash") == DICTIONARY_HASH


def test_k_is_the_paper_limbs(client: Client) -> None:
    values = wait_for_k(client)
    assert len(values) == 58 and values["mode"] == 1
    k = expected(values["theta1"], values["theta2"])
    for name, true in (("k_xx", k.xx), ("k_xz", k.xz), ("k_zz", k.zz), ("lambda_min", k.low), ("lambda_max", k.high)):
        assert abs(values[name] - true) <= F32 * k.high, (name, values[name], true)
    turn = (values["stiff_axis"] - k.axis + math.pi / 2) % math.pi - math.pi / 2
    assert abs(turn) <= 2 * F32 * k.high / (k.high - k.low) + 1e-6


def test_each_block_is_a_later_snapshot(client: Client) -> None:
    first, second = (block(client, "sequence", "lambda_max") for _ in range(2))
    assert 0 < second["sequence"] - first["sequence"] < 1e6
    for values in (first, second):
        assert 0 <= values["age_us"] < 1e6


def test_refusals(client: Client) -> None:
    for table, address, count in (("input", MEASURED_END - 1, 2), ("input", MEASURED_END, 2), ("input", 5000, 1),
                                  ("holding", END, 2)):
        with pytest.raises(Refused) as refused:
            client.read(table, address, count)
        assert refused.value.code == 2, (table, address, count)
    wanted = {
        1: ("geometry.tibia_mm", 200.0),  # not in CONFIGURATION: the server is in the wrong state
        2: (None, 0),
        3: ("set_mode", 1),  # without its key
    }
    for code, (name, value) in wanted.items():
        with pytest.raises(Refused) as refused:
            put(client, name, value) if name else client.write(999, [0, 0])
        assert refused.value.code == code, name


def test_k_at_a_posture(client: Client) -> None:
    asked = [register for angle in POSTURE_RAD for register in registers_of(angle, "f32")]
    client.write(int(MAP["asked_theta1"]["address"]), asked)
    answered = block(client, "asked_k_xx", "asked_flags")
    k = expected(*POSTURE_RAD)
    for name, true in (("k_xx", k.xx), ("k_xz", k.xz), ("k_zz", k.zz), ("lambda_min", k.low), ("lambda_max", k.high)):
        assert abs(answered[f"asked_{name}"] - true) <= F32 * k.high, name
    assert answered["asked_flags"] == 0


def ask(client: Client, first: str, *values: float, kinds: str = "") -> None:
    words = [w for value, kind in zip(values, kinds or "f" * len(values))
             for w in registers_of(value, "f32" if kind == "f" else "u32")]
    client.write(int(MAP[first]["address"]), words)


def test_k_at_a_tip_position(client: Client) -> None:
    theta1, theta2 = POSTURE_RAD
    x = 185.0 * math.cos(theta1) + 313.5 * math.cos(theta1 - theta2)
    z = 185.0 * math.sin(theta1) + 313.5 * math.sin(theta1 - theta2)
    ask(client, "asked_tip_x", x, z, 0, kinds="ffu")
    answered, k = block(client, "asked_k_xx", "asked_flags"), expected(theta1, theta2)
    for name, true in (("k_xx", k.xx), ("k_xz", k.xz), ("k_zz", k.zz), ("lambda_min", k.low), ("lambda_max", k.high)):
        assert abs(answered[f"asked_{name}"] - true) <= 1e-4 * k.high, name
    with pytest.raises(Refused) as refused:
        ask(client, "asked_tip_x", 5000.0, 0.0, 0, kinds="ffu")
    assert refused.value.code == 3


def test_contact_force_and_sag_undo_each_other(client: Client) -> None:
    measured = block(client, "k_xx", "k_zz")
    ask(client, "asked_dx", 0.2, -0.4)
    force = block(client, "asked_force_x", "asked_force_high")
    assert abs(force["asked_force_x"] - (0.2 * measured["k_xx"] - 0.4 * measured["k_xz"])) < 0.02
    assert abs(force["asked_force_z"] - (0.2 * measured["k_xz"] - 0.4 * measured["k_zz"])) < 0.02
    size = math.hypot(force["asked_force_x"], force["asked_force_z"])
    assert force["asked_force_low"] <= size <= force["asked_force_high"]
    ask(client, "asked_load_x", force["asked_force_x"], force["asked_force_z"])
    sag = block(client, "asked_sag_x", "asked_sag_z")
    assert abs(sag["asked_sag_x"] - 0.2) < 5e-3 and abs(sag["asked_sag_z"] + 0.4) < 5e-3


def test_friction_margin_is_of_the_force_that_is_reported(client: Client) -> None:
    reported = block(client, "force_x", "force_z")
    if any(math.isnan(value) for value in reported.values()):
        with pytest.raises(Refused) as refused:
            ask(client, "asked_normal", math.pi / 2, 0.5)
        assert refused.value.code == 4
        return
    ask(client, "asked_normal", math.pi / 2, 0.5)
    answered = block(client, "asked_margin", "asked_contact")
    assert abs(answered["asked_margin"] - (0.5 * reported["force_z"] - abs(reported["force_x"]))) < 0.5
    assert answered["asked_contact"] in (0, 1, 2)


@pytest.mark.parametrize("kind", [Libmodbus, Pymodbus])
def test_who_answers(place: Place, kind: type[Libmodbus] | type[Pymodbus]) -> None:
    client = kind(place)
    try:
        reported = client.server_id()
        words = f"Brace {version()} dictionary {DICTIONARY_HASH:08x}".encode()
        if isinstance(client, Libmodbus):
            assert reported == b"\xb2\xff" + words
            for half, word in enumerate(registers_of(0xC0DE0002, "u32")):  # function 06: a value in two halves
                client.write_one(int(MAP["set_mode"]["address"]) + half, word)
            enter(client, "CONFIGURATION")
            enter(client, "MONITOR")
        else:
            assert reported == (b"\xb2\xff" + words)[:-1]  # it takes the last byte for the run indicator
            assert client.device_id() == {0: b"Brace", 1: b"limb controller", 2: version().encode()}
    finally:
        client.close()


def test_halves_of_two_masters_do_not_mix(place: Place) -> None:
    """Function 06 writes a value in two requests; another connection's requests between them are refused, and no part of
    it: whoever has entered CONFIGURATION writes."""
    if not place.host:
        pytest.skip("a serial line has one master")
    name, wanted = "geometry.tibia_mm", (231.25, 199.9)
    address = int(MAP[name]["address"])
    masters = (Libmodbus(place), Libmodbus(place))
    try:
        enter(masters[0], "CONFIGURATION")
        for master, value in zip(masters, wanted):
            master.write_one(address, registers_of(value, "f32")[0])
        masters[0].write_one(address + 1, registers_of(wanted[0], "f32")[1])
        with pytest.raises(Refused) as refused:
            masters[1].write_one(address + 1, registers_of(wanted[1], "f32")[1])
        assert refused.value.code == OWNED
        assert get(masters[0], name) == pytest.approx(wanted[0], rel=1e-6)
        enter(masters[0], "MONITOR")
    finally:
        for master in masters:
            master.close()

"""The CAN entries on the register model of bxCAN: judged against our reading of the manual, not against silicon."""

from __future__ import annotations

import random
import struct
from itertools import count

import pytest

from bxcan_model import Frame
from silicon import Maker, Silicon

LINE_OF_NMI = 200  # no interrupt has this number: the model takes them at any instruction, as the processor an NMI
OK, AGAIN, UNSUPPORTED, RANGE, DEVICE, BUS_OFF = 0, -1, -2, -3, -4, -5


def send(chip: Silicon, frame: Frame, length: int | None = None, fd: bool = False) -> int:
    size = len(frame.data) if length is None else length
    chip.chip.put("frame", struct.pack("<IBB64s", frame.id, size, fd, frame.data.ljust(64, b"\x5a")))
    return chip.send_frame()


def receive(chip: Silicon) -> Frame | None:
    chip.chip.put("frame", b"\xee" * 72)
    if chip.receive_frame() == 0:
        return None
    identifier, length, fd, data = struct.unpack("<IBB64s", chip.chip.get("frame", 70))
    assert not fd
    return Frame(identifier, data[:length])


def receive_all(chip: Silicon) -> list[Frame]:
    frames: list[Frame] = []
    while (frame := receive(chip)) is not None and len(frames) < 1000:
        frames.append(frame)
    return frames


def health(chip: Silicon) -> tuple[int, int, bool, bool, int]:
    """tx errors, rx errors, error passive, bus off, frames lost."""
    assert chip.read_health() == OK
    return struct.unpack("<BB??I", chip.chip.get("health", 8))


def random_frame(source: random.Random, identifiers: int = 0x800) -> Frame:
    return Frame(source.randrange(identifiers), source.randbytes(source.randrange(9)))


def joined(silicon: Maker, bit_rate: int = 500_000, seed: int = 0, listen_only: bool = False) -> Silicon:
    chip = silicon(seed=seed)
    chip.bus.bit_rate = bit_rate
    chip.start()
    assert chip.setup_can(bit_rate, 0, listen_only, 0) == OK
    chip.chip.wait_us(11e6 / bit_rate + 1)
    return chip


# --- setting up


@pytest.mark.parametrize(
    "bit_rate, sample_point", [(125_000, 0.875), (250_000, 0.875), (500_000, 6 / 7), (1_000_000, 6 / 7)]
)
def test_bit_timing(silicon: Maker, bit_rate: int, sample_point: float) -> None:
    chip = joined(silicon, bit_rate)
    assert chip.can.bit_rate() == bit_rate
    assert chip.can.sample_point() == pytest.approx(sample_point)
    jump = (chip.can.btr >> 24 & 3) + 1
    assert 1 <= jump <= chip.can.quanta()[2]  # no longer than the segment it shortens
    assert 8 <= sum(chip.can.quanta()[1:]) + 1 <= 25


def test_pins_are_given_to_can(silicon: Maker) -> None:
    chip = joined(silicon)
    assert chip.ports["B"].function(8) == chip.ports["B"].function(9) == 9
    assert chip.rcc.enabled(0x30, 1)


@pytest.mark.parametrize("bit_rate", [0, 83_333, 800_001, 2_000_000, 4_000_000_000])
def test_bit_rates_it_can_not_make_are_refused(silicon: Maker, bit_rate: int) -> None:
    chip = silicon()
    chip.start()
    assert chip.setup_can(bit_rate, 0, 0, 0) == RANGE
    assert chip.setup_can(500_000, 2_000_000, 0, 0) == UNSUPPORTED


def test_board_without_pins_has_no_can(silicon: Maker) -> None:
    chip = silicon()
    chip.start("board_without_can")
    assert chip.has_can() == 0
    chip = silicon()
    chip.start()
    assert chip.has_can() == 1


def test_before_setup_nothing_goes(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    assert send(chip, Frame(1, b"")) == UNSUPPORTED
    assert chip.receive_frame() == chip.read_health() == chip.recover() == UNSUPPORTED


def test_controller_that_never_acknowledges_is_refused_in_time(silicon: Maker) -> None:
    chip = silicon()
    chip.can.obeys = False
    chip.start()
    before = chip.chip.time_us
    assert chip.setup_can(500_000, 0, 0, 0) == DEVICE
    assert chip.chip.time_us - before <= 1_000
    assert send(chip, Frame(1, b"")) == UNSUPPORTED


def test_counter_that_stands_still_does_not_hang_it(silicon: Maker) -> None:
    chip = silicon()
    chip.can.obeys = False
    chip.start()
    chip.timer.running = False
    chip.chip.interrupts_on = False
    assert chip.setup_can(500_000, 0, 0, 0) == DEVICE


def test_on_a_bus_held_dominant_it_waits_off_the_bus_until_the_bus_is_free(silicon: Maker) -> None:
    chip = silicon()
    chip.bus.dominant = True
    chip.start()
    before = chip.chip.time_us
    assert chip.setup_can(500_000, 0, 0, 0) == OK
    assert chip.chip.time_us - before <= 1_000
    chip.chip.wait_us(50_000)
    assert health(chip)[3] and send(chip, Frame(1, b"")) == AGAIN
    chip.bus.dominant = False
    chip.chip.wait_us(100)
    assert not health(chip)[3] and send(chip, Frame(1, b"")) == OK


@pytest.mark.parametrize("filter_id, filter_mask", [(0x605, 0x7FF), (0x600, 0x780), (0x7FF, 0), (0, 0x7FF)])
def test_only_frames_that_the_filter_passes_take_room(silicon: Maker, filter_id: int, filter_mask: int) -> None:
    chip, source = silicon(), random.Random(filter_id)
    chip.start()
    assert chip.setup_can_for(500_000, filter_id, filter_mask) == OK
    chip.chip.wait_us(30)
    frames = [random_frame(source) for _ in range(300)]
    frames += [Frame((filter_id & filter_mask) | (source.randrange(0x800) & ~filter_mask), b"x") for _ in range(20)]
    source.shuffle(frames)
    heard = []
    for frame in frames:
        chip.can.arriving.append(frame)
        chip.chip.wait_us(300)
        heard += receive_all(chip)
    assert heard == [frame for frame in frames if (frame.id ^ filter_id) & filter_mask == 0]


@pytest.mark.parametrize("filter_id, filter_mask", [(0x605, 0x7FF), (0, 0)])
def test_an_urgent_frame_waits_in_no_ring_and_is_given_first(silicon: Maker, filter_id: int, filter_mask: int) -> None:
    chip = silicon()
    chip.start()
    assert chip.setup_can_urgent(filter_id, filter_mask, 0x001) == OK
    chip.chip.wait_us(30)
    requests = [Frame(0x605, bytes([number])) for number in range(70)]
    chip.can.arriving.extend([*requests, *[Frame(0x001, b"")] * 5, Frame(0x001, b"", remote=True), Frame(0x002, b"")])
    chip.chip.wait_us(20_000)
    heard = receive_all(chip)
    assert heard == [Frame(0x001, b"")] * 3 + requests[:64]
    assert health(chip)[4] == 70 - 64 + (filter_mask == 0)  # no urgent one is among the lost
    chip.can.arriving.append(Frame(0x001, b"\x07" * 8))
    chip.chip.wait_us(1_000)
    assert receive_all(chip) == [Frame(0x001, b"\x07" * 8)]


def test_without_an_urgent_identifier_none_passes(silicon: Maker) -> None:
    chip = silicon()
    chip.start()
    assert chip.setup_can_urgent(0x605, 0x7FF, 0) == OK
    chip.chip.wait_us(30)
    chip.can.arriving.extend([Frame(0x000, b""), Frame(0x001, b"")])
    chip.chip.wait_us(1_000)
    assert receive_all(chip) == []


def test_without_crystal_it_only_listens(silicon: Maker) -> None:
    chip = silicon(crystal_hz=None)
    chip.start()
    assert chip.setup_can(500_000, 0, 0, 0) == DEVICE
    assert chip.setup_can(500_000, 0, 1, 0) == OK
    assert chip.can.bit_rate() == 500_000


def test_on_16_mhz_the_timing_is_exact_too(silicon: Maker) -> None:
    chip = silicon(pll_locks=False)
    chip.start()
    for bit_rate in (125_000, 250_000, 500_000, 1_000_000):
        assert chip.setup_can(bit_rate, 0, 1, 0) == OK
        assert (chip.can.bit_rate(), chip.can.sample_point()) == (bit_rate, 0.875)


# --- traffic


def test_hundreds_of_frames_out_in_the_order_they_were_sent(silicon: Maker) -> None:
    chip, source = joined(silicon), random.Random(1)
    wanted = [random_frame(source, identifiers=8 if i % 2 else 0x800) for i in range(300)]
    full = 0
    for frame in wanted:
        while (answer := send(chip, frame)) == AGAIN:
            full += 1
            chip.chip.wait_us(source.uniform(10, 400))
        assert answer == OK
    chip.chip.wait_us(2000)
    assert chip.bus.seen == wanted
    assert full > 100  # the mailboxes were the bottleneck


def test_hundreds_of_frames_in_whole_and_in_order(silicon: Maker) -> None:
    chip, source = joined(silicon, seed=2), random.Random(2)
    wanted, got = [], []
    for _ in range(40):
        burst = [random_frame(source) for _ in range(source.randrange(20))]
        for frame in burst:
            chip.can.arriving.append(frame)
            wanted.append(frame)
            if source.random() < 0.3:  # not for us: extended, remote
                chip.can.arriving.append(Frame(source.randrange(1 << 29), b"\x01", extended=True))
                chip.can.arriving.append(Frame(frame.id, b"", remote=True))
        chip.chip.wait_us(source.uniform(0, 6000))
        got += receive_all(chip)
    chip.chip.wait_us(20_000)
    got += receive_all(chip)
    assert len(wanted) > 300
    assert got == wanted
    assert health(chip)[4] == 0
    assert chip.bus.acknowledged_by_chip >= len(wanted)


def test_interrupts_at_any_instruction_lose_and_swap_nothing(silicon: Maker) -> None:
    """Frames keep coming while the thread receives and sends: the handler runs between any two instructions."""
    chip, source = joined(silicon, bit_rate=1_000_000, seed=3), random.Random(3)
    wanted = [random_frame(source) for _ in range(400)]
    chip.can.arriving.extend(wanted)
    got: list[Frame] = []
    sent: list[Frame] = []
    for _ in range(3000):
        before = chip.chip.interrupts_taken
        chip.chip.pass_us(source.uniform(0, 60))  # time without a look at the interrupts: they come during the calls
        frame = random_frame(source)
        if source.random() < 0.1 and send(chip, frame) == OK:
            sent.append(frame)
        if (heard := receive(chip)) is not None:
            got.append(heard)
        assert chip.chip.interrupts_taken - before <= 8
        if len(got) == len(wanted):
            break
    chip.chip.wait_us(2000)
    assert got == wanted
    assert chip.bus.seen == sent and len(sent) > 50


def test_length_beyond_eight_is_eight(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.can.arriving.append(Frame(5, b"12345678", dlc=15))
    chip.chip.wait_us(1000)
    assert receive(chip) == Frame(5, b"12345678")


def test_mailboxes_full_answers_again_until_one_is_free(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.bus.answers = False
    frames = [Frame(9, bytes([i])) for i in range(4)]
    assert [send(chip, frame) for frame in frames] == [OK, OK, OK, AGAIN]
    chip.chip.wait_us(5000)
    assert send(chip, frames[3]) == AGAIN
    chip.bus.answers = True
    chip.chip.wait_us(400)
    assert send(chip, frames[3]) == OK
    chip.chip.wait_us(2000)
    assert chip.bus.seen == frames


def test_arguments_out_of_range(silicon: Maker) -> None:
    chip = joined(silicon)
    assert send(chip, Frame(0x800, b"")) == RANGE
    assert send(chip, Frame(1, b""), length=9) == RANGE
    assert send(chip, Frame(1, b""), fd=True) == UNSUPPORTED
    chip.chip.wait_us(1000)
    assert chip.bus.seen == []


# --- loss


def test_fifo_overrun_is_counted_and_the_oldest_are_kept(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.chip.interrupts_on = False
    chip.can.arriving.extend(Frame(i, b"") for i in range(5))
    chip.chip.wait_us(2000)
    chip.chip.interrupts_on = True
    chip.chip.serve_interrupts()
    assert [receive(chip) for _ in range(4)] == [Frame(0, b""), Frame(1, b""), Frame(2, b""), None]
    assert health(chip)[4] >= 1


def test_ring_full_is_counted_frame_by_frame(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.can.arriving.extend(Frame(i, b"") for i in range(70))
    chip.chip.wait_us(20_000)
    assert health(chip)[4] == 6
    assert [receive(chip) for _ in range(64)] == [Frame(i, b"") for i in range(64)]
    assert receive(chip) is None


# --- errors and bus-off


def test_error_counters_and_error_passive(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.can.tec, chip.can.rec = 100, 27
    assert health(chip) == (100, 27, False, False, 0)
    chip.can.rec = 130
    assert health(chip) == (100, 130, True, False, 0)


def test_alone_on_the_bus_is_error_passive_and_never_bus_off(silicon: Maker) -> None:
    chip = joined(silicon)
    chip.bus.answers = False
    assert send(chip, Frame(1, b"x")) == OK
    chip.chip.wait_us(200_000)
    tx_errors, _, passive, off, _ = health(chip)
    assert (tx_errors, passive, off) == (128, True, False)


@pytest.mark.parametrize("waiting", [1, 3])
def test_what_nobody_took_is_not_received_later(silicon: Maker, waiting: int) -> None:
    """A K that has waited for somebody to come onto the bus carries the age that it had when it was sent."""
    chip = joined(silicon)
    chip.bus.answers = False
    for i in range(waiting):
        assert send(chip, Frame(0x180 + i, b"old")) == OK
    for _ in range(9):  # as long as a busy bus may take
        chip.chip.wait_us(10_000)
        health(chip)
    chip.chip.wait_us(5_000)
    assert sum(box.pending for box in chip.can.mailboxes) == waiting
    for _ in range(3):
        chip.chip.wait_us(10_000)
        health(chip)
    chip.bus.answers = True
    chip.chip.wait_us(5_000)
    assert chip.bus.seen == []
    assert send(chip, Frame(0x181, b"new")) == OK
    chip.chip.wait_us(5_000)
    assert chip.bus.seen == [Frame(0x181, b"new")]


def drive_off(chip: Silicon) -> None:
    chip.bus.spoils = True
    for i in range(3):
        assert send(chip, Frame(0x100 + i, b"stale")) == OK
    chip.chip.wait_us(20_000)
    assert health(chip)[3]
    assert send(chip, Frame(1, b"")) == BUS_OFF


@pytest.mark.parametrize("acknowledge_after_us", [0.0, 30.0, 900.0])
def test_bus_off_stays_until_recovered_and_stale_frames_are_forgotten(silicon: Maker,
                                                                      acknowledge_after_us: float) -> None:
    chip = joined(silicon)
    drive_off(chip)
    chip.chip.wait_us(50_000)
    assert health(chip)[3]  # does not come back alone
    chip.bus.spoils = False
    chip.can.acknowledge_after_us = acknowledge_after_us
    before = chip.chip.time_us
    assert chip.recover() == OK
    assert chip.chip.time_us - before <= 100  # does not wait for it
    came_back_us = 0.0
    for _ in range(40):
        chip.chip.wait_us(200)
        if not health(chip)[3]:
            came_back_us = chip.chip.time_us - before
            break
        assert send(chip, Frame(1, b"")) == BUS_OFF
    bits_us = 128 * 11 / 0.5
    assert bits_us <= came_back_us <= bits_us + acknowledge_after_us + 600
    assert send(chip, Frame(2, b"fresh")) == OK
    chip.can.arriving.append(Frame(3, b"in"))
    chip.chip.wait_us(2000)
    assert chip.bus.seen == [Frame(2, b"fresh")]
    assert receive(chip) == Frame(3, b"in")


def test_recover_without_need_changes_nothing(silicon: Maker) -> None:
    chip = joined(silicon)
    assert send(chip, Frame(1, b"a")) == OK
    assert chip.recover() == OK
    chip.chip.wait_us(1000)
    assert chip.bus.seen == [Frame(1, b"a")]


def test_setup_again_also_comes_back_from_bus_off(silicon: Maker) -> None:
    chip = joined(silicon)
    drive_off(chip)
    chip.bus.spoils = False
    assert chip.setup_can(500_000, 0, 0, 0) == OK
    chip.chip.wait_us(30)
    assert send(chip, Frame(7, b"")) == OK
    chip.chip.wait_us(1000)
    assert chip.bus.seen == [Frame(7, b"")]


# --- silent ways


def test_listening_only_it_hears_and_leaves_no_trace(silicon: Maker) -> None:
    chip = joined(silicon, listen_only=True)
    assert send(chip, Frame(1, b"")) == UNSUPPORTED
    chip.can.arriving.extend(Frame(i, b"q") for i in range(10))
    chip.chip.wait_us(5000)
    assert [receive(chip) for _ in range(10)] == [Frame(i, b"q") for i in range(10)]
    assert chip.bus.seen == [] and chip.bus.acknowledged_by_chip == 0


def test_loopback_hears_itself_and_the_bus_nothing(silicon: Maker) -> None:
    chip = silicon()
    chip.bus.answers = False
    chip.start()
    assert chip.setup_can(500_000, 0, 0, 1) == OK
    chip.chip.wait_us(30)
    chip.can.arriving.append(Frame(0x7FF, b"of the bus"[:8]))
    assert send(chip, Frame(0x123, b"itself")) == OK
    chip.chip.wait_us(2000)
    assert receive(chip) == Frame(0x123, b"itself")
    assert receive(chip) is None
    assert chip.bus.seen == [] and health(chip)[0] == 0


# --- the crystal stops


def test_without_its_crystal_the_controller_is_off_the_bus_and_says_so(silicon: Maker) -> None:
    chip = joined(silicon)
    assert send(chip, Frame(0x181, b"before")) == OK
    chip.chip.wait_us(2000)
    sent = len(chip.bus.seen)
    chip.lose_crystal()
    assert send(chip, Frame(0x181, b"after")) == BUS_OFF
    assert health(chip)[3]
    assert chip.recover() == DEVICE
    chip.chip.wait_us(50_000)
    assert len(chip.bus.seen) == sent
    assert chip.setup_can(500_000, 0, 0, 0) == DEVICE  # an inexact clock disturbs the bus
    assert chip.setup_can(500_000, 0, 1, 0) == OK  # it may listen


def test_a_controller_that_listens_goes_on_listening_without_the_crystal(silicon: Maker) -> None:
    chip = joined(silicon, listen_only=True)
    chip.lose_crystal()
    chip.can.arriving.append(Frame(0x123, b"heard"))
    chip.chip.wait_us(2000)
    assert receive(chip) == Frame(0x123, b"heard")


def lost_after(chip: Silicon, instructions: int) -> None:
    """Makes the crystal stop in the next call, after this number of instructions."""
    chip.chip.slice = (1, 1)
    looks = count()
    chip.chip.lines[LINE_OF_NMI] = (lambda: next(looks) == instructions and chip.rcc.crystal_stops(), "nmi_handler")
    chip.chip.nvic.enabled.add(LINE_OF_NMI)


@pytest.mark.parametrize("instructions", [*range(0, 400, 8), *range(400, 2000, 50)])
def test_a_crystal_lost_while_the_bus_is_set_up_leaves_it_alone(silicon: Maker, instructions: int) -> None:
    """A set-up that says OK has a crystal, and nothing is sent with another clock."""
    chip = silicon()
    chip.start()
    lost_after(chip, instructions)
    if (answer := chip.setup_can(500_000, 0, 0, 0)) == OK:
        chip.lose_crystal()
    assert answer in (OK, DEVICE)
    chip.chip.wait_us(5000)
    send(chip, Frame(0x181, b"late"))
    chip.chip.wait_us(5000)
    assert chip.bus.seen == [] and not chip.can.on_bus()


@pytest.mark.parametrize("instructions", range(60))
@pytest.mark.parametrize("waited_us", [0, 5000])
def test_a_crystal_lost_on_the_way_back_from_bus_off_leaves_the_bus_alone(
    silicon: Maker, instructions: int, waited_us: int
) -> None:
    """Where the way back is asked for, and where it is finished."""
    chip = joined(silicon)
    chip.bus.spoils = True
    assert send(chip, Frame(0x181, b"spoilt")) == OK
    chip.chip.wait_us(100_000)
    assert health(chip)[3]
    chip.bus.spoils = False
    if waited_us:
        assert chip.recover() == OK
        chip.chip.wait_us(waited_us)
    lost_after(chip, instructions)
    chip.recover()
    chip.chip.wait_us(50_000)
    send(chip, Frame(0x181, b"late"))
    chip.chip.wait_us(50_000)
    assert chip.bus.seen == [] and not chip.can.on_bus() and health(chip)[3]

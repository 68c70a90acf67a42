"""bxCAN 1 as RM0090 chapter 32 describes it, and the bus it hangs on.

Frame level: a frame takes 47 + 8 n bit times (no stuff bits). What the manual leaves to write-protection is noted in
`Chip.violations` when it is tried. Not modelled: CAN 2, time triggered mode, sleep on the bus, interrupts of FIFO 1.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field

from chip import Chip
from clock_model import Rcc

RX0_INTERRUPT = 20
FIFO_DEPTH = 3
BUS_OFF_BITS = 128 * 11


@dataclass(frozen=True)
class Frame:
    id: int
    data: bytes
    extended: bool = False
    remote: bool = False
    dlc: int | None = None  # as sent, when more than the data

    @property
    def bits(self) -> int:
        return 47 + 8 * len(self.data) + (20 if self.extended else 0)


@dataclass
class Bus:
    """The other nodes: what they send, what they saw, and how they treat the chip's frames."""

    bit_rate: int = 500_000
    seen: list[Frame] = field(default_factory=list)
    answers: bool = True  # somebody acknowledges
    spoils: bool = False  # every frame of the chip ends in an error
    dominant: bool = False  # shorted
    acknowledged_by_chip: int = 0


class Mailbox:
    def __init__(self) -> None:
        self.words = [0, 0, 0, 0]  # TIR, TDTR, TDLR, TDHR
        self.pending = False
        self.asked = 0  # place in the order of requests

    def frame(self) -> Frame:
        identifier, length = self.words[0], min(self.words[1] & 0xF, 8)
        extended = bool(identifier >> 2 & 1)
        data = b"".join(word.to_bytes(4, "little") for word in self.words[2:])[:length]
        return Frame(identifier >> 3 if extended else identifier >> 21, data, extended, bool(identifier >> 1 & 1))


class Fifo:
    def __init__(self) -> None:
        self.frames: deque[Frame] = deque()
        self.full = self.overrun = False
        self.releasing = 0


class Bxcan:
    BASE = 0x40006400

    def __init__(self, chip: Chip, rcc: Rcc, bus: Bus) -> None:
        self.chip, self.rcc, self.bus = chip, rcc, bus
        self.obeys = True  # False: never acknowledges anything
        self.acknowledge_after_us = 30.0  # the rest of a frame on the bus
        self.release_reads = 2  # polls until RFOM0 has been taken
        self.requests = 0
        self.reset()
        chip.models[self.BASE] = self
        rcc.on_reset[0x20, 25] = self.reset
        chip.waiting.append(self.advance)
        chip.lines[RX0_INTERRUPT] = (self.rx0_asks, "can1_rx0_handler")

    def reset(self) -> None:
        self.mcr, self.btr, self.ier, self.fmr = 0x00010002, 0x01230000, 0, 0x2A1C0E01
        self.init, self.asleep = False, True
        self.mailboxes = [Mailbox() for _ in range(3)]
        self.tsr_done = 0  # RQCP, TXOK, ALST, TERR
        self.fifos = [Fifo(), Fifo()]
        self.tec = self.rec = 0
        self.bus_off = False
        self.recessive_bits_left = 0.0  # of the way back from bus-off
        self.change_us = 0.0  # until a request of initialisation is acknowledged
        self.leave_us = 0.0
        self.filters = {offset: 0 for offset in (0x204, 0x20C, 0x214, 0x21C)}
        self.banks = [[0, 0] for _ in range(28)]
        self.arriving: deque[Frame] = deque()
        self.credit_us = 0.0
        self.retrying: Mailbox | None = None

    # --- timing

    def clock_hz(self) -> float:
        return self.rcc.clocks()["apb1"]

    def quanta(self) -> tuple[int, int, int]:
        """Prescaler, TS1 and TS2 in quanta: RM0090 32.7.7, BTR holds each minus one."""
        return (self.btr & 0x3FF) + 1, (self.btr >> 16 & 0xF) + 1, (self.btr >> 20 & 7) + 1

    def bit_rate(self) -> float:
        prescaler, before, after = self.quanta()
        return self.clock_hz() / prescaler / (1 + before + after)

    def sample_point(self) -> float:
        _, before, after = self.quanta()
        return (1 + before) / (1 + before + after)

    # --- modes

    def silent(self) -> bool:
        return bool(self.btr >> 31)

    def loopback(self) -> bool:
        return bool(self.btr >> 30 & 1)

    def on_bus(self) -> bool:
        return not (self.init or self.asleep or self.bus_off)

    def advance(self, microseconds: float) -> None:
        if not self.rcc.enabled(0x40, 25) or not self.obeys:
            return
        self._change_mode(microseconds)
        if self.bus_off and not self.init and self.recessive_bits_left > 0 and not self.bus.dominant:
            self.recessive_bits_left -= microseconds * self.bus.bit_rate / 1e6
            if self.recessive_bits_left <= 0:
                self.bus_off, self.tec, self.rec = False, 0, 0
        self._traffic(microseconds)

    def _change_mode(self, microseconds: float) -> None:
        wants_init, wants_sleep = bool(self.mcr & 1), bool(self.mcr & 2)
        if wants_init and not self.init:
            self.change_us -= microseconds
            if self.change_us <= 0:
                self.init, self.asleep, self.leave_us = True, False, 0.0
        elif self.init and not wants_init and not self.bus.dominant:
            self.leave_us += microseconds
            if self.leave_us >= 11e6 / self.bit_rate():
                self.init = False
        elif self.asleep and not wants_sleep and not wants_init:
            self.asleep = False

    def _traffic(self, microseconds: float) -> None:
        """One frame after the other on the bus, ours and theirs, as time goes by; ours first when both wait."""
        if not self.on_bus() and not self.arriving:
            self.credit_us = 0.0
            return
        self.credit_us += microseconds
        for _ in range(1000):
            ours = self._next_mailbox() if self.on_bus() and (self.loopback() or not self.silent()) else None
            if ours is None and not self.arriving:
                self.credit_us = 0.0
                return
            frame = ours.frame() if ours else self.arriving[0]
            rate = self.bit_rate() if ours else self.bus.bit_rate
            if self.credit_us < frame.bits / rate * 1e6:
                return
            self.credit_us -= frame.bits / rate * 1e6
            if ours:
                self._send(ours, frame)
            else:
                self._hear(self.arriving.popleft())
        raise AssertionError("a frame that takes no time")

    # --- sending

    def _next_mailbox(self) -> Mailbox | None:
        pending = [box for box in self.mailboxes if box.pending]
        if self.retrying in pending:
            return self.retrying
        if self.mcr >> 2 & 1:  # TXFP: in the order of the requests
            return min(pending, key=lambda box: box.asked, default=None)
        return min(pending, key=lambda box: (box.words[0] >> 21, self.mailboxes.index(box)), default=None)

    def _send(self, box: Mailbox, frame: Frame) -> None:
        on_the_line = not self.silent()
        if on_the_line and self.bus.spoils or on_the_line and self.bus.dominant:
            self._transmit_error(8)
            return
        if on_the_line and not self.bus.answers and not self.loopback():
            if self.tec < 128:  # an error-passive node does not count missing acknowledgement
                self._transmit_error(8)
            return
        box.pending = False
        index = self.mailboxes.index(box)
        self.tsr_done |= 3 << 8 * index
        self.tec = max(self.tec - 1, 0)
        if on_the_line:
            self.bus.seen.append(frame)
        if self.loopback():
            self._accept(frame)

    def _transmit_error(self, count: int) -> None:
        self.tec += count
        if self.tec > 255:
            self.bus_off, self.tec, self.recessive_bits_left = True, 0, 0.0
            if self.mcr >> 6 & 1:
                self.recessive_bits_left = BUS_OFF_BITS

    def count_receive_errors(self, count: int) -> None:
        self.rec = min(self.rec + count, 255)

    # --- receiving

    def _hear(self, frame: Frame) -> None:
        if not self.on_bus() or self.loopback():
            return
        if abs(self.bit_rate() / self.bus.bit_rate - 1) > 0.005:
            self.count_receive_errors(1)
            return
        self.rec = max(self.rec - 1, 0)
        if not self.silent():
            self.bus.acknowledged_by_chip += 1
        self._accept(frame)

    def _accept(self, frame: Frame) -> None:
        number = self._fifo_of(frame)
        if number is None:
            return
        fifo = self.fifos[number]
        if len(fifo.frames) == FIFO_DEPTH:
            fifo.overrun = True
            if not self.mcr >> 3 & 1:  # RFLM 0: the newest takes the place of the last
                fifo.frames[-1] = frame
            return
        fifo.frames.append(frame)
        fifo.full = fifo.full or len(fifo.frames) == FIFO_DEPTH

    def _identifier_word(self, frame: Frame) -> int:
        number = frame.id << 3 | 4 if frame.extended else frame.id << 21
        return number | (2 if frame.remote else 0)

    def _fifo_of(self, frame: Frame) -> int | None:
        """By 32-bit filters; 16-bit ones are beyond this model. A list goes before a mask, then the lower bank."""
        if self.fmr & 1:
            return None
        fitting = []
        for bank in range(28):
            if not self.filters[0x21C] >> bank & 1:
                continue
            assert self.filters[0x20C] >> bank & 1, "filter kind not modelled"
            word, (first, second) = self._identifier_word(frame), self.banks[bank]
            is_list = self.filters[0x204] >> bank & 1
            if word in (first, second) if is_list else word & second == first & second:
                fitting.append((not is_list, bank))
        return self.filters[0x214] >> min(fitting)[1] & 1 if fitting else None

    def rx0_asks(self) -> bool:
        fifo = self.fifos[0]
        return bool(
            self.ier >> 1 & 1 and fifo.frames and not fifo.releasing
            or self.ier >> 2 & 1 and fifo.full
            or self.ier >> 3 & 1 and fifo.overrun
        )

    # --- registers

    def read(self, offset: int) -> int:
        if not self.rcc.enabled(0x40, 25):
            return 0
        if 0x180 <= offset < 0x1B0:
            return self.mailboxes[(offset - 0x180) // 16].words[offset % 16 // 4]
        if 0x1B0 <= offset < 0x1D0:
            return self._read_fifo(self.fifos[(offset - 0x1B0) // 16], offset % 16)
        if 0x240 <= offset < 0x320:
            return self.banks[(offset - 0x240) // 8][offset % 8 // 4]
        if offset in self.filters:
            return self.filters[offset]
        if offset in (0x0C, 0x10):
            return self._read_rfr(self.fifos[offset == 0x10])
        return {
            0x00: self.mcr,
            0x04: 0xC00 | self.asleep << 1 | self.init,
            0x08: self.tsr_done | sum(1 << 26 + index for index, box in enumerate(self.mailboxes) if not box.pending),
            0x14: self.ier,
            0x18: self._esr(),
            0x1C: self.btr,
            0x200: self.fmr,
        }.get(offset, 0)

    def _esr(self) -> int:
        passive = self.tec > 127 or self.rec > 127
        warning = self.tec >= 96 or self.rec >= 96
        return self.rec << 24 | self.tec << 16 | self.bus_off << 2 | passive << 1 | int(warning)

    @staticmethod
    def _read_rfr(fifo: Fifo) -> int:
        value = len(fifo.frames) | fifo.full << 3 | fifo.overrun << 4 | (fifo.releasing > 0) << 5
        if fifo.releasing:
            fifo.releasing -= 1
            if fifo.releasing == 0:
                fifo.frames.popleft()
                fifo.full = False
        return value

    def _read_fifo(self, fifo: Fifo, offset: int) -> int:
        if not fifo.frames or fifo.releasing:
            self.chip.violations.append("bxCAN: FIFO read with nothing in it, or while it is released")
            return 0
        frame = fifo.frames[0]
        data = frame.data.ljust(8, b"\xa5")
        dlc = len(frame.data) if frame.dlc is None else frame.dlc
        word = {
            0: self._identifier_word(frame),
            4: 0xBEEF0000 | dlc,
            8: int.from_bytes(data[:4], "little"),
            12: int.from_bytes(data[4:], "little"),
        }
        return word[offset]

    def write(self, offset: int, value: int) -> None:
        note = self.chip.violations.append
        if not self.rcc.enabled(0x40, 25):
            note(f"bxCAN: register 0x{offset:x} written without its clock")
        elif offset == 0x00:
            self._write_mcr(value)
        elif offset == 0x08:
            self._write_tsr(value)
        elif offset in (0x0C, 0x10):
            self._write_rfr(self.fifos[offset == 0x10], value)
        elif offset == 0x14:
            self.ier = value
        elif offset == 0x1C:
            if self.init:
                self.btr = value
            else:
                note("bxCAN: BTR written outside initialisation (32.9.2)")
        elif 0x180 <= offset < 0x1B0:
            self._write_mailbox((offset - 0x180) // 16, offset % 16 // 4, value)
        elif offset == 0x200:
            self.fmr = self.fmr & ~1 | value & 1
        elif offset in self.filters:
            if offset != 0x21C and not self.fmr & 1:
                note(f"bxCAN: filter register 0x{offset:x} written with FINIT 0 (32.9.4)")
            self.filters[offset] = value
        elif 0x240 <= offset < 0x320:
            bank = (offset - 0x240) // 8
            if not self.fmr & 1 and self.filters[0x21C] >> bank & 1:
                note("bxCAN: filter bank written while active (32.9.4)")
            self.banks[bank][offset % 8 // 4] = value
        else:
            note(f"bxCAN: there is nothing to write at 0x{offset:x}")

    def _write_mcr(self, value: int) -> None:
        if value >> 15 & 1:
            self.reset()
            return
        if value & 1 and not self.mcr & 1:
            self.change_us = self.acknowledge_after_us
        if not value & 1 and self.mcr & 1:
            if not self.init:
                self.chip.violations.append("bxCAN: initialisation left before it was acknowledged")
            if self.bus_off:
                self.recessive_bits_left = BUS_OFF_BITS
        self.mcr = value

    def _write_tsr(self, value: int) -> None:
        for index, box in enumerate(self.mailboxes):
            if value >> 8 * index & 1:
                self.tsr_done &= ~(0xF << 8 * index)
            if value >> 8 * index + 7 & 1 and box.pending:
                box.pending = False
                self.tsr_done = self.tsr_done & ~(0xF << 8 * index) | 1 << 8 * index

    def _write_rfr(self, fifo: Fifo, value: int) -> None:
        if value >> 3 & 1:
            fifo.full = False
        if value >> 4 & 1:
            fifo.overrun = False
        if value >> 5 & 1 and fifo.frames and not fifo.releasing:
            fifo.releasing = self.release_reads

    def _write_mailbox(self, index: int, word: int, value: int) -> None:
        box = self.mailboxes[index]
        if box.pending:
            self.chip.violations.append("bxCAN: mailbox written while not empty (32.9.3)")
            return
        box.words[word] = value
        if word == 0 and value & 1:
            self.requests += 1
            box.pending, box.asked = True, self.requests
            self.tsr_done &= ~(0xF << 8 * index)

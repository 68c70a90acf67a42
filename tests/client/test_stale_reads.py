"""How old a K may be that the C client reads: a controller in Python stops sending, or an adapter keeps what is old."""

from __future__ import annotations

from slcan_controller import SlcanController
from test_commanding import TIMEOUT, acts

FIRST_S, BACK_S = 0.6, 2.2  # K is sent until then, and again from then on


def test_k_of_a_controller_that_stopped_sending_is_no_k_of_now() -> None:
    """Its heartbeats still come. K that was never read, but came while something else was asked, does not count."""

    def stops(since_s: float) -> int | None:
        return 1 if since_s < FIRST_S else None

    with SlcanController(streams=stops) as limb:
        done, why = acts(limb.url, "read:500", "silent:300", "entry:1", "silent:2000", "read:100")
        assert (done[0].status, done[0].state) == (0, 1), why
        assert done[-1].status == TIMEOUT and "did not come in time" in why


def test_what_has_waited_in_a_serial_port_is_as_old_as_the_wait() -> None:
    """An adapter whose buffer is full drops the newest frames: behind a pause of the program come old ones first."""

    def pauses(since_s: float) -> int | None:
        return 1 if since_s < FIRST_S else 2 if since_s > BACK_S else None

    with SlcanController(streams=pauses) as limb:
        done, why = acts(limb.url, "read:500", "silent:2000", "read:2000")
        assert (done[0].status, done[0].state) == (0, 1), why
        assert (done[-1].status, done[-1].state) == (0, 2), why

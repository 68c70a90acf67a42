"""Who commands a guarded controller: when a session is opened, and when it goes on."""

from __future__ import annotations

from brace.bus.ownership import Owner
from brace.bus.siphash import siphash
from brace.wire.codes import SETTING

KEY = bytes(range(16))
GUARDED = next(code for code in range(256) if SETTING.name_of(code) == "GUARDED")


def test_a_session_in_which_a_command_was_taken_goes_on_until_the_challenge_changes() -> None:
    owner = Owner(KEY)

    def opens(challenge: int) -> bool:
        owner.forget()
        return owner.begin(GUARDED, challenge, 0, "here")

    assert opens(1) and opens(1)
    owner.accepted()
    assert not opens(1)
    assert opens(2)


def test_a_check_is_that_of_the_published_example() -> None:
    """SipHash-2-4 of the bytes 0 to 14 with the key of the bytes 0 to 15 (Aumasson and Bernstein, appendix A)."""
    assert siphash(KEY, bytes(range(15))) == 0xA129CA6149BE45E5

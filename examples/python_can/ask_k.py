"""K of node 1 at a posture, with python-can and the generated names alone.

ask_k.py socketcan can0 | ask_k.py slcan socket://127.0.0.1:29536
"""

import sys
import time

import can
from brace.wire.frames import ANSWER_ID, ANSWERS, DICTIONARY_HASH, REFUSED, REQUEST_ID, REQUESTS

NODE = 1


def ask(bus, name, values, token):
    """The answer's values by name."""
    data = REQUESTS[name].encode(values, token)
    bus.send(can.Message(arbitration_id=REQUEST_ID + NODE, data=data, is_extended_id=False))
    parts, answer, until = {part.command: part for part in ANSWERS[name]}, {}, time.monotonic() + 1.0
    while parts and time.monotonic() < until:
        frame = bus.recv(0.1)
        if frame is None or frame.arbitration_id != ANSWER_ID + NODE or frame.data[1] != token:
            continue
        if frame.data[0] == REFUSED:
            sys.exit(f"node {NODE} refuses {name}")
        if frame.data[0] in parts:
            answer |= parts.pop(frame.data[0]).decode(bytes(frame.data))
    return answer if not parts else sys.exit(f"node {NODE} does not answer")


if len(sys.argv) != 3:
    sys.exit(__doc__)
with can.Bus(interface=sys.argv[1], channel=sys.argv[2]) as bus:
    if ask(bus, "identify", {}, 1)["dictionary_hash"] != DICTIONARY_HASH:
        sys.exit("the controller speaks another dictionary")
    k = ask(bus, "k_at_posture", {"theta1": 0.5, "theta2": 1.2}, 2)
    print(f"K = [{k['k_xx']:.4f} {k['k_xz']:.4f}; {k['k_xz']:.4f} {k['k_zz']:.4f}] N/mm")

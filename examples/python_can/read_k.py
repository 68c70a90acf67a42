"""Prints each K that node 1 sends. It needs python-can, cantools and the DBC, and no part of Brace.

python read_k.py brace.dbc socketcan can0
python read_k.py brace.dbc slcan socket://127.0.0.1:29536

`brace dbc --nodes 1 2 3` writes the DBC of several controllers. K comes in two frames. They belong to one
tick when they have the same sequence number.
"""

import sys
import time

import can
import cantools

if len(sys.argv) != 4:
    sys.exit(__doc__)
database = cantools.database.load_file(sys.argv[1])
parts: dict[str, dict] = {}
until = time.monotonic() + 5.0
with can.Bus(interface=sys.argv[2], channel=sys.argv[3]) as bus:
    while time.monotonic() < until:
        frame = bus.recv(1.0)
        if frame is None:
            continue
        try:
            message = database.get_message_by_frame_id(frame.arbitration_id)
        except KeyError:  # another program's
            continue
        if message.name not in ("stiffness_a", "stiffness_b"):
            continue
        parts[message.name] = message.decode(frame.data, decode_choices=False)
        first, second = parts.get("stiffness_a"), parts.get("stiffness_b")
        if first and second and first["sequence"] == second["sequence"]:
            print(f"k_xx {first['k_xx']:.4f} k_xz {first['k_xz']:.4f} k_zz {second['k_zz']:.4f} N/mm")
            sys.exit(0)
sys.exit("no K in 5 s: is the controller's node 1, and does it send? brace query tells more")

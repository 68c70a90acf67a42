"""Reads K over Modbus. It needs pymodbus and the register map, and no part of Brace.

python read_k.py modbus.csv 127.0.0.1 1502

All values of one read are of one tick. A float is two registers, high word first. The probe register holds 12345.5: who
reads that number reads floats right.
"""

import csv
import sys

from pymodbus.client import ModbusTcpClient

NAMES = ("k_xx", "k_xz", "k_zz")
PROBE = 12345.5

if len(sys.argv) != 4:
    sys.exit(__doc__)
with open(sys.argv[1], newline="") as file:
    address = {row["name"]: int(row["address"]) for row in csv.DictReader(file) if row["table"] == "input"}


def floats(client: ModbusTcpClient, first: str, count: int) -> list[float]:
    """`count` numbers from a name's address on."""
    answer = client.read_input_registers(address[first], count=2 * count, device_id=1)
    if answer.isError():
        sys.exit(f"the controller refuses: {answer}")
    return list(client.convert_from_registers(answer.registers, client.DATATYPE.FLOAT32, word_order="big"))


with ModbusTcpClient(sys.argv[2], port=int(sys.argv[3])) as client:
    if floats(client, "probe_f32", 2)[0] != PROBE:
        sys.exit("the probe register is not 12345.5: are words or bytes swapped?")
    k = floats(client, NAMES[0], len(NAMES))
    print(" ".join(f"{name} {value:.4f}" for name, value in zip(NAMES, k)), "N/mm")

"""The subcommands, in the order of `brace --help`, with the line that it prints for each.

Help is asked for often and must come at once, so this file imports nothing.
"""

from __future__ import annotations

SUBCOMMANDS = {
    "new": "a limb.toml from what you know: lengths, tubes, gears, servos",
    "k": "K, C, eigenvalues and stiff axis at a posture",
    "map": "the workspace: eigenvalues over r, ellipses of K, as pictures and CSV",
    "import": "a dataset from your own files: CSV of any kind, .xlsx, candump and MCAP logs",
    "export": "a limb as const C data, as a MuJoCo model with its compliances, or as a URDF",
    "simulate": "a loading test on the simulated limb, written as a dataset",
    "predict": "a dataset's own load sequence played on a model",
    "identify": "a limb's parameters from measurements, with intervals",
    "diagnose": "where model and data disagree, what is missing, the model with it added",
    "plan": "a posture and a pressing force for a wanted stiffness, contact and payload",
    "stance": "a body on several limbs: what each foot bears, which lets go first",
    "params": "a limb model as the controller's parameter block, and back",
    "demo": "the paper's table and a simulated limb, end to end",
    "sim": "the controller's own code over simulated limbs, on loopback ports",
    "query": "K and state of a controller, once",
    "monitor": "live K, ellipse, states, rates, age",
    "record": "a bus to a log (candump, MCAP); or a loading test to a dataset",
    "replay": "a recorded log once more: the same K, bit for bit",
    "gravity": "sets where a controller takes down to be, or shows it",
    "take-up": "takes up the backlash of joints on a controller: the limb moves",
    "let-go": "lets go of the joints whose backlash a controller has taken up: the limb moves",
    "stop": "stops every limb of a bus where it is: anybody may, without a key",
    "clear": "clears a latched fault of a controller",
    "dbc": "the frames of all nodes of a bus as a CAN database (DBC), for candump's, cantools' and other programs",
    "flash": "put an image on a board",
    "doctor": "what is there for working with Brace, and what is missing",
    "completion": "completion of commands, options and file names for bash, zsh or fish",
}

"""`python -m interface [--check]`: writes everything that follows from the dictionary, or says what has drifted."""

from __future__ import annotations

import sys

from interface.dictionary import DictionaryError
from interface.outputs import DICTIONARY, drifted, write


def main(arguments: list[str]) -> int:
    """0 done, 1 drifted, 2 usage, 3 bad dictionary."""
    if arguments not in ([], ["--check"]):
        print("usage: python -m interface [--check]", file=sys.stderr)
        return 2
    try:
        changed = drifted() if arguments else write()
    except (DictionaryError, KeyError, ValueError) as error:
        why = error if isinstance(error, DictionaryError) else repr(error)
        print(f"interface: {why}\n  try: the comments at the heads of {DICTIONARY.name} and messages.toml, and "
              "docs/adding.md", file=sys.stderr)
        return 3
    for name in changed:
        print(f"{'drifted' if arguments else 'wrote'} {name}", file=sys.stderr)
    return 1 if arguments and changed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

"""Which signals of a log are taken: all of them, or those that somebody names. A vehicle's database has thousands, and a
question for each is no question."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from brace.ground.errors import UsageError

MOST = 500  # signals of one log that are shown and asked about
NAMED = 6


class Wanted:
    """By patterns of names (LOADCELL.*) or whole sources (a message, a topic); none: all, up to MOST."""

    def __init__(self, path: Path, patterns: Sequence[str] = ()) -> None:
        self._path, self._patterns = path, tuple(patterns)
        self._of: dict[str, bool] = {}
        self._taken = 0
        self._met: set[str] = set()

    def takes(self, source: str, name: str) -> bool:
        """Whether a signal is taken. Refuses the one that is too many."""
        known = self._of.get(name)
        if known is not None:
            return known
        met = {each for each in self._patterns if each == source or fnmatchcase(name, each)}
        self._met |= met
        taken = self._of[name] = bool(met) or not self._patterns
        self._taken += taken
        if self._taken > MOST:
            raise UsageError(
                f"more than {MOST} signals of this log are taken",
                where=str(self._path),
                why="each would be a column that somebody must look at, and a record needs about ten",
                next_step=f"choose the signals: --signals '{source}.*' for those of one message or topic, or --signals "
                f"{name} for one; once for each",
            )
        return taken

    def takes_any(self, source: str, names: Sequence[str]) -> bool:
        """Whether a source has a signal that is taken."""
        return not self._patterns or any([self.takes(source, name) for name in names])

    def notes(self) -> list[str]:
        """How many are left out. Refuses a pattern that no signal has met."""
        for pattern in self._patterns:
            if pattern not in self._met:
                some = list(self._of)[:NAMED]
                more = f" and {len(self._of) - NAMED} more" if len(self._of) > NAMED else ""
                raise UsageError(
                    f"no signal of this log is called {pattern}",
                    where=str(self._path),
                    why=f"it has {', '.join(some) or 'none'}{more}",
                    next_step="--signals with a message, a topic, or the name of a signal, where * stands for any letters",
                )
        left = len(self._of) - self._taken
        return [f"{left} signals are left out by --signals"] if left else []

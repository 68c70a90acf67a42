"""Reading files that may be anything, and writing files so that a failure leaves the old ones alone."""

from __future__ import annotations

import hashlib
import os
import re
import stat
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

from brace.ground.errors import BadFileError, UsageError

TOML_LIMIT_BYTES = 1 << 20
DATA_LIMIT_BYTES = 1 << 30


def read_bytes(path: Path, limit_bytes: int, what: str) -> bytes:
    """The content of a regular file of at most `limit_bytes`; `what` names it in the refusal."""
    try:
        info = path.stat()
    except FileNotFoundError:
        raise BadFileError(
            f"no such {what}", where=str(path), why="the file does not exist", next_step=_nearby(path)
        ) from None
    except (OSError, ValueError) as error:
        raise BadFileError(
            f"the {what} cannot be opened",
            where=repr(str(path))[1:-1],
            why=getattr(error, "strerror", None) or str(error),
            next_step="check the path and its permissions",
        ) from None
    if stat.S_ISDIR(info.st_mode):
        raise BadFileError(
            f"a folder, where a {what} is wanted",
            where=str(path),
            why="a folder has no text to read",
            next_step=(
                f"a dataset's folder comes first, without an option; name the {what}, a file"
                if (path / "data.csv").is_file()
                else f"name the {what} inside it"
            ),
        )
    if not stat.S_ISREG(info.st_mode):
        raise BadFileError(
            f"not a regular file, where a {what} is wanted",
            where=str(path),
            why="devices, pipes and sockets may never end",
            next_step="save it to a file first",
        )
    if info.st_size > limit_bytes:
        raise BadFileError(
            f"too large for a {what}: {info.st_size} bytes",
            where=str(path),
            why=f"at most {limit_bytes} bytes are read",
            next_step=f"check that this is the {what}",
        )
    try:
        return path.read_bytes()
    except OSError as error:
        raise BadFileError(
            f"the {what} cannot be read",
            where=str(path),
            why=error.strerror or str(error),
            next_step="check its permissions",
        ) from None


def read_text(path: Path, limit_bytes: int, what: str) -> str:
    """The same as UTF-8 text; a byte-order mark is dropped, binary content is refused."""
    data = read_bytes(path, limit_bytes, what)
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise BadFileError(
            f"not text: byte 0x{data[error.start]:02x} at offset {error.start}",
            where=f"{path}:{line}",
            why=f"a {what} is UTF-8 text",
            next_step=f"check that this is the {what}, and save it as UTF-8",
        ) from None
    if "\0" in text:
        line = text.count("\n", 0, text.index("\0")) + 1
        raise BadFileError(
            "not text: it holds a zero byte",
            where=f"{path}:{line}",
            why=f"a {what} is UTF-8 text",
            next_step=f"check that this is the {what}",
        )
    return text


def _nearby(path: Path) -> str:
    """A suggestion built from what lies beside a missing file."""
    from brace.ground.errors import did_you_mean

    if not path.parent.is_dir():
        return f"the folder {path.parent} does not exist either; check the path"
    beside = {entry.stem: entry.name for entry in sorted(path.parent.iterdir())[:1000] if entry.suffix == path.suffix}
    near = did_you_mean(path.stem, beside, likeness=0.75)  # the same ending makes no likeness
    if near:
        return f"did you mean {path.parent / beside[near]}?"
    return "check the path"


class OutputSet:
    """Files that appear together or not at all.

    `add` stages content in the folder of its destination, without a name where the system can (a killed run leaves
    nothing then); `commit` puts everything in place by renaming. Leaving the `with` block without `commit` touches
    nothing. A destination that is one of the `inputs` is refused.
    """

    def __init__(self, inputs: Iterable[Path] = ()) -> None:
        self._staged: list[_Staged] = []
        self._inputs = tuple(inputs)

    def __enter__(self) -> OutputSet:
        return self

    def __exit__(self, *_: object) -> None:
        for staged in self._staged:
            staged.drop()
        self._staged.clear()

    def add(self, final: Path, content: bytes | str) -> None:
        """Stage one file; an existing destination is replaced at commit."""
        final = checked_destination(final, self._inputs)
        data = content.encode() if isinstance(content, str) else content
        anchor = _existing_parent(final)
        try:
            staged = _Staged(final, anchor)
            self._staged.append(staged)
            staged.write(data)
        except OSError as error:
            raise UsageError(
                "the output cannot be written",
                where=str(final),
                why=error.strerror or str(error),
                next_step="check the folder's permissions and free space",
            ) from None

    def commit(self) -> None:
        """Put every staged file in place."""
        try:
            for staged in self._staged:
                staged.final.parent.mkdir(parents=True, exist_ok=True)
                staged.put()
        except OSError as error:
            raise UsageError(
                "the output cannot be put in place",
                where=str(error.filename2 or error.filename),
                why=error.strerror or str(error),
                next_step="choose another --out",
            ) from None
        for staged in self._staged:
            staged.drop()
        self._staged.clear()


class _Staged:
    """One file's content, on the disk and not in its place yet."""

    def __init__(self, final: Path, anchor: Path) -> None:
        self.final = final
        self._temporary: Path | None = None
        try:
            if not os.path.isdir("/proc/self/fd"):
                raise OSError
            self._handle = os.open(anchor, os.O_TMPFILE | os.O_WRONLY, 0o600)
        except (AttributeError, OSError):  # not Linux, or a file system without files that have no name
            self._handle, name = tempfile.mkstemp(prefix=f".{final.name}.", dir=anchor)
            self._temporary = Path(name)

    def write(self, data: bytes) -> None:
        """The content, on the disk."""
        with os.fdopen(os.dup(self._handle), "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.fchmod(self._handle, 0o666 & ~_umask())

    def put(self) -> None:
        """In its place."""
        if self._temporary is None:
            name = self.final.with_name(f".{self.final.name}.new")
            name.unlink(missing_ok=True)  # of a run that was killed between the two calls below
            handles = os.open("/proc/self/fd", os.O_RDONLY)  # linkat follows the link only from a folder that is open
            try:
                os.link(str(self._handle), name, src_dir_fd=handles, follow_symlinks=True)
            finally:
                os.close(handles)
            self._temporary = name
        os.replace(self._temporary, self.final)
        self._temporary = None

    def drop(self) -> None:
        """Nothing is left of it outside its place."""
        if self._temporary is not None:
            self._temporary.unlink(missing_ok=True)
            self._temporary = None
        if self._handle >= 0:
            os.close(self._handle)
            self._handle = -1


_MARK = re.compile(rb"\n# brace wrote this file; sha256 of the lines above: ([0-9a-f]{64})\n$")


def marked(text: str) -> str:
    """The text of a TOML file with a last line by which `refuse_written` knows it again."""
    body = "\n".join(line for line in text.splitlines() if not line.startswith("# brace wrote this file;"))
    return f"{body}\n# brace wrote this file; sha256 of the lines above: {hashlib.sha256(body.encode()).hexdigest()}\n"


def is_unchanged(data: bytes) -> bool:
    """Whether `marked` wrote a file's content, and nobody has changed it since."""
    found = _MARK.search(data)
    return found is not None and hashlib.sha256(data[: found.start()]).hexdigest().encode() == found[1]


def refuse_written(path: Path, is_own: Callable[[bytes], bool] = is_unchanged) -> None:
    """Refuses an output that would replace what a person wrote: a file that is there and that `is_own` does not know."""
    final = checked_destination(path)
    try:
        if is_own(final.read_bytes()):
            return
    except FileNotFoundError:
        return
    except OSError as error:
        raise UsageError(
            "the output cannot be written",
            where=str(path),
            why=error.strerror or str(error),
            next_step="choose another --out",
        ) from None
    raise UsageError(
        "the output would replace a file that somebody wrote or changed",
        where=str(path),
        why="brace replaces only what it wrote itself and nobody has changed since: a model that it writes has a sum in "
        "its last line",
        next_step="choose another --out, or move the file away",
    )


def write_file(path: Path, content: bytes | str, inputs: Iterable[Path] = ()) -> None:
    """One file, whole or not at all, and never over one of the `inputs`."""
    with OutputSet(inputs) as outputs:
        outputs.add(path, content)
        outputs.commit()


def check_folder(folder: Path, names: Iterable[str], inputs: Iterable[Path] = ()) -> None:
    """Refuses, before any work is done, a folder that cannot take files of these names."""
    for name in names:
        check_file(folder / name, inputs)


def check_file(path: Path, inputs: Iterable[Path] = ()) -> None:
    """Refuses, before any work is done, a file that cannot be written there."""
    anchor = _existing_parent(checked_destination(path, inputs))
    if not os.access(anchor, os.W_OK | os.X_OK):
        raise UsageError(
            "the output cannot be written",
            where=str(path),
            why=f"nothing may be written in {anchor}: its permissions, or a read-only file system",
            next_step="choose another --out",
        )


def checked_destination(path: Path, inputs: Iterable[Path] = ()) -> Path:
    """Where a file will be written: symbolic links followed, so that the file they lead to is replaced and the
    link stays. Refuses what is no regular file, and the `inputs`."""
    try:
        final = path.resolve()
        kind = final.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        return final  # nothing there yet
    except (OSError, RuntimeError, ValueError) as error:
        raise UsageError(
            "the output cannot be written",
            where=str(path),
            why=getattr(error, "strerror", None) or str(error),
            next_step="choose another --out",
        ) from None
    if stat.S_ISDIR(kind):
        raise UsageError(
            "a folder is in the way of the output file",
            where=str(path),
            why="a folder is not replaced by a file",
            next_step="choose another --out",
        )
    if not stat.S_ISREG(kind):
        raise UsageError(
            "the output would replace what is no regular file",
            where=str(path),
            why="devices, pipes and sockets are not replaced; output is a file put in place whole",
            next_step="choose a file for --out; --json prints to stdout",
        )
    for source in inputs:
        if source.exists() and os.path.samefile(source, final):
            raise UsageError(
                "the output would replace an input",
                where=str(path),
                why=f"it is the file that {source} is read from",
                next_step="choose another --out",
            )
    return final


def _existing_parent(path: Path) -> Path:
    """The nearest folder above `path` that exists (staging there keeps the rename on one file system)."""
    for parent in path.absolute().parents:
        if parent.is_dir():
            return parent
        if parent.exists():
            raise UsageError(
                "a file is in the way of the output folder",
                where=str(parent),
                why="the output needs a folder of that name",
                next_step="choose another --out",
            )
    return Path("/")


def _umask() -> int:
    current = os.umask(0)
    os.umask(current)
    return current

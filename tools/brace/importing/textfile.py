"""Text files with tables: encoding, separator, lines."""

from __future__ import annotations

import csv
import re
from collections.abc import Sequence
from pathlib import Path

from brace.ground.errors import BadFileError
from brace.ground.files import DATA_LIMIT_BYTES, read_bytes
from brace.importing import labview, numerals
from brace.importing.part import Part
from brace.importing.stamps_in_two import joined
from brace.importing.table_in_lines import Line, parts, refuse_large, width_of

WHAT = "table of readings"
csv.field_size_limit(DATA_LIMIT_BYTES)  # a long line is text, and no reason to end
HEADER_LINES = 60
_HEAD_BYTES = 1 << 23
SAMPLE_LINES = 400
SEPARATORS = {";": "semicolons", "\t": "tabs", ",": "commas", "|": "bars", " ": "blanks"}
_MAGIC = (
    (b"\xd0\xcf\x11\xe0", "an old Excel workbook (.xls)", "save it as .xlsx or CSV"),
    (b"MATLAB 5.0 MAT", "a MATLAB .mat file", "in MATLAB: writetable(T, 'record.csv')"),
    (b"\x89HDF", "an HDF5 file (MATLAB's newer .mat too)", "export its table as CSV"),
    (b"%PDF", "a PDF", "export the readings as CSV from the program that wrote it"),
    (b"TDSm", "a LabVIEW .tdms file", "export it as CSV from LabVIEW or Excel's TDM add-in"),
    (b"SQLite", "a database", "export the table of readings as CSV"),
    (b"\x1f\x8b", "a compressed file", "unpack it first"),
    (b"BZh", "a compressed file", "unpack it first"),
    (b"\x28\xb5\x2f\xfd", "a compressed file", "unpack it first"),
    (b"#ROSBAG", "a ROS 1 bag", "convert it: rosbags-convert --src FILE.bag --dst FILE.mcap, or mcap convert"),
    (b"MDF ", "an ASAM .mf4 or .mdf file", "export it as CSV, or as .asc or .blf of its frames"),
    (b"ULog", "a log of PX4 (.ulg)", "ulog2csv FILE.ulg, then import the topics' CSV files"),
    (b"PAR1", "a Parquet file", "in pandas: read_parquet(FILE).to_csv('record.csv')"),
    (b"ARROW1", "a Feather file", "in pandas: read_feather(FILE).to_csv('record.csv')"),
    (b"\x93NUMPY", "a NumPy array", "save it with its columns' names: numpy.savetxt with header, or pandas' to_csv"),
    (b"WPILOG", "a log of WPILib", "export it as CSV with DataLogTool"),
)


def read(path: Path, *, decimal: str = "", separator: str = "") -> list[Part]:
    """The tables of a text file."""
    data = read_bytes(path, DATA_LIMIT_BYTES, WHAT)
    refuse_large(path, data.count(b"\n") + data.count(b"\r") - data.count(b"\r\n"), _widest(data))
    text, encoding = _decoded(data, path)
    lines = _whole_lines(re.split(r"\r\n|\n|\r", text))
    _refuse_factor(path, lines)
    start = 0
    if found := re.fullmatch(r"\"?sep=(.)\"?", lines[0].strip("\ufeff ")):
        separator, start = separator or found.group(1), 1
    numbered = [(number, line) for number, line in enumerate(lines, start=1) if number > start]
    if not any(line.strip() for _, line in numbered):
        raise BadFileError(
            "an empty file", where=str(path), why="there is nothing to import", next_step="check the export"
        )
    chosen = separator or _separator([line for _, line in numbered], path)
    cut = [Line(number, line, cells(line, chosen)) for number, line in numbered]
    if lines[0].lstrip("\ufeff").startswith(labview.FIRST):
        cut = labview.without_headers(str(path), cut)
    if chosen == " ":
        cut = _names_with_blanks(cut)
    how = f"{encoding}, {SEPARATORS.get(chosen, repr(chosen))} between columns"
    return [joined(part) for part in parts(path, cut, decimal=decimal, how=how)]


_FACTOR = re.compile(r"\s*1\.0+e[-+]?\d+\s*\*\s*", re.IGNORECASE)


def _refuse_factor(path: Path, lines: Sequence[str]) -> None:
    """MATLAB shows a matrix with a factor of all its numbers in a line of its own."""
    for number, line in enumerate(lines, start=1):
        if "*" in line and _FACTOR.fullmatch(line):
            raise BadFileError(
                f"a factor of all numbers below it: {line.strip()}",
                where=f"{path}:{number}",
                why="this is what MATLAB shows on its screen: the numbers are rounded, and are not those of the test",
                next_step="in MATLAB: writetable(T, 'record.csv'), or writematrix",
            )


def _widest(data: bytes) -> int:
    """Cells of the longest of the first lines, by the separator that it has most of."""
    longest = max(re.split(rb"[\r\n]+", data[:_HEAD_BYTES], maxsplit=HEADER_LINES)[:HEADER_LINES], key=len)
    return max(longest.count(separator.encode()) for separator in SEPARATORS if separator != " ") + 1


def cells(line: str, separator: str) -> list[str]:
    """The line's cells; quotes keep separators in."""
    if separator == " ":
        return line.split()
    return next(csv.reader([line.strip("\ufeff")], delimiter=separator, skipinitialspace=True), [])


def _whole_lines(lines: list[str]) -> list[str]:
    """A name in quotes may have a line break within; the lines that it fills are one, and empty ones keep the count."""
    out = list(lines)
    for at in range(min(len(out), HEADER_LINES)):
        if out[at].count('"') % 2 == 0:
            continue
        for end in range(at + 1, min(len(out), at + HEADER_LINES)):
            if sum(numerals.is_number(cell) for cell in re.split(r"[;,\t| ]", out[end])) >= 2:
                break  # readings: the quote was no name's
            whole = " ".join(out[at : end + 1])
            if whole.count('"') % 2 == 0:
                out[at : end + 1] = [whole, *[""] * (end - at)]
                break
    return out


def _decoded(data: bytes, path: Path) -> tuple[str, str]:
    for magic, what, way in _MAGIC:
        if data.startswith(magic):
            raise BadFileError(
                f"this is {what}",
                where=str(path),
                why="brace import reads text, .xlsx, MCAP and logs of CAN frames (candump, .asc, .blf, .trc)",
                next_step=way,
            )
    for mark, encoding in ((b"\xef\xbb\xbf", "utf-8-sig"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16")):
        if data.startswith(mark):
            try:
                return data.decode(encoding), encoding.removesuffix("-sig")
            except UnicodeDecodeError:
                break
    if b"\0" in data[:4000]:
        even = data[1:4000:2].count(0)
        if 3 * even > len(data[:4000]):
            return data.decode("utf-16-le", "replace"), "utf-16"
        raise BadFileError(
            "not text: it holds zero bytes",
            where=str(path),
            why="brace import reads text (CSV and the like) and .xlsx",
            next_step="export the readings as CSV",
        )
    try:
        return data.decode("utf-8"), "utf-8"
    except UnicodeDecodeError:
        return data.decode("cp1252", "replace"), "Windows-1252"


def _separator(lines: Sequence[str], path: Path) -> str:
    """The separator by which most lines become rows of numbers, of one width."""
    filled = [line for line in lines if line.strip()]
    sample = filled if len(filled) <= SAMPLE_LINES else filled[: SAMPLE_LINES // 2] + filled[-SAMPLE_LINES // 2 :]
    best, best_score = "", (0.0, 0)
    for separator in SEPARATORS:
        cut = [Line(0, line, cells(line, separator)) for line in sample]
        width = width_of(cut)
        if width < 2:
            continue
        share = sum(_share(line, separator) for line in cut if len(line.cells) == width)
        if (round(share, 2), width) > best_score:
            best, best_score = separator, (round(share, 2), width)
    if best:
        return best
    raise BadFileError(
        "no table of readings in this file",
        where=str(path),
        why="no line has two numbers side by side, whether by semicolons, tabs, commas, bars or blanks",
        next_step="export the readings as CSV: a line of column names, then a line for each reading",
    )


def _share(line: Line, separator: str) -> float:
    """The share of cells that are readings; where commas separate, none of them is a decimal sign."""
    filled = [cell for cell in line.cells if cell.strip()]
    good = sum(
        1
        for cell in filled
        if numerals.is_missing(cell) or numerals.is_number(cell) or numerals.clock_s(cell) == numerals.clock_s(cell)
    )
    return good / len(filled) if filled else 0.0


_WORD_WITH_UNIT = re.compile(r"\"[^\"]*\"|[^\s\[(]+\s*[\[(][^\])]*[\])]|\S+")


def _names_with_blanks(lines: list[Line]) -> list[Line]:
    """Where blanks separate columns, names may hold single ones: 'Force X', 'Fx [N]'."""
    width = width_of(lines)
    mended = []
    for line in lines:
        text = re.sub(r"^\s*[#%]+\s*", "", line.text)
        if line.readings >= 2 and 2 * line.readings >= line.filled:
            mended.append(line)
            continue
        for words in (re.split(r"\s{2,}|\t", text.strip()), _WORD_WITH_UNIT.findall(text), text.split()):
            if len(words) == width:
                mended.append(Line(line.number, line.text, [word.strip('"') for word in words]))
                break
        else:
            mended.append(Line(line.number, line.text, [text]))
    return mended

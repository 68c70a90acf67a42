"""Files as other people's rigs and programs write them, of one limb whose K is known."""

from __future__ import annotations

import io
import math
import zipfile
from pathlib import Path

import numpy as np
from command_bench import physics_k

LBF_N = 4.4482216152605
PATH = (0, 1, 2, 3, 4, 3, 2, 1, 0, -1, -2, -3, -4, -3, -2, -1, 0)
POSES_DEG = ((42.5, 57.25), (12.0, 92.0), (63.0, 126.5))
STEP_MM = 0.635


class Record:
    """Rows of a loading test: columns by name, in mm, N, deg, s."""

    def __init__(self, poses: tuple[tuple[float, float], ...] = POSES_DEG, axes: str = "xz", repeats: int = 2) -> None:
        random = np.random.default_rng(7)
        rows = []
        clock = 0.0
        for pose, (theta1, theta2) in enumerate(poses, start=1):
            k = physics_k(math.radians(theta1), math.radians(theta2))
            for axis in axes:
                for rep in range(1, repeats + 1):
                    for step, place in enumerate(PATH):
                        d = np.array([1.0, 0.0] if axis == "x" else [0.0, 1.0]) * place * STEP_MM
                        f = k @ d + 0.05 * random.standard_normal(2)
                        rows.append(
                            (pose, theta1, theta2, axis, rep, step, round(clock, 3), 22.0 + clock * 1e-4, *d, *f)
                        )
                        clock += 4.0
                    clock += 16.0
        names = ("pose", "theta1", "theta2", "axis", "rep", "step", "t", "temp", "dx", "dz", "fx", "fz")
        self.columns = {name: [row[place] for row in rows] for place, name in enumerate(names)}
        self.rows = len(rows)

    def __getitem__(self, name: str) -> np.ndarray:
        values: np.ndarray = np.array(self.columns[name])
        return values


def text(header: list[str], columns: list[list[str]], separator: str, end: str = "\n") -> str:
    """A table as text."""
    return end.join([*(header), *(separator.join(row) for row in zip(*columns))]) + end


def shown(values: np.ndarray, form: str = "%.4f", comma: bool = False) -> list[str]:
    """Numbers as text."""
    texts = [form % value for value in values]
    return [text.replace(".", ",") for text in texts] if comma else texts


def workbook(rows: list[list[object]]) -> bytes:
    """An .xlsx of one sheet, written without the library that reads it."""
    lines = []
    for number, row in enumerate(rows, start=1):
        cells = []
        for place, value in enumerate(row):
            at = f"{chr(65 + place)}{number}"
            if isinstance(value, str):
                cells.append(f'<c r="{at}" t="inlineStr"><is><t>{value}</t></is></c>')
            elif value is not None:
                cells.append(f'<c r="{at}"><v>{value!r}</v></c>')
        lines.append(f'<row r="{number}">{"".join(cells)}</row>')
    space = 'xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"'
    relation = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006"
    kind = "application/vnd.openxmlformats-officedocument.spreadsheetml"
    files = {
        "[Content_Types].xml": f'<Types xmlns="{package}/content-types">'
        f'<Default Extension="rels" ContentType="application/'
        f'vnd.openxmlformats-package.relationships+xml"/><Default Extension="xml" ContentType="application/xml"/>'
        f'<Override PartName="/xl/workbook.xml" ContentType="{kind}.sheet.main+xml"/>'
        f'<Override PartName="/xl/worksheets/sheet1.xml" ContentType="{kind}.worksheet+xml"/></Types>',
        "_rels/.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="rId1" '
        f'Type="{relation}/officeDocument" Target="xl/workbook.xml"/></Relationships>',
        "xl/workbook.xml": f'<workbook {space} xmlns:r="{relation}"><sheets>'
        f'<sheet name="Messung 1" sheetId="1" r:id="rId1"/>'
        "</sheets></workbook>",
        "xl/_rels/workbook.xml.rels": f'<Relationships xmlns="{package}/relationships"><Relationship Id="rId1" '
        f'Type="{relation}/worksheet" Target="worksheets/sheet1.xml"/></Relationships>',
        "xl/worksheets/sheet1.xml": f"<worksheet {space}><sheetData>{''.join(lines)}</sheetData></worksheet>",
    }
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in files.items():
            archive.writestr(name, '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>' + content)
    return buffer.getvalue()


def own_headers(folder: Path) -> list[Path]:
    """Names with units, millimetres and newtons, degrees."""
    r = Record()
    header = ["Time (s),Femur angle (deg),Knee angle (deg),Axis,Trial,Disp X (mm),Disp Z (mm),Force X (N),Force Z (N)"]
    columns = [shown(r["t"], "%.1f"), shown(r["theta1"], "%.2f"), shown(r["theta2"], "%.2f"), list(r["axis"]),
               [str(v) for v in r["rep"]], shown(r["dx"]), shown(r["dz"]), shown(r["fx"]), shown(r["fz"])]  # fmt: skip
    path = folder / "own.csv"
    path.write_text(text(header, columns, ","))
    return [path]


def german(folder: Path) -> list[Path]:
    """Windows-1252, semicolons, decimal commas, umlauts, metres, kilonewtons."""
    r = Record()
    header = ["Zeit [s];H\u00fcftwinkel [\u00b0];Kniewinkel [\u00b0];Temperatur [\u00b0C];"
              "Weg X [m];Weg Z [m];Kraft X [kN];"
              "Kraft Z [kN]"]  # fmt: skip
    columns = [shown(r["t"], "%.2f", True), shown(r["theta1"], "%.2f", True), shown(r["theta2"], "%.2f", True),
               shown(r["temp"], "%.1f", True), shown(r["dx"] / 1e3, "%.6f", True), shown(r["dz"] / 1e3, "%.6f", True),
               shown(r["fx"] / 1e3, "%.7f", True), shown(r["fz"] / 1e3, "%.7f", True)]  # fmt: skip
    path = folder / "messung.csv"
    path.write_bytes(text(header, columns, ";", "\r\n").encode("cp1252"))
    return [path]


def pounds_and_inches(folder: Path) -> list[Path]:
    """lbf, inches, Fahrenheit, milliseconds, snake case; one of the forces turned."""
    r = Record()
    header = ["sample,t_ms,hip_deg,knee_deg,temp_degF,disp_x_in,disp_z_in,load_x_lbf,load_z_lbf"]
    columns = [[str(n) for n in range(r.rows)], shown(r["t"] * 1e3, "%.0f"), shown(r["theta1"]), shown(r["theta2"]),
               shown(r["temp"] * 1.8 + 32), shown(r["dx"] / 25.4, "%.6f"), shown(r["dz"] / 25.4, "%.6f"),
               shown(-r["fx"] / LBF_N, "%.6f"), shown(-r["fz"] / LBF_N, "%.6f")]  # fmt: skip
    path = folder / "rig.csv"
    path.write_text(text(header, columns, ","))
    return [path]


def degrees_without_unit(folder: Path) -> list[Path]:
    """Bare names: theta1, theta2 in degrees by their size; force and displacement without a unit."""
    r = Record()
    header = ["t;theta1;theta2;dx;dz;fx;fz"]
    columns = [shown(r[name]) for name in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")]
    path = folder / "bare.csv"
    path.write_text(text(header, columns, ";"))
    return [path]


def one_axis(folder: Path) -> list[Path]:
    """A load cell of one axis that stands along the motion; no temperature, no repeats."""
    r = Record(repeats=1)
    along = np.where(r["axis"] == "z", r["fz"], r["fx"])
    moved = r["dx"] + r["dz"]
    header = ["time_s,theta1_deg,theta2_deg,direction,displacement_mm,load_cell_N"]
    columns = [shown(r["t"]), shown(r["theta1"]), shown(r["theta2"]),
               ["vertical" if axis == "z" else "horizontal" for axis in r["axis"]],
               shown(moved), shown(along)]  # fmt: skip
    path = folder / "cell.csv"
    path.write_text(text(header, columns, ","))
    return [path]


def gaps(folder: Path) -> list[Path]:
    """NaN, blanks and an overload among the readings."""
    r = Record()
    fx = shown(r["fx"])
    fx[5], fx[40], fx[41] = "NaN", "", "OVL"
    header = ["time [s],q1 [rad],q2 [rad],ux [mm],uz [mm],Fx [N],Fz [N]"]
    columns = [shown(r["t"]), shown(np.radians(r["theta1"]), "%.6f"), shown(np.radians(r["theta2"]), "%.6f"),
               shown(r["dx"]), shown(r["dz"]), fx, shown(r["fz"])]  # fmt: skip
    path = folder / "gaps.csv"
    path.write_text(text(header, columns, ","))
    return [path]


def two_files(folder: Path) -> list[Path]:
    """A file for each axis, the posture in a remark, each with a clock of its own."""
    paths = []
    for axis in "xz":
        r = Record(poses=POSES_DEG[:1], axes=axis)
        header = ["# Femur angle: 42.5 deg", "# Knee angle: 57.25 deg", "Time [s],Displacement [mm],Force [N]"]
        path = folder / f"test_{axis}.csv"
        path.write_text(text(header, [shown(r["t"]), shown(r["dx"] + r["dz"]), shown(r[f"f{axis}"])], ","))
        paths.append(path)
    return paths


def semicolons(folder: Path) -> list[Path]:
    """Semicolons with decimal points, blanks around, a line of words below."""
    r = Record()
    header = ["Run ; Time / s ; Femur / deg ; Knee / deg ; dx / mm ; dz / mm ; Fx / N ; Fz / N"]
    run = np.cumsum(np.array(r["step"]) == 0)
    columns = [[str(v) for v in run], *(shown(r[n]) for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz"))]
    path = folder / "semi.txt"
    path.write_text(text(header, columns, " ; ") + "\nend of test\n")
    return [path]


def matlab(folder: Path) -> list[Path]:
    """writetable's CSV: camel case, no units in the names, %.15g numbers, NaN."""
    r = Record()
    header = ["tSec,thetaFemurDeg,thetaKneeDeg,dispX_mm,dispZ_mm,forceX_N,forceZ_N"]
    columns = [shown(r[n], "%.15g") for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")]
    path = folder / "matlab.csv"
    path.write_text(text(header, columns, ","))
    return [path]


def units_row(folder: Path) -> list[Path]:
    """A spreadsheet's export: names, then a row of units, tabs."""
    r = Record()
    header = [
        "Zeit\tFemurwinkel\tKniewinkel\tWeg x\tWeg z\tKraft x\tKraft z\tBemerkung",
        "s\t\u00b0\t\u00b0\tmm\tmm\tN\tN\t",
    ]
    columns = [*(shown(r[n], comma=True) for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz")), [""] * r.rows]
    path = folder / "export.txt"
    path.write_bytes(b"\xff\xfe" + text(header, columns, "\t", "\r\n").encode("utf-16-le"))
    return [path]


def excel(folder: Path) -> list[Path]:
    """Excel's own file, a title above the table."""
    r = Record()
    names = [
        "Time [s]",
        "Femur [deg]",
        "Knee [deg]",
        "Displacement X [mm]",
        "Displacement Z [mm]",
        "Force X [N]",
        "Force Z [N]",
    ]
    rows: list[list[object]] = [["Limb 3, before repair"], [], list(names)]
    for row in zip(*(r[n].tolist() for n in ("t", "theta1", "theta2", "dx", "dz", "fx", "fz"))):
        rows.append(list(row))
    path = folder / "book.xlsx"
    path.write_bytes(workbook(rows))
    return [path]


def free_text(folder: Path) -> list[Path]:
    """A rig's own header of free text, blocks for each run, blanks between columns."""
    r = Record(poses=POSES_DEG[:1])
    lines = ["LIMB TEST RIG v2.3", "Operator: M. Keller", "Date: 12.03.2026 14:22", "Load cell: 6-axis, s/n 4411",
             "Femur angle = 42,5 deg", "Knee angle = 57,25 deg", "Temperature: 21,5 \u00b0C", ""]  # fmt: skip
    for first in range(0, r.rows, len(PATH)):
        rows = slice(first, first + len(PATH))
        lines += [f"--- run {first // len(PATH) + 1} ---", "   t[s]    dx[mm]   dz[mm]     Fx[N]     Fz[N]"]
        for row in zip(*(shown(r[n][rows], comma=True) for n in ("t", "dx", "dz", "fx", "fz"))):
            lines.append("  ".join(cell.rjust(9) for cell in row))
        lines.append("")
    path = folder / "rig.dat"
    path.write_text("\n".join(lines), encoding="utf-8")
    return [path]

"""Units, numbers and names as people write them."""

from __future__ import annotations

import math

import pytest

from brace.ground.units import unit_of
from brace.importing import names, numerals
from brace.importing.meaning import target_of


@pytest.mark.parametrize(
    ("text", "quantity", "factor"),
    [
        ("mm", "length", 1.0),
        ("[m]", "length", 1e3),
        ("\u00b5m", "length", 1e-3),
        ("Inch", "length", 25.4),
        ("kN", "force", 1e3),
        ("mN", "force", 1e-3),
        ("(lbf)", "force", 4.4482216152605),
        ("kg", "force", 9.80665),
        ("\u00b0", "angle", math.pi / 180),
        ("degrees", "angle", math.pi / 180),
        ("arcmin", "angle", math.pi / 10800),
        ("sec", "time", 1.0),
        ("ms", "time", 1e-3),
        ("Nm", "torque", 1e3),
        ("N\u00b7m", "torque", 1e3),
        ("Nmm", "torque", 1.0),
        ("N*mm", "torque", 1.0),
        ("in-lb", "torque", 4.4482216152605 * 25.4),
        ("mNm", "torque", 1.0),
        ("N/m", "stiffness", 1e-3),
        ("N/mm", "stiffness", 1.0),
        ("in mm", "length", 1.0),
    ],
)
def test_units(text: str, quantity: str, factor: float) -> None:
    unit = unit_of(text)
    assert unit is not None and unit.quantity == quantity and unit.factor == pytest.approx(factor, rel=1e-9)


@pytest.mark.parametrize("text", ["", "X", "time [s", "x in", "Fx", "mV/V", "run", "N N"])
def test_what_is_no_unit(text: str) -> None:
    assert unit_of(text) is None


def test_degrees_celsius_and_fahrenheit_have_an_offset() -> None:
    for text, number, degc in (("K", 295.15, 22.0), ("\u00b0F", 71.6, 22.0), ("\u00b0C", 22.0, 22.0)):
        unit = unit_of(text)
        assert unit is not None and unit.factor * number + unit.offset == pytest.approx(degc)


@pytest.mark.parametrize(
    ("name", "row", "target", "unit"),
    [
        ("Kraft X [kN]", "", "fx_n", "kN"),
        ("Force_Z_N", "", "fz_n", "N"),
        ("Fx / N", "", "fx_n", "N"),
        ("Fz(lbf)", "", "fz_n", "lbf"),
        ("load_x_lbf", "", "fx_n", "lbf"),
        ("Force in lbf", "", "f_n", "lbf"),
        ("Fx_in_N", "", "fx_n", "N"),
        ("Kraft", "N", "f_n", "N"),
        ("Weg in mm", "", "d_mm", "mm"),
        ("disp_x_in", "", "dx_mm", "in"),
        ("Verschiebung z", "mm", "dz_mm", "mm"),
        ("uz", "", "dz_mm", None),
        ("Kniewinkel [\u00b0]", "", "theta2_rad", "deg"),
        ("H\u00fcftwinkel / Grad", "", "theta1_rad", "deg"),
        ("theta_1 (rad)", "", "theta1_rad", "rad"),
        ("q2_deg", "", "theta2_rad", "deg"),
        ("Joint 2 angle [deg]", "", "theta2_rad", "deg"),
        ("thetaFemurDeg", "", "theta1_rad", "deg"),
        ("forceXMN", "", "fx_n", None),
        ("forceXKN", "", "fx_n", None),
        ("knee (deg)", "", "theta2_rad", "deg"),
        ("tSec", "", "t_s", "s"),
        ("Zeit", "s", "t_s", "s"),
        ("Timestamp", "", "t_s", None),
        ("T [\u00b0C]", "", "temp_degc", "degC"),
        ("Temperatur_Motor [\u00b0C]", "", "temp_degc", "degC"),
        ("Mass [kg]", "", "weight_n", "kgf"),
        ("Gewicht in g", "", "weight_n", "gf"),
        ("Fy [N]", "", "?", "N"),
        ("angle [deg]", "", "?", "deg"),
        ("Direction", "", "axis", None),
        ("Trial", "", "run", None),
        ("Wiederholung", "", "rep", None),
        ("Comment", "", "ignore", None),
        ("No.", "", "ignore", None),
        ("speed [mm/s]", "", "ignore", None),
        ("dial gauge base x [mm]", "", "base_x_mm", "mm"),
        ("enc2 [mrad]", "", "enc2_rad", "mrad"),
        ("X_Value", "", "t_s", None),
        ("Down stage (mil)", "", "dz_mm", "mil"),
        ("downward load [cN]", "", "fz_n", "cN"),
        ("shank angle [deg]", "", "?", "deg"),
        ("shank joint angle [deg]", "", "theta2_rad", "deg"),
    ],
)
def test_names_of_a_loading_record(name: str, row: str, target: str, unit: str | None) -> None:
    read = names.read(name, row)
    assert target_of(read, "loading")[0] == target
    assert (read.unit.text if read.unit else None) == unit


def test_decimal_signs() -> None:
    assert numerals.decimal_sign(["0,635", "1,27"])[0] == ","
    assert numerals.decimal_sign(["1.234,5", "2"])[0] == ","
    assert numerals.decimal_sign(["1,234.5", "2"])[0] == "."
    assert numerals.decimal_sign(["1,234", "5,678"])[0] == ""  # thousands, or decimals?
    assert numerals.decimal_sign(["1.5", "2,5"])[0] == "?"
    assert numerals.number("1.234,5", ",") == 1234.5 and numerals.number("\u22121,5e-3", ",") == -1.5e-3
    assert math.isnan(numerals.number("OVL", ".")) and math.isnan(numerals.number("1_000", "."))


def test_clock_times() -> None:
    assert numerals.clock_s("12:30:05.5") == 45005.5 and numerals.clock_s("01:00:00 PM") == 46800.0
    day = numerals.clock_s("12.03.2026 14:22:01,25") - numerals.clock_s("12.03.2026 14:22:00")
    assert day == pytest.approx(1.25) and math.isnan(numerals.clock_s("12.5"))


@pytest.mark.parametrize(
    "dates, days",
    [(("12/03/2026", "13/03/2026"), 1), (("03/12/2026", "03/13/2026"), 1), (("11/12/2026", "12/12/2026"), 1),
     (("12/11/2026", "12/12/2026"), 1), (("31/01/2026", "01/02/2026"), 1)],
)  # fmt: skip
def test_dates_of_a_column_are_of_one_form(dates: tuple[str, str], days: int) -> None:
    """Read cell by cell, 12/03 was the third of December and 13/03 the thirteenth of March."""
    first, last = numerals.clocks_s([f"{date} 00:00:01" for date in dates])
    assert last - first == days * numerals.DAY_S


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("Force kN", "kN"), ("Force in kN", "kN"), ("Fx mN", "mN"), ("Fx daN", "daN"), ("Fx cN", "cN"),
        ("Torque mNm", "mN m"), ("Torque kNm", "kN m"), ("Angle mRad", "mrad"), ("Fx N", "N"), ("Time ms", "ms"),
        ("forceXN", "N"), ("ForceKN", None), ("forceXkN", None), ("forceXdaN", None), ("tauMNm", None),
    ],
)  # fmt: skip
def test_a_units_prefix_behind_a_name_counts(name: str, unit: str | None) -> None:
    """What may be a prefix, or the name's last letter, is asked."""
    read = names.read(name)
    assert (read.unit.text if read.unit else None) == unit


@pytest.mark.parametrize(
    ("text", "decimal", "value"),
    [("3,8", ".", None), ("0,635", ".", None), ("1.234,5", ".", None), ("1,5", ",", 1.5), ("12.5", ",", None),
     ("1,234", ".", 1234.0), ("1,234.5", ".", 1234.5), ("-12.345.678,9e1", ",", -123456789.0), ("1'234.5", ".", 1234.5),
     ("12,34,567", ".", None)],
)  # fmt: skip
def test_thousands_are_groups_of_three_digits(text: str, decimal: str, value: float | None) -> None:
    """3,8 with a decimal point was 38."""
    read = numerals.number(text, decimal)
    assert math.isnan(read) if value is None else read == value


@pytest.mark.parametrize(
    ("name", "row", "units"),
    [
        ("dx_um [mm]", "", "um mm"), ("Fx_mN [N]", "", "mN N"), ("theta1_deg (rad)", "", "deg rad"), ("Fz kN [N]", "", "kN N"),
        ("dx_um", "mm", "um mm"), ("dx [um]", "mm", "um mm"), ("dx_mm [mm]", "", ""), ("Weg in [mm]", "", ""),
        ("Fx_min [N]", "", ""), ("dx_rel [mm]", "", ""), ("theta1_deg [\u00b0]", "", ""),
    ],
)  # fmt: skip
def test_a_name_that_says_two_units_has_both(name: str, row: str, units: str) -> None:
    read = names.read(name, row)
    assert [each.text for each in read.meanings] == units.split()
    assert (read.unit is None) == bool(units)

"""Files of diagonal measurements and linear tests: what is read, and every way to be refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from diagonal_kit import ALIGNED, TRAVEL, apart, published, readings
from step_diagonal_kit import diagonals_csv, simulate_step_diagonal

from gcxform.calibrate.csv_text import parse_csv, read_csv
from gcxform.calibrate.diagonal.file import (
    parse_diagonals,
    parse_linear,
    read_diagonals,
    read_linear,
)
from gcxform.calibrate.diagonal.readings import FOUR, Leg, Volume, plain_diagonals, step_diagonals
from gcxform.calibrate.diagonal.step_diagonal import identify
from gcxform.diagnostics import FileError, InputError

VOLUME = Volume(np.zeros(3), np.array(TRAVEL), 2)
HEADER = "diagonal,X [mm],Y [mm],Z [mm],reading [mm]"


def table(header: str = HEADER, scale: float = 1.0) -> str:
    """Return readings along the box of 30, 60, 60 mm in 3 steps, on a machine without errors."""
    size = np.array([30.0, 60.0, 60.0])
    lines = [header]
    for leg in simulate_step_diagonal(published(), (0, 0, 0), size, 3):
        beam = np.array(leg.signs) * size / 90.0
        for stop, at in zip(leg.position, (leg.position - leg.position[0]) @ beam, strict=True):
            x, y, z = (f"{v * scale:g}" for v in stop)
            lines.append(f"{leg.name},{x},{y},{z},{at * scale:.4f}")
    return "\n".join(lines) + "\n"


GOOD = table()
"""
diagonal,X [mm],Y [mm],Z [mm],reading [mm]
ppp,0,0,0,0.0000
ppp,10,0,0,3.3333
ppp,10,20,0,16.6667
ppp,10,20,20,30.0000
ppp,20,20,20,33.3333
ppp,20,40,20,46.6667
ppp,20,40,40,60.0000
ppp,30,40,40,63.3333
ppp,30,60,40,76.6667
ppp,30,60,60,90.0000
npp,30,0,0,0.0000
...
"""


def line(number: int, old: str, new: str) -> Callable[[str], str]:
    """Return a change of one line (from 1) of a file."""

    def change(text: str) -> str:
        lines = text.split("\n")
        assert old in lines[number - 1], lines[number - 1]
        lines[number - 1] = lines[number - 1].replace(old, new, 1)
        return "\n".join(lines)

    return change


def without(*numbers: int) -> Callable[[str], str]:
    """Return a change that leaves out lines."""

    def change(text: str) -> str:
        return "\n".join(t for k, t in enumerate(text.split("\n"), 1) if k not in numbers)

    return change


BAD = [
    # what, place, code, message
    (lambda text: "", "", "GX470", "is empty"),
    (lambda text: "# nothing\n\n" + HEADER, "", "GX470", "header and no rows"),
    (line(1, ",reading [mm]", ""), "2:11", "GX471", "5 of 4 columns"),
    (line(1, "Y [mm]", "X [mm]"), "1:17", "GX470", "stands twice"),
    (line(1, "diagonal,", ","), "1:1", "GX470", "no name"),
    (line(1, "Z [mm]", "Zed [mm]"), "1:24", "GX470", "'zed' means nothing"),
    (line(1, "Z [mm]", "humidity [%]"), "1:1", "GX470", "lacks the column z"),
    (line(1, "reading [mm]", "temperature [degC]"), "1:1", "GX470", "neither of the columns"),
    (line(1, "Z [mm]", "deviation [um]"), "1:1", "GX470", "lacks the column z"),
    (line(1, "X [mm]", "X"), "1:10", "GX470", "'x' has no unit"),
    (line(1, "reading [mm]", "reading"), "1:31", "GX470", "'reading' has no unit"),
    (line(1, "reading [mm]", "reading [furlong]"), "1:31", "GX470", "'furlong' is not a unit"),
    (line(5, "30.0000", "nan"), "5:14", "GX471", "nan is not a reading"),
    (line(5, "30.0000", "-inf"), "5:14", "GX471", "-inf is not a reading"),
    (line(5, "30.0000", "1e999"), "5:14", "GX471", "too large"),
    (line(5, "30.0000", ""), "5:14", "GX471", "a number is missing"),
    (line(5, "30.0000", "30.0000 mm"), "5:14", "GX471", "'30.0000 mm' is not a number"),
    (line(5, "30.0000", "30,0000"), "5:17", "GX471", "6 of 5 columns"),
    (line(5, ",30.0000", ""), "5:11", "GX471", "4 of 5 columns"),
    (line(4, "ppp", "pp"), "4:1", "GX472", "'pp' is not a diagonal"),
    (line(4, "ppp", "ppz"), "4:1", "GX472", "'ppz' is not a diagonal"),
    (line(6, "20,20,20", "22,20,20"), "6:5", "GX472", "X is 22 mm where 20 is due"),
    (line(5, "10,20,20", "10,20,18"), "5:11", "GX472", "Z is 18 mm where 20 is due"),
    (line(2, "0,0,0", "1,0,0"), "2:5", "GX472", "X is 1 mm where 0 is due"),
    (without(4), "4:11", "GX472", "where Y is due the diagonal ppp moves Y and Z"),
    (without(11), "10:1", "GX472", "ends within a step"),
    (without(10, 11), "9:1", "GX472", "ends within a step"),
    (without(*range(4, 12)), "2:1", "GX472", "has 2 readings"),
    (lambda text: text.replace("ppn", "npn"), "41:5", "GX472", "X goes by 30 mm and not down"),
    (without(*range(12, 22)), "", "GX473", "the diagonal npp is missing"),
    (without(*range(12, 32)), "", "GX473", "the diagonals npp and pnp are missing"),
    (without(12, 13, 14), "12:1", "GX473", "the diagonal npp has 2 steps and ppp 3"),
    (
        lambda text: re.sub(r"npp,(\d+)", lambda m: f"npp,{int(m[1]) + 1}", text),
        "12:5",
        "GX473",
        "npp goes from 1 to 31 mm in X, and ppp from 0 to 30",
    ),
]


@pytest.mark.parametrize(("change", "place", "code", "message"), BAD)
def test_a_bad_file_is_refused_at_its_place(change, place, code, message, tmp_path):
    path = tmp_path / "d.csv"
    path.write_text(change(GOOD))
    with pytest.raises(InputError) as refusal:
        read_diagonals(path)
    first = refusal.value.diagnostics[0]
    shown = first.render()
    assert (first.code, message in first.message) == (code, True), shown
    assert shown.startswith(f"{path}:{place}: " if place else f"{path}: "), shown
    assert bool(re.search(r"^ +\| +\^+$|^ +\| \^+$", shown, re.MULTILINE)) == bool(place), shown


def test_a_good_file_is_read():
    found = parse_diagonals(GOOD)
    assert found.diagonals.volume.steps == 3
    assert found.diagonals.volume.travel.tolist() == [30, 60, 60]
    assert [leg.name for leg in found.diagonals.legs] == ["ppp", "npp", "pnp", "ppn"]
    assert max(np.abs(leg.deviation).max() for leg in found.diagonals.legs) < 5.1e-5


def test_all_bad_readings_are_shown():
    with pytest.raises(InputError) as refusal:
        parse_diagonals(line(5, "30.0000", "nan")(line(7, "46.6667", "x")(GOOD)))
    assert [d.where.line for d in refusal.value.diagnostics if d.where] == [5, 7]


@pytest.mark.parametrize(
    "change",
    [
        lambda text: "\ufeff# by laser\n\n" + text,
        lambda text: text.replace(",", " ; "),
        lambda text: text.replace(",", "\t"),
        lambda text: text.replace("\n", "\r\n"),
        lambda text: text.upper().replace("[MM]", "[ mm ]"),
        lambda text: text.replace("p", "+").replace("\nn++", "\n-++").replace("n", "-").replace(
            HEADER.replace("n", "-"), HEADER),
        lambda text: table(HEADER.replace("[mm]", "[um]"), 1e3),
        lambda text: table(HEADER.replace("[mm]", "[in]"), 1 / 25.4),
        lambda text: table(HEADER.replace("[mm]", "[m]"), 1e-3).replace("e-", "E-"),
    ],
    ids=["mark", "semicolons", "tabs", "crlf", "case", "signs", "um", "in", "m"],
)  # fmt: skip
def test_forms_of_the_same_file(change, tmp_path):
    path = tmp_path / "d.csv"
    path.write_bytes(change(GOOD).encode())
    found, good = read_diagonals(path).diagonals, parse_diagonals(GOOD).diagonals
    assert [leg.signs for leg in found.legs] == [leg.signs for leg in good.legs]
    for one, other in zip(found.legs, good.legs, strict=True):
        assert one.position == pytest.approx(other.position, abs=2e-3)
        assert one.deviation == pytest.approx(other.deviation, abs=0.06)


def test_columns_may_stand_in_any_order():
    cells = [row.split(",") for row in GOOD.strip().split("\n")]
    text = "\n".join(",".join((e, c, a, d, b)) for a, b, c, d, e in cells)
    found, good = parse_diagonals(text).diagonals, parse_diagonals(GOOD).diagonals
    for one, other in zip(found.legs, good.legs, strict=True):
        assert one.deviation.tolist() == other.deviation.tolist()


def test_readings_are_deviations_behind_their_nominal(tmp_path):
    """A reading is the distance along the beam, a deviation what is more; S1 by either."""
    size, lines = np.array(TRAVEL), [HEADER]
    for leg in readings().legs:
        beam = np.array(leg.signs) * size / np.linalg.norm(size)
        shown = (leg.position - leg.position[0]) @ beam + leg.deviation + 12.5
        for (x, y, z), at in zip(leg.position.tolist(), shown.tolist(), strict=True):
            lines.append(f"{leg.name},{x!r},{y!r},{z!r},{at!r}")
    found = identify(parse_diagonals("\n".join(lines)).diagonals, assumed=ALIGNED)
    assert apart(found.model(), published()) <= 2e-12


def test_ways_back_are_marked_by_their_direction():
    size = np.array([20.0, 40.0, 40.0])
    legs = simulate_step_diagonal(published(), (0, 0, 0), size, 2, bidirectional=True)
    text = diagonals_csv(legs)
    found = parse_diagonals(text).diagonals
    assert [leg.forward for leg in found.legs] == [True, False] * 4
    for code, bad in (("GX472", text.replace(",-,", ",+,")), ("GX472", text.replace(",-,", ",x,")),
                      ("GX472", text.replace(",-,", ",,"))):  # fmt: skip
        with pytest.raises(InputError, match=code):
            parse_diagonals(bad)


def test_a_file_that_is_not_there_and_one_that_is_not_text(tmp_path):
    with pytest.raises(FileError, match="GX901"):
        read_csv(tmp_path / "none.csv")
    (tmp_path / "d.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="GX470"):
        read_csv(tmp_path / "d.csv")


def test_two_rows_a_diagonal_are_a_plain_test():
    rows = GOOD.split("\n")
    ends = "\n".join([rows[0], *(rows[k] for n in range(4) for k in (1 + 10 * n, 10 + 10 * n))])
    found = parse_diagonals(ends, plain=True).diagonals
    assert found.volume.travel.tolist() == [30, 60, 60]
    with pytest.raises(InputError, match="GX472"):
        parse_diagonals(ends)
    with pytest.raises(InputError, match=r"GX472.*one reading"):
        parse_diagonals(without(2)(ends), plain=True)
    with pytest.raises(InputError, match=r"GX472.*goes nowhere and not down"):
        parse_diagonals(line(5, "0,60,60", "30,60,60")(ends), plain=True)
    with pytest.raises(InputError, match=r"GX473.*from 0 to 31 mm in X"):
        parse_diagonals(line(9, "30,60,0", "31,60,0")(ends), plain=True)


# --- without a file ---


def test_legs_without_a_file_are_checked_as_well():
    legs = list(readings().legs)
    with pytest.raises(InputError, match="GX473"):
        step_diagonals(legs[:3])
    with pytest.raises(InputError, match="GX473"):
        step_diagonals([])
    with pytest.raises(InputError, match="GX473"):
        plain_diagonals([])
    short = Leg(FOUR[0], legs[0].position[:16], legs[0].deviation[:16])
    with pytest.raises(InputError, match=r"GX473.*5 steps and"):
        step_diagonals([short, *legs[1:]][::-1])


# --- linear tests ---

LINEAR = "X [mm],run,direction,deviation [um],temperature [degC]\n" + "".join(
    f"{at},{run},+,{-at / 48},20.5\n" for run in (1, 2) for at in range(0, 481, 96)
)
BAD_LINEAR = [
    (line(1, "X [mm]", "A [deg]"), "1:1", "GX470", "'a' means nothing"),
    (line(1, "run", "Y [mm]"), "1:1", "GX470", "has X and Y"),
    (line(1, "X [mm]", "humidity [%]"), "1:1", "GX470", "has no axis"),
    (line(1, "deviation [um]", "pressure [hPa]"), "1:1", "GX470", "lacks the column deviation"),
    (line(1, "[um]", "[arcsec]"), "1:22", "GX470", "'arcsec' is not a unit"),
    (line(3, "-2.0", "NaN"), "3:8", "GX471", "NaN is not a reading"),
    (line(7, "480", "481"), "7:1", "GX474", "X 481 is outside the diagonals, 0 to 480 mm"),
    (line(2, "0,1", "-0.1,1"), "2:1", "GX474", "X -0.1 is outside"),
    (line(2, "0,1", "0,0"), "2:1", "GX474", "needs two positions"),
    (line(4, ",+,", ",up,"), "4:7", "GX472", "'up' is not a direction"),
]


def test_a_linear_test_is_read():
    found = parse_linear(LINEAR, VOLUME)
    assert len(found.tests) == 2
    assert found.tests[1].axis == 0
    assert found.tests[1].deviation == pytest.approx(-np.arange(0, 11, 2) * 1e-3)
    assert found.conditions["temperature"]["mean"] == 20.5


@pytest.mark.parametrize(("change", "place", "code", "message"), BAD_LINEAR)
def test_a_bad_linear_test_is_refused_at_its_place(change, place, code, message, tmp_path):
    path: Path = tmp_path / "x.csv"
    path.write_text(change(LINEAR))
    with pytest.raises(InputError) as refusal:
        read_linear(path, VOLUME)
    first = refusal.value.diagnostics[0]
    assert (first.code, message in first.message) == (code, True), first.render()
    assert first.render().startswith(f"{path}:{place}: "), first.render()
    assert re.search(r"^ +\| +\^+$|^ +\| \^+$", first.render(), re.MULTILINE)


def test_cells_keep_their_columns():
    found = parse_csv("a [mm] , b\n 1 ,  2\n")
    assert found.where(0, "a").column == 2
    assert found.where(0, "b").column == 7
    assert found.heading_place("b").column == 10

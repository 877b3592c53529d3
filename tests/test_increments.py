"""What numbers without a point are worth: each system against a scalar computation with fractions.

LinuxCNC is no oracle here: to it 1 is always 1 unit.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gcxform as gx
from gcxform.dialect.increments import Increments

INCH = Fraction(254, 10)
STEPS = {f"IS-{letter}": Fraction(10) ** (-2 - k) for k, letter in enumerate("ABCDE")}
"""Of mm and degrees; a tenth of it of inches."""


def worth(said: str, written: str, axis: str, inch: bool) -> Fraction | None:
    """Return a word in mm or degrees, worked out by itself; None where nothing says it."""
    unit = Fraction(1) if axis == "A" or not inch else INCH
    number = Fraction(written)
    if "." in written or "calculator" in said or not number:
        return number * unit
    if said in STEPS:
        return number * STEPS[said] * (1 if axis == "A" or not inch else Fraction(1, 10)) * unit
    length, _, angle = said.partition(",")
    if axis == "A":
        return number * Fraction(angle.split()[0]) if angle else None
    size, name = length.split()
    return number * Fraction(size) * {"um": Fraction(1, 1000), "mm": 1, "in": INCH}[name]


SAID = st.sampled_from(
    (*STEPS, "calculator", "calculator IS-C", "1 um", "0.0001 in", "0.01 mm", "0.01 mm, 0.005 deg")
)
NUMBER = st.one_of(
    st.integers(-99999, 99999).map(str),
    st.decimals(-99, 99, places=3).map(lambda d: f"{d:f}"),
)
BLOCKS = st.lists(
    st.tuples(st.sampled_from(("", "G20", "G21")), st.sampled_from("XYA"), NUMBER), max_size=12
)


@given(SAID, st.sampled_from(("", "in")), BLOCKS)
def test_every_system_under_every_unit(
    said: str, units: str, blocks: list[tuple[str, str, str]]
) -> None:
    lines, at, expected = ["G0 X0 Y0 A0"], {"X": 0.0, "Y": 0.0, "A": 0.0}, []
    inch, known = units == "in", True
    for code, axis, number in blocks:
        inch = {"G20": True, "G21": False}.get(code, inch)
        lines.append(f"{code} G0 {axis}{number}")
        value = worth(said, number, axis, inch)
        known = known and value is not None
        at[axis] = float(value or 0)
        expected.append([at[a] for a in "XYA"])
    program = gx.read("\n".join(lines).encode(), "fanuc", increment=said, units=units)
    if not known:
        with pytest.raises(gx.InputError, match="GX205"):
            _ = program.path
        return
    path = program.path
    columns = [path.axes.index(axis) for axis in "XYA" if axis in path.axes]
    found = path.end[1:, columns]
    wanted = np.array(expected).reshape(-1, 3)[:, : len(columns)]
    np.testing.assert_allclose(found, wanted, rtol=1e-15, atol=1e-15)


@pytest.mark.parametrize(
    ("said", "value"),
    [
        ("IS-B", 1 / 3 // 0.001 * 0.001),
        ("IS-A", 0.33),
        ("IS-C", 0.3333),
        ("calculator IS-B", 0.333),
    ],
)
def test_what_is_computed_is_rounded_and_not_counted(said: str, value: float) -> None:
    text = b"#100=1/3\nG21 G0 X#100 Y[#100*300]"
    end = gx.read(text, "fanuc", increment=said).path.end[-1]
    assert end[:2] == pytest.approx([value, 100], abs=1e-12)


@pytest.mark.parametrize(
    ("said", "seconds"),
    [("IS-B", 2.5), ("calculator", 2500.0), ("IS-C", None), ("1 um", None), (None, None)],
)
def test_a_dwell_by_x(said: str | None, seconds: float | None) -> None:
    (event,) = gx.read(b"G0 X0\nG4 X2500", "fanuc", increment=said).path.events
    wanted = ("increments", 2500.0) if seconds is None else ("seconds", seconds)
    assert event.values == (wanted,)


@pytest.mark.parametrize(
    ("said", "kind"), [(None, "seconds"), ("IS-B", "seconds"), ("IS-C", "increments")]
)
def test_a_dwell_by_p(said: str | None, kind: str) -> None:
    (event,) = gx.read(b"G0 X0\nG4 P2500", "fanuc", increment=said).path.events
    assert event.values == ((kind, 2.5 if kind == "seconds" else 2500.0),)


@pytest.mark.parametrize(
    "said", ["", "IS-F", "is-b", "IS-B IS-C", "calculator calculator", "0 mm", "-1 um", -0.001]
)
def test_what_is_no_increment_is_refused(said: str | float) -> None:
    with pytest.raises(gx.UsageError, match=r"GX70[68]"):
        gx.read(b"G0 X0", "fanuc", increment=said)


def test_a_length_and_a_system_are_one_in_mm() -> None:
    length, system = Increments.of(0.001), Increments.of("IS-B")
    assert (length.mm, length.degree) == (system.mm, None) == (1000.0, None)
    assert Increments.of("0.0001 in").inch == system.inch == 10_000.0


@pytest.mark.parametrize(
    ("text", "readings"),
    [
        (b"G21 G0 X150000", ("X1000 is 1 mm", "1000 mm", "X150000 would be 150 or 150000 mm")),
        (b"G20 G0 X15000", ("X1000 is 0.1 inch", "1000 inch", "X15000 would be 1.5 or 15000 inch")),
        (b"G20 G0 A90000", ("A1000 is 1 deg", "1000 deg", "A90000 would be 90 or 90000 deg")),
    ],
)
def test_the_hint_names_both_readings(text: bytes, readings: tuple[str, ...]) -> None:
    with pytest.raises(gx.InputError) as caught:
        _ = gx.read(text, "fanuc").path
    hint = caught.value.diagnostics[0].hint
    assert all(said in hint for said in ("IS-B", "calculator", *readings))


def test_feeds_follow_what_is_said_of_them() -> None:
    def feed(program: str, dialect: str, **said: object) -> float:
        text = f"{program} X0 Y0\nG1 X1. F100".encode()
        return float(gx.read(text, dialect, **said).path.feed[-1])

    assert feed("G21 G94 G0", "fanuc") == 100
    assert feed("G20 G94 G0", "fanuc", increment="calculator") == pytest.approx(2540)
    assert feed("G20 G94 G0", "fanuc", feed_increment=0.01) == pytest.approx(25.4)
    assert feed("G21 G95 G0", "fanuc", feed_increment="calculator") == 100
    assert feed("G93 G0", "fanuc", increment="IS-B") == pytest.approx(0.1)
    assert feed("G93 G0", "fanuc", increment="calculator") == 100
    assert feed("G21 G94 G0", "haas", feed_increment="IS-B") == pytest.approx(0.1)
    assert feed("G20 G94 G0", "haas", feed_increment="IS-B") == pytest.approx(0.254)
    for modes, said in (
        ("G93 G0", {}),
        ("G20 G94 G0", {"feed_increment": "IS-B"}),
        ("G95 G0", {"feed_increment": 0.01}),
    ):
        with pytest.raises(gx.InputError, match="GX205"):
            feed(modes, "fanuc", **said)

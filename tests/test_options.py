"""Options of passes: what a user may write, what is refused, and the way back."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcxform.catalogue import CATALOGUE
from gcxform.contract.options import (
    Angle,
    Argument,
    Coordinates,
    Length,
    ModelFile,
    Option,
    Vector,
    build,
    describe,
    to_toml,
)
from gcxform.contract.passes import Pass
from gcxform.diagnostics import Diagnostic, Location, UsageError

MODEL = """format = 1
kind = "axis-functions"
values = "error"
convention = "relative"
[X]
position = [0.0, 100.0]
EXX = [0.0, 0.01]
EYX = [0.0, 0.0]
EZX = [0.0, 0.0]
"""


class Colour(StrEnum):
    RED = "red"
    BLUE = "blue"


@dataclass(frozen=True)
class Everything(Pass):
    """Has an option of every type."""

    name: ClassVar[str] = "everything"
    step: Annotated[Length, Option("the step", above=0.0)]
    limit: Annotated[Length | None, Option(at_most=10.0)] = None
    bare: Length | None = None
    turn: Annotated[Angle, Option(at_least=0.0, at_most=360.0)] = 90.0
    by: Vector = (0.0, 0.0, 0.0)
    count: Annotated[int, Option(at_least=0)] = 3
    factor: float = 1.0
    flag: bool = False
    text: str = ""
    mode: Annotated[Literal["lines", "split"], Option("what becomes of arcs")] = "lines"
    colour: Colour = Colour.RED
    level: Literal[1, 2] = 1
    at: Coordinates = field(default_factory=dict)
    digits: Annotated[int | dict[str, int] | None, Option(at_least=0, at_most=9)] = None
    file: Path | None = None
    hidden: int = field(default=7, init=False)


@dataclass(frozen=True)
class WithModel(Pass):
    """Has an error model."""

    name: ClassVar[str] = "with-model"
    model: ModelFile


@dataclass(frozen=True)
class Picky(Pass):
    """Looks at its options together."""

    name: ClassVar[str] = "picky"
    low: float = 0.0
    high: float = 1.0

    def __post_init__(self) -> None:
        if self.low > self.high:
            raise ValueError("low is above high")
        if self.high > 100.0:
            raise UsageError.one("GX706", "too high")


@dataclass(frozen=True)
class NoOption(Pass):
    """Has a field that no file can hold."""

    name: ClassVar[str] = "no-option"
    what: complex = 0j


KEYS = ("use", "step", "limit", "bare", "turn", "by", "count", "factor", "flag", "text", "mode")
KEYS += ("colour", "level", "at", "digits", "file", "model", "low", "high", "stepp")


def where(key: str) -> Location:
    return Location("p.toml", 10 + KEYS.index(key), 3)


def made(raw: dict[str, Any], base: Path = Path()) -> Everything:
    return build(Everything, {"step": 1.0, **raw}, base, (), where)


def refused(raw: dict[str, Any], of: type[Pass] = Everything) -> tuple[Diagnostic, ...]:
    with pytest.raises(UsageError) as caught:
        build(of, raw, Path(), (), where)
    assert all(d.code in CATALOGUE for d in caught.value.diagnostics)
    return caught.value.diagnostics


def only(raw: dict[str, Any]) -> Diagnostic:
    (found,) = refused({"step": 1.0, **raw})
    return found


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        ("5 um", 0.005),
        ("5um", 0.005),
        ("7 um", 0.007),
        ("5 µm", 0.005),
        ("0.2 mm", 0.2),
        ("0.001 in", 0.0254),
        ("1e-3 m", 1.0),
        (".5mm", 0.5),
        (2, 2.0),
        (0.25, 0.25),
        (Argument("0.25"), 0.25),
        (Argument("5um"), 0.005),
    ],
)
def test_a_length_is_a_number_in_mm_or_has_a_unit(raw: object, expected: float) -> None:
    assert made({"step": raw}).step == expected


@pytest.mark.parametrize(
    ("raw", "expected"),
    [
        ("10 deg", 10.0),
        ("1 mrad", math.degrees(1e-3)),
        ("80 urad", math.degrees(80e-6)),
        ("0.1 rad", math.degrees(0.1)),
        (45, 45.0),
    ],
)
def test_an_angle_is_a_number_in_degrees_or_has_a_unit(raw: object, expected: float) -> None:
    assert made({"turn": raw}).turn == pytest.approx(expected, rel=1e-15)


@pytest.mark.parametrize(
    "raw",
    [
        [1, 2.0, "3 mm"],
        "1,2,3",
        Argument("1, 2 mm,3"),
        {"X": 1, "Y": "2 mm", "Z": 3.0},
    ],
)
def test_a_vector_is_a_list_a_string_or_a_table(raw: object) -> None:
    assert made({"by": raw}).by == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("key", "raw", "expected"),
    [
        ("count", 0, 0),
        ("count", Argument("12"), 12),
        ("factor", 2, 2.0),
        ("factor", Argument("-1e3"), -1000.0),
        ("flag", True, True),
        ("flag", Argument("true"), True),
        ("text", "5 um", "5 um"),
        ("text", Argument("5"), "5"),
        ("mode", "split", "split"),
        ("mode", Argument("split"), "split"),
        ("colour", "blue", Colour.BLUE),
        ("level", 2, 2),
        ("level", Argument("2"), 2),
        ("at", {"X": "1 in", "A": "1 deg", "B": 2}, {"X": 25.4, "A": 1.0, "B": 2.0}),
        ("digits", 4, 4),
        ("digits", {"X": 4, "F": 0}, {"X": 4, "F": 0}),
        ("file", "a/b.toml", Path("base/a/b.toml")),
        ("file", "/a/b.toml", Path("/a/b.toml")),
        ("limit", "10 mm", 10.0),
        ("bare", "-1 um", -0.001),
    ],
)
def test_other_types(key: str, raw: object, expected: object) -> None:
    value = getattr(made({key: raw}, Path("base")), key)
    assert value == expected
    assert type(value) is type(expected)


@pytest.mark.parametrize(
    ("key", "raw", "code", "message"),
    [
        ("bare", "5", "GX708", "bare: '5' has no unit: write \"5 mm\", or 5 without quotes"),
        (
            "bare",
            "5 parsec",
            "GX708",
            "bare: 'parsec' is not a unit of a length; units are mm, um, m, in",
        ),
        ("bare", "5 deg", "GX708", "'deg' is not a unit of a length"),
        ("turn", "5 mm", "GX708", "'mm' is not a unit of an angle"),
        ("bare", "wide", "GX708", "bare: 'wide' is not a length, such as \"5 um\""),
        ("bare", "1e999 mm", "GX708", "bare: 1e999 is too large"),
        ("bare", "1e9999999999 mm", "GX708", "is too large"),
        (
            "bare",
            True,
            "GX702",
            'bare: expected a length, such as "5 um", "0.2 mm" or 0.2, got true',
        ),
        ("bare", math.nan, "GX702", "finite, got nan"),
        ("bare", 10**400, "GX702", "expected a length"),
        ("bare", ["1 mm"], "GX702", "got a list"),
        ("by", [1, 2], "GX702", "by: expected three lengths"),
        ("by", {"X": 1, "Y": 2}, "GX702", "got a table"),
        ("by", [1, 2, "3 deg"], "GX708", "'deg'"),
        ("by", Argument("1,2"), "GX702", "three lengths"),
        ("count", 1.5, "GX702", "count: expected a whole number, got 1.5"),
        ("count", "3", "GX702", "count: expected a whole number, got '3'"),
        ("count", True, "GX702", "got true"),
        ("count", Argument("many"), "GX702", "got 'many'"),
        ("factor", math.inf, "GX702", "factor: expected a number that is finite, got inf"),
        ("factor", Argument("nan"), "GX702", "finite"),
        ("flag", 1, "GX702", "flag: expected true or false, got 1"),
        ("flag", Argument("maybe"), "GX702", "got 'maybe'"),
        ("text", 5, "GX702", "text: expected a text, got 5"),
        ("at", 5, "GX702", "at: expected a table of axis letters"),
        ("at", {"Q": 1}, "GX701", "at: 'Q' is not one of the axes"),
        ("at", {"A": "1 mm"}, "GX708", "angle"),
        ("digits", {"XY": 1}, "GX701", "digits: 'XY' is not an address letter"),
        ("digits", {"X": 10}, "GX706", "digits: 10 is not at least 0 and at most 9"),
        ("digits", "four", "GX702", "whole number"),
        ("file", "", "GX702", "file: expected the name of a file"),
        ("file", "a\0b", "GX702", "the name of a file"),
        ("count", -1, "GX706", "count: -1 is not at least 0"),
        ("limit", "11 mm", "GX706", "limit: 11 mm is not at most 10 mm"),
        ("turn", 361, "GX706", "turn: 361 deg is not at least 0 deg and at most 360 deg"),
        ("level", 3, "GX707", "level: 3 is not one of 1, 2"),
        ("level", "1", "GX707", "level: '1' is not one of 1, 2"),
        ("mode", ["lines"], "GX707", "mode: a list is not one of lines, split"),
    ],
)
def test_what_is_refused(key: str, raw: object, code: str, message: str) -> None:
    found = only({key: raw})
    assert found.code == code
    assert message in found.message
    assert found.where == where(key)


def test_the_hint_of_a_range_is_the_help_of_the_option() -> None:
    (found,) = refused({"step": "0 um"})
    assert (found.code, found.message, found.hint) == (
        "GX706",
        "step: 0 mm is not above 0 mm",
        "the step",
    )


def test_a_choice_is_proposed() -> None:
    found = only({"mode": "line"})
    assert (found.code, found.hint) == ("GX707", "did you mean 'lines'?")
    assert only({"colour": "green"}).hint == "known: red, blue"


def test_a_key_is_proposed() -> None:
    found = only({"stepp": 1})
    assert (found.code, found.hint) == ("GX701", "did you mean 'step'?")
    assert found.message == "unknown key 'stepp' in the pass 'everything'"
    assert found.where == where("stepp")


def test_a_mandatory_option() -> None:
    (found,) = refused({})
    assert (found.code, found.message) == ("GX705", "the pass 'everything' needs 'step'")
    assert found.where == where("step")


def test_all_that_is_wrong_is_told_at_once() -> None:
    found = refused({"stepp": 1, "count": "x", "mode": "y"})
    assert [d.code for d in found] == ["GX701", "GX705", "GX702", "GX707"]


def test_options_which_do_not_go_together() -> None:
    (found,) = refused({"low": 2.0}, Picky)
    assert (found.code, found.where) == ("GX713", where("use"))
    assert found.message == "the pass 'picky': low is above high"
    (found,) = refused({"high": 200.0}, Picky)
    assert (found.code, found.where) == ("GX706", where("use"))


def test_a_model_is_loaded(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(MODEL)
    made_pass = build(WithModel, {"model": "m.toml"}, tmp_path, (), where)
    assert made_pass.model.path == tmp_path / "m.toml"
    assert made_pass.model.model.largest() == 0.01
    assert len(made_pass.model.sha256) == 64
    again = build(WithModel, to_toml(made_pass), Path("elsewhere"), (), where)
    assert again == made_pass
    (tmp_path / "m.toml").write_text(MODEL.replace("0.01", "0.02"))
    assert build(WithModel, {"model": "m.toml"}, tmp_path, (), where) != made_pass


def test_a_model_that_is_not_there() -> None:
    (found,) = refused({"model": "no.toml"}, WithModel)
    assert (found.code, found.where) == ("GX709", where("model"))
    (found,) = refused({"model": "x" * 5000}, WithModel)
    assert (found.code, found.where) == ("GX709", where("model"))
    (found,) = refused({"model": 5}, WithModel)
    assert (found.code, found.where) == ("GX702", where("model"))


def test_a_fault_in_a_model_is_shown_in_its_file(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text(MODEL.replace("EXX", "EXQ"))
    with pytest.raises(UsageError) as caught:
        build(WithModel, {"model": "m.toml"}, tmp_path, (), where)
    (found,) = caught.value.diagnostics
    assert found.where is not None
    assert (found.where.file, found.where.line) == (str(tmp_path / "m.toml"), 7)


def test_describe() -> None:
    docs = {doc.name: doc for doc in describe(Everything)}
    assert "hidden" not in docs
    step = docs["step"]
    assert (step.type, step.default, step.mandatory) == ("length", "", True)
    assert (step.help, step.range) == ("the step", "above 0 mm")
    turn = docs["turn"]
    assert (turn.default, turn.mandatory) == ("90 deg", False)
    assert turn.range == "at least 0 deg and at most 360 deg"
    assert docs["mode"].choices == ("lines", "split")
    assert docs["mode"].default == "lines"
    assert docs["flag"].default == "false"
    assert docs["limit"].default == ""
    assert docs["digits"].type == "whole number or table by letter"


def test_a_type_that_is_no_option() -> None:
    with pytest.raises(TypeError, match="'what'"):
        describe(NoOption)


LENGTHS = st.floats(1e-6, 1e6)
PASSES = st.builds(
    Everything,
    step=LENGTHS,
    limit=st.none() | st.floats(-1e6, 10.0),
    turn=st.floats(0.0, 360.0),
    by=st.tuples(LENGTHS, LENGTHS, LENGTHS),
    count=st.integers(0, 10**9),
    factor=st.floats(allow_nan=False, allow_infinity=False),
    flag=st.booleans(),
    text=st.text(),
    mode=st.sampled_from(["lines", "split"]),
    colour=st.sampled_from(Colour),
    level=st.sampled_from([1, 2]),
    at=st.dictionaries(st.sampled_from("XYZABC"), LENGTHS),
    digits=st.none() | st.integers(0, 9) | st.dictionaries(st.sampled_from("XAF"), st.just(3)),
    file=st.none() | st.just(Path("/a/b")),
)


@given(PASSES)
def test_to_toml_and_back(original: Everything) -> None:
    raw = to_toml(original)
    assert all("_" not in key for key in raw)
    assert build(Everything, raw, Path("anywhere"), (), where) == original

"""What people pass to the Python API means what it says, or is refused: never another result."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import gcxform as gx
from gcxform.config import arguments
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry

REGISTRY = default_registry()
LINUXCNC = REGISTRY.dialect("linuxcnc")
CYCLE = b"G21 G90 G94 G17\nF100\nG91 G81 X1.5 Y.5 Z-.5 R.25 L2\nG90 G80\nM2\n"
ARC = b"G21 G90 G94 G17\nG0 X10 Y0 Z0\nG3 X-10 Y0 I-10 J0 F100\nM2\n"
PATHS = {"cycles": REGISTRY.passes["cycles"], "segment": REGISTRY.passes["segment"]}

numbers = st.one_of(st.integers(-1000, 1000), st.floats(-1000, 1000))
disguises = st.sampled_from(
    [int, float, np.float64, np.float32, np.int64, np.int16, lambda v: np.array(v)]
)
ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=5),
    st.binary(max_size=5),
    st.lists(st.integers(), max_size=2),
    st.dictionaries(st.text(max_size=2), st.floats(), max_size=2),
    st.complex_numbers(),
    st.just(np.array([1.5, 2])),
    st.just(Path("x")),
    st.just(object()),
)


def cycles(start: object) -> gx.Result:
    """Expand the cycle from a start."""
    steps = (PATHS["cycles"](),)
    return gx.Pipeline(LINUXCNC, LINUXCNC, steps, Reading(start=start)).run(CYCLE)


def test_whole_numbers_are_positions_like_any_other() -> None:
    """Int positions once made an int column, in which nothing was drilled: and it was proved."""
    whole = cycles({"X": 0, "Y": 0, "Z": 0})
    assert whole.text == cycles({"X": 0.0, "Y": 0.0, "Z": 0.0}).text
    assert whole.text.count(b"G0 X1.5 Y0.5\nG1 Z-0.5\nG0 Z0.5\n") == 2


@given(value=st.integers(-100, 100), disguise=disguises)
def test_a_number_is_taken_in_every_type_that_numbers_come_in(value, disguise) -> None:
    start = Reading(start={"X": disguise(value)}).start
    assert start == {"X": float(value)}
    assert type(start["X"]) is float


@given(
    field=st.sampled_from(["start", "feed", "block_delete", "units", "parameters"]), any_=ANYTHING
)
def test_a_reading_takes_what_it_understands_and_refuses_the_rest(field, any_) -> None:
    try:
        taken = getattr(Reading(**{field: any_}), field)
    except gx.UsageError:
        return
    if field in ("start", "parameters"):
        assert taken == dict(any_)
        assert all(type(value) is float for value in taken.values())
        assert all(np.isfinite(value) for value in taken.values())
    elif field == "feed":
        assert taken is None or (type(taken) is float and taken > 0 and taken == float(any_))
    else:
        assert taken in ("", "execute", "skip", "mm", "in")


@pytest.mark.parametrize(
    ("given_", "says"),
    [
        ({"start": {"Q": 0.0}}, "'Q' is not one of"),
        ({"start": {"X": True}}, "got True"),
        ({"start": {"X": float("nan")}}, "finite"),
        ({"start": [1, 2, 3]}, "a table by name"),
        ({"block_delete": "maybe"}, "'maybe' is not one of"),
        ({"units": "cm"}, "'cm' is not one of"),
        ({"feed": -1}, "is not above 0"),
        ({"feed": 10**400}, "finite"),
        ({"increment": 0}, "is not above 0"),
        ({"increment": "IS-Q"}, "IS-B"),
    ],
)
def test_what_cannot_be_meant_is_refused_by_name(given_, says) -> None:
    with pytest.raises(gx.UsageError) as error:
        gx.read(ARC, "linuxcnc", **given_)
    assert says in str(error.value)


def test_a_parameter_has_a_number_or_a_name() -> None:
    with pytest.raises(gx.UsageError, match="neither a number nor a name"):
        _ = gx.read(ARC, "linuxcnc", parameters={"depth": 1}).path


@pytest.mark.parametrize(
    "options",
    [
        {"budget": "5"},
        {"budget": 0},
        {"budget": float("inf")},
        {"growth": True},
        {"words": "most"},
        {"decimals": {"X": 1.5}},
        {"decimals": {"XY": 1}},
        {"decimals": 3},
        {"machine": "mill.toml"},
        {"reading": {"start": {"X": 0}}},
        {"numbers": 3},
        {"passes": ("absolute",)},
        {"source": "acme 9000"},
        {"target": gx.Pass},
    ],
    ids=str,
)
def test_a_pipeline_refuses_what_it_does_not_understand(options) -> None:
    with pytest.raises(gx.UsageError):
        gx.Pipeline(**{"source": "linuxcnc", "target": "linuxcnc", **options})


def test_a_pipeline_takes_names_lists_and_numpy() -> None:
    segment = PATHS["segment"](chord_error=np.float32(0.5))
    made = gx.Pipeline("linuxcnc", LINUXCNC, [segment], budget=1, decimals={"X": np.int8(3)})
    assert made.source is LINUXCNC
    assert made.budget == 1.0
    assert made.decimals == {"X": 3}
    assert made.passes[0].chord_error == 0.5
    assert b"G3" not in made.run(bytearray(ARC)).text


@pytest.mark.parametrize("verify", [True, "yes", None, ""])
def test_how_to_verify_is_one_of_three_words(verify) -> None:
    with pytest.raises(gx.UsageError):
        gx.Pipeline(LINUXCNC, LINUXCNC, (PATHS["cycles"](),)).run(ARC, verify=verify)


@pytest.mark.parametrize("program", [None, 5, ["G0"], object()])
def test_a_program_is_bytes_or_a_path(program) -> None:
    with pytest.raises(gx.UsageError):
        gx.read(program, "linuxcnc")
    with pytest.raises(gx.UsageError):
        gx.Pipeline(LINUXCNC, LINUXCNC).run(program)


@pytest.mark.parametrize(
    ("given_", "means"),
    [("5um", 0.005), ("5 um", 0.005), (1, 1.0), (np.float64(0.25), 0.25), (np.int32(2), 2.0)],
)
def test_options_of_passes_are_taken_as_in_a_file(given_, means) -> None:
    step = PATHS["segment"](chord_error=given_)
    made = gx.Pipeline(LINUXCNC, LINUXCNC, (step,)).passes[0]
    assert type(made.chord_error) is float
    assert made.chord_error == pytest.approx(means, abs=1e-15)


@pytest.mark.parametrize(
    "options",
    [
        {"chord_error": True},
        {"chord_error": 0},
        {"chord_error": -1.0},
        {"chord_error": float("nan")},
        {"chord_error": 0.1, "arcs": "circles"},
        {"chord_error": "5 parsec"},
        {"chord_error": [0.1]},
    ],
    ids=str,
)
def test_options_of_passes_are_refused_as_in_a_file(options) -> None:
    with pytest.raises(gx.UsageError):
        gx.Pipeline(LINUXCNC, LINUXCNC, (PATHS["segment"](**options),))


@given(value=ANYTHING)
def test_any_value_of_an_option_is_taken_for_what_it_says_or_refused(value) -> None:
    try:
        step = PATHS["segment"](chord_error=value)
        made = gx.Pipeline(LINUXCNC, LINUXCNC, (step,)).passes[0]
    except gx.UsageError:
        return
    assert made.chord_error is None or made.chord_error == float(value) > 0


def test_columns_of_a_path_hold_what_they_are_for() -> None:
    path = gx.read(ARC, "linuxcnc").path
    whole = path.replace(end=np.zeros(path.end.shape, np.int64), feed=np.arange(len(path)))
    assert whole.end.dtype == whole.feed.dtype == np.float64
    for column, wrong in (
        ("kind", np.array([0.5] * len(path))),
        ("kind", np.array([300] * len(path))),
        ("source", np.zeros(len(path))),
        ("end", np.full(path.end.shape, "1.5")),
    ):
        with pytest.raises(TypeError, match=column):
            path.replace(**{column: wrong})


@pytest.mark.parametrize("tolerance", [0, -1, float("nan"), True, "1um"])
def test_compare_asks_for_a_tolerance(tolerance) -> None:
    program = gx.read(ARC, "linuxcnc")
    with pytest.raises(gx.UsageError):
        gx.compare(program, program, tolerance)


def test_plain_values_have_no_numpy_left() -> None:
    found = arguments.plain({"X": (np.float32(0.5), np.array([1, 2]))})
    assert found == {"X": [0.5, [1, 2]]}
    assert type(found["X"][0]) is float


@pytest.mark.parametrize("decimals", [-1, 2.0, True, "3", 99])
def test_decimals_are_whole_and_few(decimals) -> None:
    with pytest.raises(gx.UsageError):
        gx.NumberFormat(mm=decimals)

"""Pipeline files and chains: what they say, and what is refused at which place."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, ClassVar, Literal

import pytest

import gcxform as gx
from gcxform.catalogue import CATALOGUE
from gcxform.config.quantities import LENGTH
from gcxform.config.schemas import quantity_schema
from gcxform.contract.options import Length, ModelFile, Option, Vector
from gcxform.contract.passes import Pass, TextPass
from gcxform.diagnostics import UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.pipeline.chain_text import parse_chain
from gcxform.pipeline.file import InputSpec, OutputSpec, PipelineSpec, load
from gcxform.pipeline.schema import schema
from gcxform.plugin.contributions import Offered
from gcxform.plugin.registry import Registry, default_registry

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
PIPELINE = """format = 1
[input]
dialect = "alpha"
start = { X = 0, A = "1 deg" }
increment = "0.001 mm"
feed = 100
block-delete = "skip"
units = "in"
[machine]
file = "mill.toml"
[budget]
deviation = "6 um"
[[pass]]
use = "copy"
[[pass]]
use = "cut"
chord-error = "2 um"
[[pass]]
use = "bend"
model = "m.toml"
origin = [0, 0, "1 mm"]
[output]
dialect = "beta"
decimals = { X = 4, A = 3 }
words = "all"
trailing-zeros = true
"""


class Alpha(Dialect):
    """Alpha."""

    name = "alpha"


class Beta(Dialect):
    """Beta."""

    name = "beta"


@dataclass(frozen=True)
class Copy(TextPass):
    """Has no option."""

    name: ClassVar[str] = "copy"


@dataclass(frozen=True)
class Cut(Pass):
    """Has some options."""

    name: ClassVar[str] = "cut"
    chord_error: Annotated[Length | None, Option("largest distance", above=0.0)] = None
    arcs: Literal["lines", "split"] = "lines"
    count: int = 0
    text: str = ""


@dataclass(frozen=True)
class Bend(Pass):
    """Has a mandatory option."""

    name: ClassVar[str] = "bend"
    model: ModelFile
    origin: Vector = (0.0, 0.0, 0.0)


REGISTRY = Registry(
    dialects=Offered({"alpha": Alpha, "beta": Beta}),
    passes=Offered({"copy": Copy, "cut": Cut, "bend": Bend}),
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "m.toml").write_text(MODEL)
    return tmp_path


def loaded(folder: Path, text: str) -> PipelineSpec:
    (folder / "p.toml").write_text(text)
    return load(folder / "p.toml", REGISTRY)


Findings = list[tuple[str, int, int, str, str]]


def _plain(error: UsageError, file: str) -> Findings:
    """Return code, line, column, message and hint of all findings."""
    found = []
    for d in error.diagnostics:
        assert d.code in CATALOGUE
        assert d.where is not None
        assert d.where.file == file
        found.append((d.code, d.where.line, d.where.column, d.message, d.hint))
    return found


def refused(folder: Path, text: str) -> Findings:
    with pytest.raises(UsageError) as caught:
        loaded(folder, text)
    return _plain(caught.value, str(folder / "p.toml"))


def refused_chain(text: str, base: Path = Path()) -> Findings:
    with pytest.raises(UsageError) as caught:
        parse_chain(text, base, REGISTRY)
    return _plain(caught.value, "-x")


def test_a_whole_pipeline(folder: Path) -> None:
    spec = loaded(folder, PIPELINE)
    assert spec.input == InputSpec(
        dialect="alpha",
        start={"X": 0.0, "A": 1.0},
        increment=0.001,
        feed=100.0,
        block_delete="skip",
        units="in",
    )
    assert spec.machine == folder / "mill.toml"
    assert spec.budget == 0.006
    copy, cut, bend = spec.passes
    assert copy == Copy()
    assert cut == Cut(chord_error=0.002)
    assert isinstance(bend, Bend)
    assert (bend.model.path, bend.origin) == (folder / "m.toml", (0.0, 0.0, 1.0))
    assert spec.output == OutputSpec("beta", {"X": 4, "A": 3}, "all", True)
    assert spec.file == folder / "p.toml"


def test_an_empty_pipeline(folder: Path) -> None:
    spec = loaded(folder, "format = 1\n")
    assert spec == PipelineSpec(file=folder / "p.toml")
    assert (spec.input.block_delete, spec.input.units) == ("", "")
    assert (spec.output.decimals, spec.output.words) == (None, "changed")


def test_the_two_ways_to_write_steps_are_one(folder: Path) -> None:
    long = 'format = 1\n[[pass]]\nuse = "copy"\n[[pass]]\nuse = "cut"\ncount = 2\n'
    short = 'format = 1\npass = [\n { use = "copy" },\n { use = "cut", count = 2 },\n]\n'
    assert loaded(folder, long) == loaded(folder, short)
    assert refused(folder, short.replace("count", "cuont"))[0][:3] == ("GX701", 4, 17)


@pytest.mark.parametrize(
    ("old", "new", "code", "line", "column", "message", "hint"),
    [
        ("format = 1\n", "", "GX705", 0, 1, "'format' is missing", "format = 1"),
        ("format = 1", "format = 2", "GX711", 1, 1, "format 2 of pipelines is not known", ""),
        ("format = 1", 'format = "1"', "GX711", 1, 1, "format '1'", ""),
        ("units =", "units", "GX710", 8, 7, "this is not TOML: Expected '='", ""),
        ("[budget]", "[budgt]", "GX701", 11, 1, "unknown key 'budgt'", "did you mean 'budget'?"),
        ('dialect = "a', 'dialct = "a', "GX701", 3, 1, "'dialct' in [input]", "mean 'dialect'?"),
        (
            "[budget]",
            "a = 1\n[budget]",
            "GX701",
            11,
            1,
            "unknown key 'a' in [machine]",
            "known: file",
        ),
        ("words", "wrods", "GX701", 25, 1, "unknown key 'wrods' in [output]", "'words'?"),
        ("chord-error", "chord-eror", "GX701", 17, 1, "'chord-eror' in the pass 'cut'", "error'?"),
        ("chord-error", "chord_error", "GX701", 17, 1, "'chord_error'", "did you mean 'chord-"),
        ('A = "1', 'Q = "1', "GX701", 4, 1, "start: 'Q' is not one of the axes X Y Z", ""),
        ('"alpha"', "5", "GX702", 3, 1, "dialect: expected a text, got 5", ""),
        ("feed = 100", 'feed = "fast"', "GX702", 6, 1, "feed: expected a number, got 'fast'", ""),
        ("= true", "= 1", "GX702", 26, 1, "trailing-zeros: expected true or false, got 1", ""),
        ('"alpha"', '"alhpa"', "GX703", 3, 1, "there is no dialect 'alhpa'", "mean 'alpha'?"),
        ('"beta"', '"gamma"', "GX703", 23, 1, "no dialect 'gamma'", "known: alpha, beta"),
        ('"cut"', '"cutt"', "GX704", 16, 1, "there is no pass 'cutt'", "did you mean 'cut'?"),
        ('use = "copy"\n', "", "GX705", 13, 1, "step 1 lacks the key 'use'", "use = "),
        ('"copy"', "5", "GX702", 14, 1, "use: expected the name of a pass", ""),
        ('model = "m.toml"\n', "", "GX705", 18, 1, "the pass 'bend' needs 'model'", ""),
        ('deviation = "6 um"\n', "", "GX705", 11, 1, "[budget] needs 'deviation' or 'growth'", ""),
        ('"2 um"', '"-2 um"', "GX706", 17, 1, "chord-error: -0.002 mm is not above 0 mm", ""),
        ("X = 4", "X = 12", "GX706", 24, 1, "decimals: 12 is not at least 0 and at most 6", ""),
        ('"all"', '"al"', "GX707", 25, 1, "words: 'al' is not one of changed, prog", "'all'?"),
        ('"skip"', '"jump"', "GX707", 7, 1, "'jump' is not one of execute, skip", "known: exec"),
        ('"in"', '"inch"', "GX707", 8, 1, "units: 'inch' is not one of mm, in", "mean 'in'?"),
        ('"6 um"', '"6"', "GX708", 12, 1, "deviation: '6' has no unit: write \"6 mm\"", ""),
        ('"m.toml"', '"n.toml"', "GX709", 20, 1, "does not exist", ""),
    ],
)
def test_what_is_refused(
    folder: Path, old: str, new: str, code: str, line: int, column: int, message: str, hint: str
) -> None:
    assert old in PIPELINE
    (found,) = refused(folder, PIPELINE.replace(old, new, 1))
    assert found[:3] == (code, line, column)
    assert message in found[3]
    assert hint in found[4]


@pytest.mark.parametrize(
    ("text", "code", "line"),
    [
        ("format = 1\npass = 5\n", "GX702", 2),
        ('format = 1\n[pass]\nuse = "copy"\n', "GX702", 2),
        ("format = 1\npass = [1]\n", "GX702", 2),
        ("format = 1\ninput = 5\n", "GX702", 2),
        ("format = 1\n\nbudget = []\n", "GX702", 3),
    ],
)
def test_tables_which_are_none(folder: Path, text: str, code: str, line: int) -> None:
    (found,) = refused(folder, text)
    assert found[:3] == (code, line, 1)


def test_all_that_is_wrong_is_told_at_once(folder: Path) -> None:
    text = PIPELINE.replace("[budget]", "[budgt]").replace("units", "unit")
    text = text.replace('"cut"', '"cutt"').replace('"beta"', '"gamma"').replace('"all"', '"al"')
    assert {found[0] for found in refused(folder, text)} == {"GX701", "GX704", "GX707"}


def test_a_pass_that_looks_at_its_options(folder: Path) -> None:
    @dataclass(frozen=True)
    class Picky(Pass):
        name: ClassVar[str] = "picky"
        low: float = 0.0

        def __post_init__(self) -> None:
            if self.low > 1.0:
                raise ValueError("low is above high")

    path = folder / "p.toml"
    path.write_text('format = 1\n[[pass]]\nuse = "picky"\nlow = 2\n')
    with pytest.raises(UsageError) as caught:
        load(path, Registry(passes=Offered({"picky": Picky})))
    (found,) = _plain(caught.value, str(path))
    assert found[:4] == ("GX713", 3, 1, "the pass 'picky': low is above high")


def test_a_file_that_is_not_there(folder: Path) -> None:
    with pytest.raises(UsageError) as caught:
        load(folder / "no.toml", REGISTRY)
    assert caught.value.diagnostics[0].code == "GX709"


def test_a_chain(folder: Path) -> None:
    text = "copy | cut chord-error=5um arcs=split count=3|bend model=m.toml origin=0,0,1"
    copy, cut, bend = parse_chain(text, folder, REGISTRY)
    assert copy == Copy()
    assert cut == Cut(chord_error=0.005, arcs="split", count=3)
    assert isinstance(bend, Bend)
    assert (bend.model.path, bend.origin) == (folder / "m.toml", (0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", []),
        ("  \n ", []),
        ("cut", [Cut()]),
        ("cut\n|\tcut", [Cut(), Cut()]),
        ('cut chord-error="1 um"', [Cut(chord_error=0.001)]),
        ("cut 'chord-error=1 um'", None),
        ("cut chord-error=0.002", [Cut(chord_error=0.002)]),
        ("cut text='a | b' count=1", [Cut(text="a | b", count=1)]),
        ('cut text=a"b \'c"d', [Cut(text="ab 'cd")]),
        ("cut text=", [Cut(text="")]),
        ("cut text=''", [Cut(text="")]),
        ("cut text=a=b", [Cut(text="a=b")]),
        ("cut text=C:\\new", [Cut(text="C:\\new")]),
        ("cut text=5", [Cut(text="5")]),
    ],
)
def test_how_chains_are_written(text: str, expected: list[Pass] | None) -> None:
    if expected is None:
        assert refused_chain(text)[0][0] == "GX701"
    else:
        assert parse_chain(text, Path(), REGISTRY) == expected


@pytest.mark.parametrize(
    ("text", "code", "column", "message", "hint"),
    [
        ("| cut", "GX712", 1, "there is no pass before this |", ""),
        ("cut |", "GX712", 5, "there is no pass after this |", ""),
        ("cut | | cut", "GX712", 7, "there is no pass before this |", ""),
        ("cut text='a", "GX712", 10, "the quote is not closed", ""),
        ("cut copy", "GX712", 5, "'copy' is not an option, which is key=value", "cut | copy"),
        ("cut, copy", "GX712", 6, "'copy' is not an option", "separate passes by |: cut | copy"),
        ("cut > copy", "GX712", 5, "'>' is not an option", "separate passes by |: cut | copy"),
        ("cut,copy", "GX712", 1, "'cut,copy' is not one pass", "separate passes by |: cut | copy"),
        ("cut =5", "GX712", 5, "'=5' is not an option", ""),
        ("cut count=1 count=2", "GX712", 13, "'count' is given twice", ""),
        ("cut | ctu", "GX704", 7, "there is no pass 'ctu'", "did you mean 'cut'?"),
        ("cut | cut cuont=1", "GX701", 11, "unknown key 'cuont' in the pass 'cut'", "'count'?"),
        ("copy a=1", "GX701", 6, "unknown key 'a' in the pass 'copy'", ""),
        ("cut count=many", "GX702", 5, "count: expected a whole number, got 'many'", ""),
        ("cut chord-error=5parsec", "GX708", 5, "'parsec' is not a unit of a length", ""),
        ("cut chord-error=0", "GX706", 5, "chord-error: 0 mm is not above 0 mm", ""),
        ("cut arcs=line", "GX707", 5, "arcs: 'line' is not one of", "did you mean 'lines'?"),
        ("copy | bend", "GX705", 8, "the pass 'bend' needs 'model'", ""),
        ("bend model=nix.toml", "GX709", 6, "model: the file 'nix.toml' does not exist", ""),
    ],
)
def test_what_is_refused_in_a_chain(
    text: str, code: str, column: int, message: str, hint: str
) -> None:
    (found,) = refused_chain(text)
    assert found[:3] == (code, 1, column)
    assert message in found[3]
    assert hint in found[4]


def test_all_steps_of_a_chain_are_looked_at() -> None:
    assert [found[2] for found in refused_chain("ctu | cut a=1 | bend")] == [1, 11, 17]


def test_the_schema_of_pipelines() -> None:
    found = schema("pipeline", REGISTRY)
    json.dumps(found)
    sections = {"format", "input", "entry", "machine", "budget", "output", "limits", "pass"}
    assert set(found["properties"]) == sections
    steps = {
        step["properties"]["use"]["const"]: step
        for step in found["properties"]["pass"]["items"]["anyOf"]
    }
    assert set(steps) == {"copy", "cut", "bend"}
    assert steps["bend"]["required"] == ["use", "model"]
    cut = steps["cut"]["properties"]
    assert cut["chord-error"] == {
        **quantity_schema(LENGTH),
        "exclusiveMinimum": 0.0,
        "description": "largest distance; above 0 mm",
    }
    assert cut["arcs"] == {"enum": ["lines", "split"], "description": "default lines"}
    assert cut["count"]["type"] == "integer"
    assert steps["cut"]["additionalProperties"] is False
    assert found["properties"]["output"]["properties"]["decimals"]["type"] == ["integer", "object"]


def test_the_schemas_of_the_other_files() -> None:
    assert "MachineFile" in schema("machine")["$defs"]
    assert "AxisFunctionsFile" in schema("model")["$defs"]


def test_the_installed_passes_have_a_schema() -> None:
    steps = schema("pipeline")["properties"]["pass"]["items"]["anyOf"]
    assert len(steps) == len(default_registry().passes)


@pytest.mark.parametrize("letter", "ABC")
def test_an_axis_may_be_off_by_what_its_own_decimals_round(tmp_path: Path, letter: str) -> None:
    """Each rotary axis has a budget of its own."""
    (tmp_path / "p.toml").write_text(
        "format = 1\n[input]\n"
        f'dialect = "linuxcnc"\nstart = {{ X = 0.0, Y = 0.0, Z = 0.0, {letter} = 0.0 }}\n'
        '[[pass]]\nuse = "segment"\narcs = "split"\nmax-length = "1 mm"\n'
        f"[output]\ndecimals = {{ {letter} = 2 }}\n"
    )
    program = f"G21 G90 G94\nG1 X7 {letter}10 F100\nM2\n".encode()
    result = gx.Pipeline.load(tmp_path / "p.toml").run(program)
    assert f"X1. {letter}1.43".encode() in result.text
    assert 0.002 < result.certificate.largest["angle"] < 0.005

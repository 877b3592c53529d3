"""The schemas of files say what our loaders say: of keys, types, units, choices and words."""

from __future__ import annotations

import copy
import json
import random
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import tomlkit
from cli_kit import call
from jsonschema import Draft202012Validator
from seeds_kit import LONG

from gcxform.cli.plant.tasks import load_manifest
from gcxform.cli.program.named_schemas import schema
from gcxform.diagnostics import UsageError
from gcxform.errormodel.model_file import load_model
from gcxform.machine.file import load_machine
from gcxform.pipeline.file import load
from gcxform.plugin.registry import default_registry
from gcxform.testing.cases import read_case

ROOT = Path(__file__).parents[1]
KINDS = ("pipeline", "machine", "model", "manifest")
OF_FORM = {
    *("GX402", "GX403", "GX404", "GX405", "GX406", "GX407", "GX701", "GX702", "GX703", "GX704"),
    *("GX705", "GX706", "GX707", "GX708", "GX711", "GX436", "GX450"),
}
"""What is said of keys, types, units and words; what others say no schema can know."""


AXIS = re.compile(r"unknown key '[A-CU-W]' in (?:work-offset|home)")
"""What is said of a place on an axis: which there are, the file says elsewhere."""
BETWEEN = {"GX437"}  # of numbers of tools, and of what one tool may have beside another
SOME_KEYS = (
    *(
        "zzz",
        "X",
        "A",
        "G54",
        "G28",
        "1",
        "P9832",
        "G100",
        "G100-G109",
        "T",
        "M50",
        "like",
        "macro",
    ),
    *("inert-m", "tip-on", "d-is", "peck-return", "tool", "axis", "home", "input", "output"),
    *("start", "decimals", "increment", "feed-increment", "parameters", "block-delete", "stamp"),
    *("deviation", "limits", "control", "work-offset", "gauge-point", "use", "format", "entry"),
)


@cache
def validator(kind: Any) -> Draft202012Validator:
    return Draft202012Validator(schema(kind))


def kind_of(values: dict[str, Any]) -> str:
    if "kind" in values:
        return "model"
    if "batch" in values:
        return "manifest"
    return "pipeline" if {"pass", "input", "output", "budget"} & values.keys() else "machine"


def read(text: str) -> dict[str, Any]:
    """Return the values of a file as editors hand them to a schema: times are texts there."""
    found: dict[str, Any] = json.loads(json.dumps(tomllib.loads(text), default=str))
    return found


@pytest.mark.parametrize("kind", KINDS)
def test_a_schema_is_one_and_has_its_head(kind: Any) -> None:
    found = json.loads(json.dumps(schema(kind), allow_nan=False))
    Draft202012Validator.check_schema(found)
    assert found["$schema"].endswith("/2020-12/schema")
    assert found["$id"] == f"urn:gcxform:schema:{kind}"
    assert found["title"] == f"gcxform {kind} file"


EXAMPLES = sorted((ROOT / "examples").rglob("*.toml"))


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda f: f"{f.parent.name}/{f.name}")
def test_examples_are_as_their_schema_says(file: Path) -> None:
    values = read(file.read_text())
    assert list(validator(kind_of(values)).iter_errors(values)) == []


def corpus() -> Iterator[tuple[str, str, set[str]]]:
    """Yield each text of a file of the corpus with its name and the codes that it gets."""
    seen = set()
    for path in sorted((ROOT / "corpus").rglob("*.txt")):
        if "bytes" in path.parts:  # cases that are folders
            continue
        case = read_case(path)
        said = [line.split(" ") for line in case.diagnostics]
        for name, content in case.sections.items():
            if name.endswith(".toml") and content not in seen:
                seen.add(content)
                places = [(d[0].partition(":")[0], d[-1]) for d in said]
                yield f"{path.stem} {name}", content.decode(), {c for n, c in places if n == name}


def errors_of(values: dict[str, Any]) -> list[str]:
    return [e.message for e in validator(kind_of(values)).iter_errors(values)]


def test_files_of_the_corpus_are_refused_where_the_loader_refuses_them() -> None:
    wrong = []
    for name, text, codes in corpus():
        try:
            errors = errors_of(read(text))
        except tomllib.TOMLDecodeError:
            continue
        between = codes & BETWEEN or name in ("gx405-switches machine.toml",)
        if bool(errors) != bool(codes & OF_FORM) and not between:
            wrong.append((name, codes, errors[:1]))
    assert wrong == []


# --- files as nobody writes them ---

ODD: tuple[Any, ...] = (
    *(True, 0, 1, 7, -1, 1.5, -2.5, "", "x", "?", "5 um", "1.5in", "10 deg", "0.2", "IS-B"),
    *("calculator", "M428", "G54", [], [1], [1.0, 2.0, 3.0], ["5 um", 0, 0], ["M9"], ["X"], [""]),
    *({}, {"X": 1.5}, {"X": "1 deg"}, {"Q": 1}, {"X": 1, "Y": 2, "Z": 3}, {"100": 1.0}, {"a": "b"}),
    *({"ends": "unchanged"}, {"program": 9010}, {"program": 9010, "variables": "own"}),
)
LOADERS = {
    "pipeline": lambda path: load(path, default_registry()),
    "machine": lambda path: load_machine(path, default_registry().machines),
    "model": load_model,
    "manifest": load_manifest,
}
MANIFEST = """format = 1
[[batch]]
name = "brackets"
programs = ["programs/mill"]
pipelines = ["job.toml"]
machines = ["one.toml", "two.toml"]
[[batch]]
programs = ["bad.nc"]
chain = "metric"
dialect = "grbl"
to = "fanuc"
"""
ELSEWHERE = ("model", "machine", "file", "errors", "tool-table", "subprograms", "readings")


def tables(node: Any) -> Iterator[dict[str, Any]]:
    """Yield a table and those below it."""
    if isinstance(node, dict):
        yield node
    for below in node.values() if isinstance(node, dict) else node:
        if isinstance(below, dict | list):
            yield from tables(below)


def spoilt(values: dict[str, Any], draw: random.Random) -> dict[str, Any]:
    """Return a file of which one key is another, gone, or says something else."""
    found = copy.deepcopy(values)
    table = draw.choice(list(tables(found)))
    key = draw.choice([*table, *table, draw.choice(SOME_KEYS)])
    what = draw.choice(("gone", "other", *["odd"] * 6))
    if what == "odd":
        table[key] = draw.choice(ODD)
    else:
        value = table.pop(key, 1)
        table.update({} if what == "gone" else {draw.choice(SOME_KEYS): value})
    return found


def bases() -> dict[str, list[dict[str, Any]]]:
    """Return what the corpus says rightly, by kind, without what names other files."""
    found: dict[str, list[dict[str, Any]]] = {kind: [] for kind in KINDS}
    for _, text, codes in corpus():
        if not codes and not any(f"{name} =" in text for name in ELSEWHERE):
            values = read(text)
            found[kind_of(values)].append(values)
    return found | {"manifest": [read(MANIFEST)]}


def said(values: dict[str, Any], path: Path) -> set[str] | None:
    """Return the codes that the loader gives, None for a file that no TOML can be."""
    path.write_text(tomlkit.dumps(values))
    try:
        LOADERS[kind_of(values)](path)
    except UsageError as error:
        return {d.code for d in error.diagnostics if not AXIS.match(d.message)}
    return set()


@pytest.mark.parametrize("kind", KINDS)
def test_a_schema_refuses_what_the_loader_refuses(kind: str, tmp_path: Path) -> None:
    """And takes what it takes; but a key that nobody knows is wrong before it is filled in."""
    draw = random.Random(kind)
    known = bases()[kind]
    wrong = []
    for _ in range(4000 if LONG else 100):
        values = spoilt(draw.choice(known), draw)
        if kind_of(values) != kind:
            continue
        codes = said(values, tmp_path / "file.toml")
        errors = errors_of(values)
        if (errors and not codes and "?" not in str(values)) or (not errors and codes & OF_FORM):
            wrong.append((values, codes, errors[:1]))
    assert wrong == []


# --- files that name their schema ---


def named(folder: Path, mark: bytes = b"") -> Path:
    """Return a folder with files of all kinds that name their schemas."""
    for name in ("bracket/bracket.toml", "bracket/machine.toml", "lddm/model.toml"):
        shutil.copy(ROOT / "examples" / name, folder)
    crlf = (folder / "model.toml").read_bytes().replace(b"\n", b"\r\n")
    (folder / "model.toml").write_bytes(mark + crlf)
    (folder / "below").mkdir()
    shutil.move(folder / "machine.toml", folder / "below")
    files = ("bracket.toml", "model.toml", "below/machine.toml")
    assert call("schema", "--write", ".gcxform", *files).exit_code == 0
    return folder


def test_files_name_their_schema(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    named(tmp_path, b"\xef\xbb\xbf")
    first = {path.name: path.read_bytes().split(b"\n")[0] for path in tmp_path.rglob("*.toml")}
    assert first["bracket.toml"] == b"#:schema .gcxform/pipeline.schema.json"
    assert first["machine.toml"] == b"#:schema ../.gcxform/machine.schema.json"
    assert first["model.toml"] == b"\xef\xbb\xbf#:schema .gcxform/model.schema.json\r"
    before = {path: path.read_bytes() for path in tmp_path.rglob("*.toml")}
    call("schema", "--write", ".gcxform", "bracket.toml", "model.toml", "below/machine.toml")
    assert {path: path.read_bytes() for path in tmp_path.rglob("*.toml")} == before
    for name in ("bracket/bracket.toml", "lddm/model.toml"):
        path = tmp_path / Path(name).name
        assert read(path.read_text("utf-8-sig")) == read((ROOT / "examples" / name).read_text())


def test_nothing_is_written_where_a_file_is_no_toml(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.toml").write_text("format = 1\n")
    (tmp_path / "b.toml").write_text("format = \n")
    assert call("schema", "--write", "there", "a.toml", "b.toml").exit_code == 2
    assert [path.name for path in tmp_path.iterdir()] == ["a.toml", "b.toml"]
    assert (tmp_path / "a.toml").read_text() == "format = 1\n"


def test_new_files_name_the_schema_that_is_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.nc").write_text("G21 G90 G94 G17\nG0 X1 Y1 Z1\nG1 X2 F100\nM2\n")
    words = ("machine", "new", "-f", "linuxcnc", "-o")
    call(*words, "bare.toml", "p.nc")
    assert "#:schema" not in (tmp_path / "bare.toml").read_text()
    call("schema", "--write", ".gcxform")
    (tmp_path / "below").mkdir()
    call(*words, "below/m.toml", "-p", "p.toml", "p.nc")
    head = (tmp_path / "below" / "m.toml").read_text().split("\n")[0]
    assert head == "#:schema ../.gcxform/machine.schema.json"
    assert (tmp_path / "p.toml").read_text().startswith("#:schema .gcxform/pipeline.schema.json\n")


TAPLO = shutil.which("taplo") or shutil.which("taplo", path=str(Path(sys.executable).parent))


@pytest.mark.skipif(TAPLO is None, reason="taplo is not installed")
def test_taplo_reads_the_schemas(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    named(tmp_path)
    command = [str(TAPLO), "lint", *map(str, tmp_path.rglob("*.toml"))]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "bracket.toml").read_text()
    (tmp_path / "bracket.toml").write_text(text + "decimalss = 3\n")
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode != 0
    assert "decimalss" in done.stderr

"""What verbs answer with --json: one document each, as the schema says, whatever happens."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import click
import pytest
from cli_kit import MODEL, PART, call, workplace
from jsonschema import Draft202012Validator

from gcxform.cli import VERBS, verbs
from gcxform.cli.common.answer import Answer
from gcxform.cli.schema import FOLDER, answers

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "examples"
SCHEMA = answers()
VALIDATOR = Draft202012Validator(SCHEMA)
READ = ("-f", "linuxcnc")
SET = str(EXAMPLES / "rtcp-loop" / "set.toml")
STEPS = EXAMPLES / "step-diagonal"
CIRCLE = ("--model", "model.toml", "--radius", "10", "--planes", "XY", "--outside", "extrapolate")

ASKED: dict[str, tuple[str, ...]] = {
    "run": (*READ, "-x", "absolute", "--diff", "part.nc"),
    "post": (*READ, "-x", "absolute", "part.nc"),
    "watch": (*READ, "-x", "absolute", "--once", "--rest", "0", "hot"),
    "batch": (*READ, "-x", "absolute", "-o", "out", "-j", "1", "part.nc"),
    "check": (*READ, "-x", "absolute", "part.nc"),
    "compare": (*READ, "part.nc", "other.nc"),
    "info": (*READ, "part.nc"),
    "resume": (*READ, "--line", "5", "--clearance", "50mm", "part.nc"),
    "show": ("-o", "model.svg", "model.toml"),
    "view": (*READ, "part.nc"),
    "list": ("passes",),
    "explain": ("GX301",),
    "schema": ("pipeline",),
    "completion": ("bash",),
    "hosts": (),
    "table show": ("model.toml",),
    "table convert": (
        "--kind",
        "pitch",
        "--to",
        "linuxcnc-comp type=1 units=mm",
        "model.toml",
        "c",
    ),
    "machine jog": (SET,),
    "machine draw": ("-o", "machine.svg", SET),
    "machine new": (*READ, "-o", "new.toml", "part.nc"),
    "calibrate diagonal": (
        "--plain",
        "--noise",
        "9um",
        str(STEPS / "diagonals.csv"),
        "-o",
        "d.toml",
    ),
    "calibrate plan": ("-m", SET, "--ball", "155,0,20", "--axis", "C", "--poses", "6"),
    "simulate positioning": ("--model", "model.toml", "--axes", "X", "--outside", "extrapolate"),
    "simulate diagonal": ("--model", str(EXAMPLES / "lddm" / "model.toml"), "--diagonals", "body"),
}
"""For each verb words with which it has something to say; those of the rest are refused."""


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = workplace(tmp_path, monkeypatch)
    (folder / "other.nc").write_bytes(PART.replace(b"Y5", b"Y6 F50"))
    (folder / "model.toml").write_text(MODEL)
    (folder / "hot").mkdir()
    (folder / "hot" / "a.nc").write_bytes(PART)
    (folder / "hot" / "b.nc").write_bytes(b"G1 G2 X1\nM2\n")
    return folder


def commands(command: click.Command = verbs, name: str = "") -> Iterator[str]:
    """Yield the verbs, and those under them, as they are typed."""
    if not isinstance(command, click.Group):
        yield name
        return
    context = click.Context(command)
    for below in command.list_commands(context):
        found = command.get_command(context, below)
        assert found is not None
        yield from commands(found, f"{name} {below}".strip())


def check(text: str, verb: str, exit_code: int) -> dict[str, Any]:
    """Return a document after looking whether it is one as the schema says."""
    document: dict[str, Any] = json.loads(text)
    wrong = [f"{each.json_path}: {each.message}" for each in VALIDATOR.iter_errors(document)]
    assert not wrong
    assert (document["verb"], document["exit_code"]) == (verb, exit_code)
    return document


def test_the_schemas_are_schemas_and_each_is_of_a_verb() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    names = {each.name.removesuffix(".json") for each in FOLDER.iterdir()}
    assert names - {"answer"} <= set(VERBS)
    printed = json.loads(call("schema", "answer").stdout)
    assert printed == SCHEMA


def test_the_schema_is_not_content_with_anything() -> None:
    good = json.loads(call("explain", "--json", "GX301").stdout)
    assert VALIDATOR.is_valid(good)
    for change in (
        {"extra": 1},
        {"exit_code": "0"},
        {"findings": [{"code": "GX1"}]},
        {"verb": "run"},
        {"title": 3},
    ):
        assert not VALIDATOR.is_valid({**good, **change}), change


@pytest.mark.parametrize("verb", ASKED)
def test_what_a_verb_says_is_as_its_schema_says(verb: str, here: Path) -> None:
    found = call(*verb.split(), "--json", *ASKED[verb])
    assert found.exit_code in (0, 1, 3), found.output
    for line in found.stdout.splitlines() if verb == "watch" else [found.stdout]:
        document = check(line, verb, json.loads(line)["exit_code"])
        said = set(document) - {"format", "verb", "exit_code", "findings"}
        assert said, "it says nothing"
        own = verb.split()[0]
        if (FOLDER / f"{own}.json").is_file() and verb not in ("table convert", "calibrate plan"):
            assert said - {"written", "output"}, "it says nothing of its own"


@pytest.mark.parametrize("verb", sorted({*commands()}))
def test_what_ends_a_verb_is_a_document_too(verb: str, here: Path) -> None:
    found = call(*verb.split(), "--json", "--no-such-option")
    (finding,) = check(found.stdout, verb, 2)["findings"]
    assert (finding["code"], found.stderr) == ("GX700", "")


def test_every_verb_has_been_asked() -> None:
    rest = {verb for verb in commands() if verb.split()[0] not in {v.split()[0] for v in ASKED}}
    assert rest <= {"lsp"}  # which speaks a protocol of its own


def test_what_was_written_and_printed_is_in_the_document(here: Path) -> None:
    words = ("run", "--json", *READ, "-x", "absolute", "part.nc")
    printed = check(call(*words).stdout, "run", 0)
    assert printed["output"].encode() == call("run", "-q", *words[2:]).stdout_bytes
    written = check(call(*words, "-o", "o.nc", "--map", "m.json").stdout, "run", 0)
    assert (sorted(written["written"]), "output" in written) == (["m.json", "o.nc"], False)
    (here / "part.nc").write_bytes(b"(\xe4)\n" + PART)
    assert check(call(*words).stdout, "run", 0)["output"].startswith("(ä)\n")


def test_what_is_not_known_is_null(here: Path) -> None:
    (here / "other.nc").write_bytes(b"G21 G90\nG1 X1 F100\nM2\n")
    found = call("compare", "--json", *READ, "part.nc", "other.nc")
    assert "Infinity" not in found.stdout
    check(found.stdout, "compare", 1)
    values = {"a": float("inf"), "b": [{"c": float("nan"), "d": 1.5}]}
    said = json.loads(Answer("info", values).text(0), parse_constant=pytest.fail)
    assert (said["a"], said["b"]) == (None, [{"c": None, "d": 1.5}])


@pytest.mark.skipif(sys.platform == "win32", reason="there is no such device")
def test_a_stdout_that_takes_nothing_is_no_traceback(here: Path) -> None:
    command = [sys.executable, "-m", "gcxform.cli", "check", "--json", *READ, "part.nc"]
    with open("/dev/full", "wb") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, timeout=60)
    assert (done.returncode, b"GX903" in done.stderr) == (5, True)


# --- in a repository ---

yaml = pytest.importorskip("yaml")


def test_hooks_of_pre_commit_run_what_they_say(here: Path) -> None:
    hooks = {h["id"]: h for h in yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())}
    assert set(hooks) == {"gcxform", "gcxform-fix"}
    shutil.copy("job.toml", "gcxform.toml")
    for name, wanted in (("gcxform", 1), ("gcxform-fix", 0), ("gcxform", 0)):
        first, *words = hooks[name]["entry"].split()
        assert (first, hooks[name]["language"]) == ("gcxform", "python")
        assert call(*words, "part.nc", "other.nc").exit_code == wanted


@pytest.mark.skipif(shutil.which("bash") is None, reason="there is no bash")
def test_the_action_checks_the_programs_that_are_named(here: Path) -> None:
    action = yaml.safe_load((ROOT / "action.yml").read_text())
    (step,) = [s for s in action["runs"]["steps"] if s.get("name") == "Check"]
    (here / "a b.nc").write_bytes(PART)
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    told = {"PROGRAMS": "part.nc\n\na b.nc\n", "OPTIONS": "-p\njob.toml", "PATH": path}
    done = subprocess.run(
        ["bash", "-e", "-c", step["run"]], env={**os.environ, **told}, capture_output=True
    )
    assert (done.returncode, done.stdout.count(b"+G90 X10.")) == (1, 2), done.stderr

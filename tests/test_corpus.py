"""The corpus: every case runs, every file is a case, every diagnostic code is triggered."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from zlib import crc32

import pytest
from oracles import rs274
from seeds_kit import LONG
from ways_kit import do_no_harm, go_out, one_round

import gcxform as gx
from gcxform.catalogue import CATALOGUE
from gcxform.emit.numbers import MOST_DECIMALS
from gcxform.testing.cases import Case, Outcome, check_outcome, outcome, read_case, run_case

ROOT = Path(__file__).parents[1]
CORPUS = ROOT / "corpus"
PLACES = {"lddm": ROOT / "examples" / "lddm" / "model.toml"}
LONGEST_PAGE = 60

ELSEWHERE = {
    **dict.fromkeys(("GX229", "GX236"), "test_assumptions.py"),  # warnings
    "GX241": "test_stamps.py",
    "GX242": "test_stamps.py",
    "GX748": "test_hints.py",  # a warning
    "GX453": "test_kinematics.py",
    "GX454": "test_controls.py",
    **dict.fromkeys(("GX470", "GX471", "GX472", "GX473", "GX474"), "test_diagonal_files.py"),
    **dict.fromkeys(("GX475", "GX476"), "test_step_diagonal.py"),
    **dict.fromkeys(("GX477", "GX478"), "test_circle_files.py"),
    "GX486": "test_rotary.py",
    "GX487": "test_rotary.py",
    "GX488": "test_rotary_files.py",
    "GX489": "test_bundle.py",
    "GX490": "test_ballbar_files.py",
    "GX491": "test_plan.py",
    "GX492": "test_plan.py",
    "GX481": "format_kit.py",  # of writing tables, which no pipeline does
    "GX605": "test_table_verb.py",
    "GX609": "test_stamps.py",
    "GX601": "test_verify.py",
    "GX602": "test_corpus.py",  # a pass that does not ensure what it says
    "GX604": "test_cutter_comp.py",
    "GX606": "test_rtcp_choice.py",
    "GX603": "test_corpus.py",  # a text pass that changes words
    "GX712": "test_pipelinefile.py",  # a chain on the command line
    "GX801": "test_plugin_dist.py",
    "GX802": "test_plugin_dist.py",
    "GX760": "test_hostile.py",  # a policy of the command line
    "GX901": "test_corpus.py",
    "GX902": "test_corpus.py",
    "GX903": "test_corpus.py",
    "GX904": "test_interference.py",
}
"""Codes that no case can trigger, with the file of the test that does; those of the command line
are looked for in any test."""
FEW_LINES = 40  # bytes
NAMED = re.compile(r"::\w+\[(.+)\]$")
WHICH: dict[str, Callable[[Case], object]] = {}
"""What must hold of a case on which a test is run, by the name of the test."""
COMMAND_LINE = re.compile(r"GX700|GX72[6-9]|GX73\d|GX749|GX75[0-2]")


def paths() -> list[Path]:
    """Return the cases: text files, and the directories in `bytes`."""
    files = [p for p in CORPUS.rglob("*.txt") if p.relative_to(CORPUS).parts[0] != "bytes"]
    return sorted([*files, *(p for p in (CORPUS / "bytes").iterdir() if p.is_dir())])


def name(path: Path) -> str:
    return path.relative_to(CORPUS).with_suffix("").as_posix()


@cache
def all_cases() -> tuple[Case, ...]:
    """Return all cases."""
    return tuple(map(read_case, paths()))


@cache
def asked(*words: str) -> tuple[Case, ...]:
    """Return the cases that pytest is asked for; where they are named, no others are read."""
    named = [NAMED.search(word) for word in words]
    if not all(named):
        return all_cases()
    ids = sorted({each[1] for each in named if each})
    files = [path for each in ids for path in (CORPUS / f"{each}.txt", CORPUS / each)]
    return tuple(read_case(path) for path in files if path.exists())


def each_case(which=lambda case: True):
    """Run a test on each case of which something holds."""

    def marked(test):
        WHICH[test.__name__] = which
        return test

    return marked


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if which := WHICH.get(metafunc.function.__name__):
        some = filter(which, asked(*metafunc.config.args))
        metafunc.parametrize("case", [parameter(case) for case in some])


def parameter(case: Case) -> object:
    marks = [pytest.mark.xfail(strict=True, reason=case.xfail)] if case.xfail else []
    return pytest.param(case, id=name(case.path), marks=marks)


@each_case()
def test_case(case, tmp_path):
    found = run_case(case, tmp_path, PLACES)
    go_out(case, found, tmp_path, PLACES)
    do_no_harm(found)
    one_round(case, found, tmp_path)
    for each in (d.where for d in found.diagnostics if d.where is not None):
        named = each.file in ("", "-") or Path(each.file).is_relative_to(tmp_path)
        assert named, f"{each.file} is no file that a user has"


def line_by_line(case):
    """Whether a case is read line by line on every run: one in five is, the others over night.

    What is broken on purpose is sought line by line.
    """
    every = LONG or os.environ.get("HYPOTHESIS_PROFILE") == "faults"
    return every or crc32(name(case.path).encode()) % 5 < 2


def joins(case):
    """Whether rows are joined: their ends are gone, and where windows end decides which."""
    return 'use = "arcs"' in case.text("pipeline.toml")


@pytest.mark.by_turns
@pytest.mark.usefixtures("one_process")
@each_case(lambda case: not case.xfail)
def test_windows_make_no_difference(case, tmp_path, monkeypatch):
    """Run every case a few lines at a time: what one window knows, the next must know as well."""
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 1 if line_by_line(case) else FEW_LINES)
    found = outcome(case, tmp_path, PLACES)
    if case.diagnostics:
        assert found.places[0] == case.diagnostics[0]
    elif joins(case):  # a window ends what is joined
        assert not found.diagnostics
    else:
        check_outcome(case, found)


def test_every_file_is_a_case():
    known = {file for path in paths() for file in ([path] if path.is_file() else path.iterdir())}
    known.add(CORPUS / "bytes" / ".gitattributes")
    assert {p for p in CORPUS.rglob("*") if p.is_file()} - known == set()


def test_a_case_is_a_page():
    for case in all_cases():
        if case.path.is_file():
            text = case.path.read_text("utf-8")
            assert text.count("\n") <= LONGEST_PAGE, case.path
        assert re.search(r"[.:](?=\s|$)", case.prose), f"{case.path}: prose has a full stop"
        assert case.prose.count("\n") < 6, case.path


def test_names_of_cases_are_unique():
    assert len({name(case.path) for case in all_cases()}) == len(all_cases())


def test_every_code_has_a_case():
    triggered = {line.split()[-1] for case in all_cases() for line in case.diagnostics}
    assert triggered <= set(CATALOGUE), "cases expect codes that the catalogue does not have"
    tests = {path.name: path.read_text("utf-8") for path in Path(__file__).parent.glob("*.py")}
    others = [text for file, text in tests.items() if file != Path(__file__).name]
    for code in sorted(set(CATALOGUE) - triggered):
        if COMMAND_LINE.fullmatch(code):
            assert any(code in text for text in others), f"no test of the command line has {code}"
        else:
            assert tests[ELSEWHERE.get(code, "")].count(code), f"nothing triggers {code}"


def test_no_code_is_listed_without_need():
    triggered = {line.split()[-1] for case in all_cases() for line in case.diagnostics}
    assert not triggered & set(ELSEWHERE)


# --- codes that no case can trigger ---


@dataclass(frozen=True)
class Forgetful(gx.Pass):
    """Ensure metric blocks and do nothing."""

    name = "forgetful"
    ensures = frozenset({gx.METRIC})

    def apply(self, path, context):
        return path


@dataclass(frozen=True)
class Astray(gx.Pass):
    """Measures more than it promises, which no comparison of what is written shows."""

    name = "astray"
    kind: str = "deviation"

    @property
    def promise(self):
        return 0.001

    @property
    def demands(self):
        return gx.Demands(promise_angle=0.01, deviates={self.kind: "off"})

    def apply(self, path, context):
        return path

    def measure(self, before, after, context):
        return {"off": 0.02}


@dataclass(frozen=True)
class Careless(gx.TextPass):
    """Drop the first word of every block."""

    name = "careless"

    def edit(self, block, number):
        return " ".join(block.text.split()[1:])


def chain(step):
    dialect = gx.Registry.load().dialects["fanuc"]
    return gx.Pipeline(dialect, dialect, (step,))


def test_a_pass_that_does_not_ensure_what_it_says():
    with pytest.raises(gx.VerificationError, match="GX602"):
        chain(Forgetful()).run(b"G20 G90\nG0 X1.\n", verify="full")


@pytest.mark.parametrize("kind", ["deviation", "angle"])
def test_a_pass_that_measures_more_than_it_promises(kind):
    with pytest.raises(gx.VerificationError, match=r"GX602.*promises 0\.0+1 .*measures 0\.02"):
        chain(Astray(kind)).run(b"G21 G90\nG0 X1.\n", verify="full")


def test_a_text_pass_that_changes_words():
    with pytest.raises(gx.VerificationError, match="GX603"):
        chain(Careless()).run(b"G20 G90\nG0 X1.\n")


def test_a_directory_is_no_program(tmp_path):
    with pytest.raises(gx.FileError, match="GX901"):
        chain(Careless()).run(tmp_path)


def test_a_place_that_cannot_be_written(tmp_path):
    with pytest.raises(gx.FileError, match="GX902"):
        gx.write(b"G21\n", tmp_path / "none" / "part.nc")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["run", "-f", "fanuc", "-x", "absolute", "part.nc"], b"GX902"),
        (["list", "passes"], b"GX903"),
    ],
    ids=["run", "list"],
)
def test_a_disk_that_is_full(words, code, tmp_path):
    (tmp_path / "part.nc").write_bytes(b"G21 G90\n" * 10_000)
    command = [sys.executable, "-m", "gcxform.cli", *words]
    with open("/dev/full", "wb") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, cwd=tmp_path)
    assert done.returncode == 5
    assert code in done.stderr


# --- what LinuxCNC's own interpreter says to the cases ---


def for_linuxcnc(case: Case) -> bool:
    """Tell whether LinuxCNC is told all: no parameter has a value at its start, no codes are own.

    Nor may blocks be skipped, for its switch is off.
    """
    text = case.text("pipeline.toml")
    return (
        'dialect = "linuxcnc"' in text
        and not case.xfail
        and "dialect = " not in text.replace('dialect = "linuxcnc"', "", 1)
        and not re.search('parameters = |block-delete = "skip"|tip-codes = "read"', text)
    )


def goes(case: Case) -> bool:
    """Tell whether LinuxCNC should go the same way: its work offsets are 0."""
    return (
        for_linuxcnc(case)
        and not case.diagnostics
        and bool(case.sections["input.nc"].strip())
        and not ("[work-offset" in case.text("machine.toml") and case.path.parent.name == "offsets")
        and "user-codes" not in case.text("machine.toml")
    )


NEEDS_RS274 = pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")


def result(case: Case, folder: Path) -> Outcome:
    return outcome(case, folder, PLACES)


def grid(case: Case) -> float:
    """Return the distance (mm) within which ends are the same: a decimal, and rs274's own."""
    said = re.search(r"decimals = (\d)", case.text("pipeline.toml"))
    return 10.0 ** -min(int(said[1]) if said else 4, MOST_DECIMALS) + 0.0051


@pytest.mark.by_turns
@NEEDS_RS274
@each_case(goes)
def test_linuxcnc_goes_the_same_way(case, tmp_path):
    called = {key: text for key, text in case.sections.items() if key.endswith(".ngc")}
    source = rs274.run(case.sections["input.nc"], called)
    written = rs274.run(case.sections.get("expected.nc") or result(case, tmp_path).text)
    changes_words = re.search("volumetric|offsets", case.text("pipeline.toml"))
    if changes_words or joins(case):  # ends are those of the words
        return
    ends = [move.machine[1] for move in written.moves]
    for move in source.moves:
        end = move.machine[1]
        while ends and any(abs(end[a] - ends[0][a]) > grid(case) for a in "XYZABC"):
            ends.pop(0)
        assert ends, f"line {move.line}: nothing ends at {end}"


@NEEDS_RS274
def test_linuxcnc_counts_from_the_zero_that_is_set_behind_compensated_moves(tmp_path):
    case = next(c for c in all_cases() if name(c.path) == "volumetric/zero-set-behind")
    source = rs274.run(case.sections["input.nc"])
    written = rs274.run(result(case, tmp_path).text)
    ends = [[move.machine[1]["X"] for move in program.moves][-3:] for program in (source, written)]
    assert ends[0] == pytest.approx([10.0, 25.0, 5.0], abs=1e-6)
    assert ends[1] == pytest.approx([end / 1.001 for end in ends[0]], abs=5.1e-4)


@NEEDS_RS274
@each_case(lambda case: for_linuxcnc(case) and case.diagnostics and "(rs274 2.9" in case.prose)
def test_linuxcnc_refuses_it_too(case):
    with pytest.raises(rs274.Rejected) as refusal:
        rs274.run(case.sections["input.nc"])
    assert refusal.value.line == int(case.diagnostics[0].split(":")[0])

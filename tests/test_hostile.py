"""Hostile input: what it may take, what it may reach, and what is left behind when a run is ended.

Each program or file here asked for all memory, never ended, or was answered by a traceback. A
process that gets one has half a gigabyte of memory and ten seconds, and says what is wrong.
"""

from __future__ import annotations

import os
import resource
from dataclasses import replace
from pathlib import Path

import pytest
from cli_kit import MODEL, PART, PIPELINE, call, process, workplace

import gcxform as gx
from gcxform.modal.state import Reading
from gcxform.syntax.source import Source
from gcxform.system.limits import Limits, in_force, limits

MEMORY = 500_000_000  # bytes
TIME = 10.0  # s of a processor
HEAD = "G21 G90 G17 G94\nG0 X0 Y0 Z0\nG1 F100 X1\n"
SUM = 'format = 1\nkind = "sum"\nmodels = [{}]\n'


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


def confined() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (3 * MEMORY, 3 * MEMORY))  # libraries are mapped, too


def refused(code: int, said: str, *words: str, **options: object) -> str:
    """Run a command that has little memory and time; return what it says. It has to refuse."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    found = process(*words, preexec_fn=confined, **options)
    message = found.stderr.decode()
    assert (found.returncode, found.stdout or b"") == (code, b""), message
    assert said in message
    assert "Traceback" not in message
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < TIME
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss  # that of a child until it begins
    assert after.ru_maxrss <= max(before.ru_maxrss, own) or after.ru_maxrss * 1024 < MEMORY
    return message


# --- programs ---

CHAIN = ("run", "-f", "linuxcnc", "-x")
LONG = {
    "ten thousand brackets": "#1=" + "[" * 10_000 + "1" + "]" * 10_000,
    "parameters of parameters": "#1=" + "#" * 10_000 + "1",
    "very many signs": "#1=" + "-" * 60_000 + "1",
    "a sum of very many terms": "#1=[1" + "+1" * 30_000 + "]",
    "brackets in a word": "G1 X" + "[" * 10_000 + "1" + "]" * 10_000,
    "quotients in arctangents": "#1=" + "ATAN[" * 5000 + "1" + "]/[1]" * 5000,
}


@pytest.mark.parametrize("line", LONG.values(), ids=LONG)
@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc"])
def test_expressions_without_end(line: str, dialect: str) -> None:
    text = f"{HEAD}{line}\nM2\n".encode()
    pipeline = gx.Pipeline.parse("absolute", dialect)
    with pytest.raises(gx.InputError, match=r"levels here; .*--limit nesting=|GX761"):
        pipeline.run(text)


def test_as_many_levels_as_are_allowed() -> None:
    pipeline = replace(gx.Pipeline.parse("metric", "fanuc"), reading=Reading(increment=0.001))
    for depth, allowed in ((95, None), (900, Limits(nesting=1000))):
        for value in (
            "[" * depth + "1" + "]" * depth,
            "[1" + "+1" * depth + "]",
            "-" * depth + "1",
        ):
            text = f"{HEAD}#1={value}\nX#1\nM30\n".encode()
            with in_force(allowed):
                assert pipeline.run(text).certificate.verified
                with pytest.raises(gx.InputError, match="levels here"):
                    pipeline.run(text.replace(b"=", b"=" + b"-" * 200))


SPIRAL = f"{HEAD}G2 I5 P1000000000\nG1 X20 Y20\nM2\n".encode()
GREEDY = {
    "turns": "segment chord-error=5um",
    "a chord error of nothing": "segment chord-error=1e-300",
    "a length of nothing": 'segment chord-error=1um max-length="1e-12 mm"',
    "turns in an error model": "volumetric model=model.toml part-origin=10,10,10",
}


@pytest.mark.parametrize("chain", GREEDY.values(), ids=GREEDY)
def test_moves_that_become_very_many(here: Path, chain: str) -> None:
    (here / "spiral.nc").write_bytes(SPIRAL)
    refused(3, "GX761", *CHAIN, chain, "spiral.nc")


def test_splines_that_become_very_many(here: Path) -> None:
    text = f"{HEAD}G5 I0 J3 P0 Q-3 X10 Y10\nM2\n".encode()
    with pytest.raises(gx.InputError, match="GX761"):
        gx.Pipeline.parse("segment chord-error=1e-300", "linuxcnc").run(text)


def test_a_limit_of_the_command_line_replaces_that_of_the_file(here: Path) -> None:
    (here / "job.toml").write_text(
        PIPELINE.replace("absolute", "segment") + 'chord-error = "1 um"\n[limits]\nrows = 50\n'
    )
    (here / "arc.nc").write_text(HEAD + "G3 X1 Y0 I50 J0\nM2\n")
    found = call("run", "-p", "job.toml", "arc.nc")
    assert (found.exit_code, "GX761" in found.stderr) == (3, True)
    assert "rows = 500 in [limits], or --limit rows=500" in found.stderr
    assert call("run", "-p", "job.toml", "--limit", "rows=5000", "arc.nc").exit_code == 0
    assert limits() == Limits()
    for wrong in ("rows", "rows=x", "rows=0", "row=5"):
        assert call("run", "-p", "job.toml", "--limit", wrong, "arc.nc").exit_code == 2


@pytest.mark.parametrize("last", [True, False])
@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_the_longest_line(end: bytes, last: bool) -> None:
    most = limits().line
    for length in (most - 1, most, most + 1, 3 * most):
        head = end.join([b"G90", b"(" + b"a" * 1000 + b")", b""]) * 500
        source = Source.of_bytes(head + b"(" + b"a" * (length - 2) + b")" + end * (not last), "it")
        if length <= most:
            assert b"".join(source.windows()) == source.stream.getvalue()  # type: ignore[attr-defined]
        else:
            with pytest.raises(gx.InputError, match=r"it:1001:1: error\[GX761\]"):
                b"".join(source.windows())


def test_all_of_very_many_wrong_lines_are_counted(here: Path) -> None:
    """Those that are alike are one finding, that names the first and says how many there are."""
    (here / "bad.nc").write_bytes(b"G0 X1 X2\n" * 200 + b"G0 Y1 Y2\n" * 3 + b"M2\n")
    found = call("check", "-f", "linuxcnc", str(here / "bad.nc"))
    assert found.exit_code == 1
    assert "also at lines 2, 3, 4, 5, 6 (194 more)" in found.output
    assert "2 findings at 203 lines" in found.output


def test_a_line_of_megabytes(here: Path) -> None:
    (here / "long.nc").write_bytes(b"G21\n" + b"(comment)" * 600_000 + b"\n")
    for chain in ("", "absolute"):
        assert "long.nc:2:1" in refused(3, "GX761", *CHAIN, chain, "long.nc")


# --- what is no file ---


@pytest.mark.parametrize("words", [("-",), ("/dev/zero",), ("zero.nc",)])
def test_a_device_as_a_program(here: Path, words: tuple[str, ...]) -> None:
    (here / "zero.nc").symlink_to("/dev/zero")
    with open("/dev/zero", "rb") as zeros:
        code, said = (3, "GX761") if words == ("-",) else (5, "GX901")
        refused(code, said, *CHAIN, "absolute", *words, stdin=zeros)


MACHINE = 'format = 1\ntool-table = "zero.tbl"\ntool-table-units = "mm"\n'
SPECIAL = {
    "a pipeline": ("run", "-p", "zero.toml", "part.nc"),
    "a machine": (*CHAIN, "absolute", "-m", "zero.toml", "part.nc"),
    "a tool table": (*CHAIN, "absolute", "-m", "tools.toml", "part.nc"),
    "a model": (*CHAIN, "volumetric model=zero.toml part-origin=0,0,0", "part.nc"),
    "a foreign model": (*CHAIN, "volumetric model=zero.cfg part-origin=0,0,0", "part.nc"),
    "a table": ("table", "show", "zero.cfg"),
}


@pytest.mark.parametrize("words", SPECIAL.values(), ids=SPECIAL)
@pytest.mark.parametrize("kind", ["device", "pipe"])
def test_a_special_file_as(here: Path, words: tuple[str, ...], kind: str) -> None:
    """Nobody ever writes into the pipe: to open it would be to wait for ever."""
    (here / "tools.toml").write_text(MACHINE)
    for name in ("zero.toml", "zero.tbl", "zero.cfg"):
        if kind == "pipe":
            os.mkfifo(here / name)
        else:
            (here / name).symlink_to("/dev/zero")
    found = call(*words, "--allow-outside")
    assert found.exit_code in (2, 5), found.output
    assert f"it is a {kind}, not a regular file" in found.stderr


def test_a_file_that_is_too_large(here: Path) -> None:
    with (here / "job.toml").open("ab") as file:
        file.truncate(10 * limits().file_size)
    said = refused(2, "--limit file-size=", "run", "-p", "job.toml", "part.nc")
    assert "it has more than" in said


def test_a_key_of_very_many_parts(here: Path) -> None:
    (here / "job.toml").write_text("format = 1\n" + ".".join(["a"] * 50_000) + " = 1\n")
    refused(2, "GX7", "run", "-p", "job.toml", "part.nc")


def test_a_sum_of_sums_of_sums(here: Path) -> None:
    for k in range(7):
        part = f'"{"model" if k == 6 else f"s{k + 1}"}.toml"'
        (here / f"s{k}.toml").write_text(SUM.format(", ".join([part] * 50)))
    refused(2, "GX761", *CHAIN, "volumetric model=s0.toml part-origin=0,0,0", "part.nc")
    for k in range(400):
        (here / f"s{k}.toml").write_text(SUM.format(f'"s{k + 1}.toml"'))
    (here / "s400.toml").write_text(MODEL)
    model = "volumetric model=s0.toml part-origin=0,0,0"
    found = call(*CHAIN, model, "--limit", "parts=1000", "part.nc")
    assert (found.exit_code, "--limit nesting=" in found.stderr) == (2, True), found.stderr


# --- what files name, and what is shown of them ---


def test_what_files_name_stays_in_their_folder(here: Path, tmp_path: Path) -> None:
    """Also through a link, and from a file that another one names."""
    outside = tmp_path / "outside"
    job = tmp_path / "job"
    outside.mkdir()
    (job / "below").mkdir(parents=True)
    os.chdir(job)
    (outside / "model.toml").write_text(MODEL)
    (job / "part.nc").write_bytes(PART)
    (job / "link.toml").symlink_to(outside / "model.toml")
    (job / "below" / "sum.toml").write_text(SUM.format('"../../outside/model.toml"'))
    (job / "machine.toml").write_text('format = 1\nerrors = "../outside/model.toml"\n')
    step = '[[pass]]\nuse = "volumetric"\npart-origin = [10, 10, 10]\noutside = "extrapolate"\n'
    for name in ("../outside/model.toml", f"{outside}/model.toml", "link.toml", "below/sum.toml"):
        (job / "job.toml").write_text(f'{PIPELINE}{step}model = "{name}"\n')
        found = call("run", "-p", "job.toml", "part.nc")
        assert (found.exit_code, "GX760" in found.stderr) == (2, True), (name, found.output)
        assert "--allow-outside" in found.stderr
        assert call("run", "--allow-outside", "-p", "job.toml", "part.nc").exit_code == 0
        own = f"absolute | volumetric model={name} part-origin=10,10,10 outside=extrapolate"
        assert call(*CHAIN, own, "part.nc").exit_code == (2 if "sum" in name else 0)
    found = call(*CHAIN, "absolute", "-m", "machine.toml", "part.nc")
    assert (found.exit_code, "machine.toml:2:1" in found.stderr) == (2, True), found.stderr


def test_files_may_name_others_below_the_working_folder(here: Path) -> None:
    (here / "jobs").mkdir()
    (here / "jobs" / "job.toml").write_text(PIPELINE + '[machine]\nfile = "../mill.toml"\n')
    (here / "mill.toml").write_text("format = 1\n")
    assert call("run", "-p", "jobs/job.toml", "part.nc").exit_code == 0
    os.chdir(here / "jobs")
    assert "GX760" in call("run", "-p", "job.toml", "../part.nc").stderr


SECRET = "root:$6$aVerySecretHash:19000:0:99999:7:::\nuser:$6$another:19000:0:::\n"


@pytest.mark.parametrize("form", ["{}", "\xff\n{}", "[{}", 'x = "{}"\n='])
def test_what_is_no_file_of_ours_is_not_shown(here: Path, form: str) -> None:
    (here / "shadow").write_text(form.format(SECRET), "latin-1")
    (here / "shadow.toml").write_text(form.format(SECRET), "latin-1")
    (here / "sum.toml").write_text(SUM.format('"shadow.toml"'))
    (here / "tools.toml").write_text(MACHINE.replace("zero.tbl", "shadow"))
    (here / "warm.toml").write_text(
        'format = 1\nkind = "thermal-screw"\nreadings = "shadow"\ntime = "2026-01-01T00:00"\n'
        "[X]\nexpansion = 1e-5\nreference = 20.0\nfixed = 0.0\n"
    )
    model = "volumetric part-origin=0,0,0 model="
    for words in (
        ("run", "-p", "shadow", "part.nc"),
        (*CHAIN, "absolute", "-m", "shadow.toml", "part.nc"),
        (*CHAIN, "absolute", "-m", "tools.toml", "part.nc"),
        (*CHAIN, f"{model}shadow.toml", "part.nc"),
        (*CHAIN, f"{model}shadow", "part.nc"),
        (*CHAIN, f"{model}sum.toml", "part.nc"),
        (*CHAIN, f"{model}warm.toml", "part.nc"),
    ):
        found = call(*words)
        assert found.exit_code == 2, (words, found.output)
        assert "Secret" not in found.stderr, words
        assert "another" not in found.stderr, words

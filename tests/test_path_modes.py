"""Cycles that are written out under G64: in G61, as the control itself makes their moves."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from oracles import rs274
from oracles.canon import CanonProgram

import gcxform as gx
from gcxform.emit.emitter import Emitted
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

Line = tuple[bytes, int, int]  # text, line of the input from 0, which of its moves comes first
Change = Callable[[list[Line]], list[Line]]

HEAD = b"G21 G90 G94 G17\nG0 X0 Y0 Z20\n"
TWO_CYCLES = HEAD + (
    b"G64 P0.5 Q0.050\n"
    b"G1 X5 F200\n"
    b"N10 G98 G82 X10 Z-5 R2 P1 F100 (first) M8\n"
    b"N20 X20 M1\n"
    b"G80\n"
    b"G1 X30 Y5\n"
    b"G64\n"
    b"G91 G99 G83 X5 Z-4 R-10 Q1.5 L2\n"
    b"G90 G80\n"
    b"G61\n"
    b"G81 X60 Z-5 R2\n"
    b"G64 P.002\n"
    b"G85 X70 Z-5 R2\n"
    b"G80\n"
    b"G1 X80\n"
    b"M2\n"
)
TAP = HEAD + (
    b"S100 M3\nG64 P1\nG81 X10 Z-5 R2 F100\nG80\nG0 X15\n"
    b"G84 X20 Z-5 R2\nG80\nG0 X25\nG81 X30 Z-5 R2\nX40\nG80\nG1 X0\nM2\n"
)
INCHES = b"G20 G90 G94 G17\nG0 X0 Y0 Z2\nG64 P.0125\n/G81 X1 Z-.5 R.2 F10\nG80\nG1 X0\nM2\n"
SPINDLE = HEAD + b"S100 M3\nG64\nG86 X10 Z-5 R2 P0 F100\nX20\nG80\nG1 X0\nM2\n"
PROGRAMS = {"two cycles": TWO_CYCLES, "tap": TAP, "inches": INCHES, "spindle": SPINDLE}

CYCLE = b"G81 X10 Z-5 R2 F100\nG80\nM2\n"
REFUSED = {
    "computed": (b"#1=0.5\nG64 P#1\n" + CYCLE, "computed", b"P#1", b"P0.5"),
    "called": (
        b"o1 sub\nG64 P1\no1 endsub\no1 call\n" + CYCLE,
        "subprogram",
        b"call\n",
        b"call\nG64 P1\n",
    ),
    "in its block": (b"G64 P1 " + CYCLE, "its block", b"P1 G81", b"P1\nG81"),
    "in another unit": (b"G64 P1\nG20\n" + CYCLE, "another unit", b"G20\n", b"G20\nG64 P.04\n"),
    "in the last block": (b"G64\nG81 X10 Z-5 R2 F100 M2\n", "behind", b" M2", b"\nM2"),
}


def chain(block_delete: str = "execute") -> gx.Pipeline:
    pipeline = gx.Pipeline.parse("cycles", "linuxcnc")
    return replace(pipeline, reading=replace(pipeline.reading, block_delete=block_delete))


def expanded(program: bytes, block_delete: str = "execute") -> bytes:
    return chain(block_delete).run(program).text


def run(change: Change, program: bytes, size: int = 1 << 19) -> bytes:
    """Expand cycles with an emitter that lies: its lines are changed before they are verified."""
    job, texts = Run(chain(), Source.of_bytes(program), "full"), list[bytes]()
    assert job.stages is not None
    emitter = job.stages.emitter
    emit = emitter.emit

    def lying(*task: object) -> Emitted:
        right = emit(*task)  # type: ignore[arg-type]
        lines = right.text.splitlines(keepends=True)
        given = zip(lines, right.source.tolist(), right.nth.tolist(), strict=True)
        changed = [
            (text, number, nth)
            for several, number, nth in change(list(given))
            for text in several.splitlines(keepends=True)
        ]
        source, nth = (np.array([line[k] for line in changed], np.int64) for k in (1, 2))
        return Emitted(b"".join(line[0] for line in changed), source, nth)

    emitter.emit = lying  # type: ignore[method-assign]
    job.over(Output(texts.append, None), lambda _: None, size)
    return b"".join(texts)


def modes(program: CanonProgram) -> list[tuple[object, ...]]:
    """Return kind, end and what path mode with what tolerances is in force, of moves that move."""
    found: list[tuple[object, ...]] = []
    told = [each for each in program.told if "SET_MOTION_CONTROL" in each[1] or "NAIVE" in each[1]]
    for number, move in enumerate(program.moves):
        now = dict(text.split(" ", 1) for at, text in told if at <= number)
        if "EXACT" in now.get("SET_MOTION_CONTROL_MODE", ""):
            now = {"SET_MOTION_CONTROL_MODE": now["SET_MOTION_CONTROL_MODE"]}
        if move.start != move.end:
            found.append((move.kind, tuple(round(v, 3) for v in move.end.values()), now))
    return found


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("name", PROGRAMS)
def test_each_move_is_made_in_the_path_mode_of_the_cycle(name: str) -> None:
    """LinuxCNC goes to exact path before a cycle and back behind it, and so does what is written.

    Of a tap it makes one motion; slashes are taken out, because it would skip these blocks.
    """
    source, written = PROGRAMS[name], expanded(PROGRAMS[name])
    was, now = (modes(rs274.run(text.replace(b"/", b""))) for text in (source, written))
    assert any("EXACT" in str(move) for move in was)
    assert any("CONTINUOUS" in str(move) for move in was)
    assert now == was


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("size", [1, 40, 1 << 19])
def test_windows_do_not_matter(name: str, size: int) -> None:
    assert run(list, PROGRAMS[name], size) == expanded(PROGRAMS[name])


def test_no_cycle_is_left_that_could_be_written() -> None:
    assert expanded(TWO_CYCLES).count(b"\nG61\n") == 2 + 1 + 1 + 1
    assert expanded(TAP).count(b"\nG61\n") == 3


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_stated_again_is_refused_and_the_hint_works(name: str) -> None:
    text, message, old, new = REFUSED[name]
    with pytest.raises(gx.InputError, match=message) as refusal:
        expanded(HEAD + text)
    assert [each.code for each in refusal.value.diagnostics] == ["GX506"]
    assert b"G61\n" in expanded(HEAD + text.replace(old, new))
    if "write G61 before" in refusal.value.diagnostics[0].hint:
        assert b"G64 P.1" not in expanded(HEAD + text.replace(b"G81", b"G61\nG81"))


def test_a_switch_that_decides_is_refused() -> None:
    with pytest.raises(gx.InputError, match="GX211"):
        expanded(HEAD + b"/G64 P1\n" + CYCLE, "")
    assert b"G61" not in expanded(HEAD + b"/G64 P1\n" + CYCLE, "skip")


def test_the_account_names_what_is_added() -> None:
    held = gx.Pipeline.parse("cycles", "linuxcnc").run(TWO_CYCLES).certificate.inventory
    rules = {"G61 and G64 around cycles written out": 8}
    assert held["path_modes"] == {"source": 4, "output": 12, "rules": rules}


SIMPLE = HEAD + b"G64 P0.5\nG81 X10 Z-5 R2 F100\nX20\nG80\nG1 X30\nM2\n"


def said(old: str, new: str, number: int) -> Change:
    """Say something else, or nothing, among what was written for a line of the input."""

    def change(lines: list[Line]) -> list[Line]:
        assert any(old.encode() in text and at == number for text, at, _ in lines)
        return [
            (t.replace(old.encode(), new.encode()) if at == number else t, at, nth)
            for t, at, nth in lines
        ]

    return change


def late(lines: list[Line]) -> list[Line]:
    """Go to exact path one move late."""
    at = next(k for k, line in enumerate(lines) if line[0] == b"G61\n")
    return [*lines[:at], lines[at + 1], lines[at], *lines[at + 2 :]]


def behind(text: bytes, number: int) -> Change:
    """Write one line more behind what was written for a line of the input."""

    def change(lines: list[Line]) -> list[Line]:
        at = 1 + max(k for k, line in enumerate(lines) if line[1] == number)
        return [*lines[:at], (text, number, 0), *lines[at:]]

    return change


TAMPERED: dict[str, Change] = {
    "G61 is missing": said("G61\n", "", 3),
    "G61 is another": said("G61\n", "G61.1\n", 3),
    "G61 comes late": late,
    "G61 comes twice": said("G64 P0.5\n", "G61\nG64 P0.5\n", 3),
    "G64 is missing between the cycles": said("G64 P0.5\n", "", 3),
    "G64 is missing behind them": said("G64 P0.5\n", "", 4),
    "G64 has another tolerance": said("P0.5", "P0.6", 4),
    "G64 has none": said(" P0.5", "", 4),
    "G64 comes twice": behind(b"G64 P0.5\n", 4),
    "G61 stays at the end": behind(b"G61\n", 6),
    "G64 of the source is missing": said("G64 P0.5\n", "\n", 2),
    "a pair around no cycle": behind(b"G61\nG64 P0.5\n", 6),
}


@pytest.mark.parametrize("name", TAMPERED)
def test_the_proof_finds_other_path_modes(name: str) -> None:
    with pytest.raises(gx.VerificationError, match=r"G61|G64|path mode"):
        run(TAMPERED[name], SIMPLE)


def test_the_proof_looks_at_what_is_left_behind() -> None:
    last = SIMPLE.replace(b"G1 X30\n", b"")
    with pytest.raises(gx.VerificationError, match=r"G64 P0\.5 is left as G64 P0\.6"):
        run(said("P0.5", "P0.6", 4), last)


def test_what_is_not_tampered_with_passes() -> None:
    assert run(list, SIMPLE) == expanded(SIMPLE)

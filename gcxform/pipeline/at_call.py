"""Where a subprogram that is compensated is called: it begins and ends at commands of its caller.

The caller knows nothing of errors. It leaves the axes at its own command, where no cut may begin:
before a first move that feeds stands a rapid, some micrometres long, to the command of that place.
It goes on from the command that the subprogram leaves, in G91 with every axis, in G90 with those
that it does not name: before the return stands a block that goes back to what the source leaves.

The first is a move to where the axes stand, put into the program as it is read, and proved with
all others. The other is not of the path that is proved; what it does is read again from the
finished text.
"""

from __future__ import annotations

import io

import numpy as np

from gcxform.diagnostics import InputError, Location
from gcxform.dialect.dialect import INCH, LINEAR
from gcxform.emit.numbers import text_of
from gcxform.flow.straightened import written_out
from gcxform.modal.interpreter import Interpreter
from gcxform.modal.meaning.tables import COLUMNS, NUMBER
from gcxform.modal.reader import WindowReader, windows_of
from gcxform.modal.state import State
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source, line_end
from gcxform.system.arrays import Floats

FROM_THE_START = "GX317"
MOTIONS = {NUMBER["G0"]: "G0", NUMBER["G1"]: "G1"}
DISTANCES = {NUMBER[code]: code for code in ("G90", "G91")}
SAID_ANEW = {"distance": DISTANCES, "motion": {NUMBER[f"G{n}"]: f"G{n}" for n in range(4)}}
INVERSE_TIME = NUMBER["G93"]
EXACT = 1e-7  # mm or degrees: what sums of decimals leave


class Led(Source):
    """A program with blocks put in before a line, counted from 1; places are those of the file."""

    def __init__(self, source: Source, line: int, blocks: tuple[str, ...]) -> None:
        lines = b"".join(source.windows()).splitlines(keepends=True)
        end = line_end(lines[line - 1])
        lines[line - 1 : line - 1] = [block.encode() + end for block in blocks]
        super().__init__(io.BytesIO(b"".join(lines)), source.name, source.written)
        self.folder, self.suffix, self.state = source.folder, source.suffix, source.state
        self.line, self.more = line, len(blocks)

    def line_of(self, line: int) -> int:
        """Return the line of the file; of what was put in, that which it stands before."""
        return line if line < self.line else max(self.line, line - self.more)


def led_in(source: Source, plan: Plan, where: Location) -> Source | None:
    """Return a program that goes, before its first move, to where the axes stand.

    None if another place is meant, or one that is executed again: in other modes, perhaps, and at
    another place. None too if nobody says in which modes that block would be read.
    """
    entry, axes = plan.reading.entry, "".join(filter(LINEAR.__contains__, plan.reading.start))
    said = {plan.source.codes[code].group: code for code in entry.modes}
    straight = written_out(source, plan.source, plan.machine_reading, plan.target)
    reader = WindowReader(plan.source)
    window = reader.read(b"".join(straight.windows()))
    reader.table.update()
    here = [n for n in range(len(window)) if straight.place_of(n + 1) == (source.name, where.line)]
    before = window.shape[: here[0] if here else 0]
    moves = reader.table.slots[before][:, [ord(axis) - ord("A") for axis in LINEAR]] >= 0
    for group, codes in SAID_ANEW.items():
        stated = reader.table.groups[before, COLUMNS.index(group)]
        if (stated >= 0).any():
            said[group] = codes.get(int(stated[stated >= 0][-1]), "")
    if where.file != source.name or len(here) != 1 or not axes or moves.any():
        return None
    if "distance" not in said or "" in said.values():
        return None
    way = "G0 " + " ".join(f"{axis}0." for axis in axes)
    incremental = said["distance"] == "G91"
    again = [said["distance"]] * (not incremental) + [*filter(None, [said.get("motion")])]
    blocks = (way if incremental else f"G91 {way}", *filter(None, [" ".join(again)]))
    return Led(source, where.line, blocks)


def going_back(run: Run) -> tuple[str, ...]:
    """Return the blocks that go back before the return; none if the axes stand there.

    Raises InputError where such a block would say something else.
    """
    before, after = _ends(run)
    gap = before.position - after.position
    if (np.isnan(before.position) != np.isnan(after.position)).any():
        raise _refusal("an axis would be known behind it, or lost, that was not so before")
    axes = np.flatnonzero(np.abs(np.nan_to_num(gap)) > _steps(run, before)).tolist()
    if not axes:
        return ()
    motion = MOTIONS.get(before.groups["motion"])
    if motion is None or before.groups["feed-mode"] == INVERSE_TIME:
        raise _refusal("it ends in an arc, in a cycle or in inverse time")
    incremental = bool(before.groups["distance"])
    inch = bool(before.groups["units"])
    letters = run.stages.interpreter.axes if run.stages else ""
    words = [_word(run, letters[axis], float(gap[axis]), inch) for axis in axes]
    way = " ".join((motion, *words))
    return (way,) if incremental else (f"G91 {way}", "G90")


def check_left(text: bytes, run: Run) -> None:
    """Check that a finished text leaves its caller what the source leaves. Raises InputError."""
    assert run.stages is not None
    assert run.stages.verifier is not None
    proof, before = run.stages.verifier.interpreter, run.stages.interpreter.state
    plan, given = run.plan, Source.of_bytes(text, "output")
    given.folder = run.given.folder
    executed = written_out(given, plan.target, plan.machine_reading, plan.target)
    again = Interpreter(plan.target, proof.reading, proof.axes, "output")
    begun = Interpreter(run.dialect, proof.reading, proof.axes, run.source.name)
    places = [_let_go(begun, run.source), _let_go(again, executed)]
    left = again.state
    gap = np.nan_to_num(np.abs(left.position - before.position))
    known = (np.isnan(left.position) == np.isnan(before.position)).all()
    other = [g for g, code in before.groups.items() if left.groups[g] != code]
    if not known or (gap > _steps(run, before)).any() or other:
        raise _refusal("its caller would find the axes or modes otherwise than they were")
    if (np.abs(np.nan_to_num(places[0] - places[1])) > _steps(run, before)).any():
        raise _refusal("behind it an axis is lost, and stands elsewhere than its caller expects")


def _let_go(reads: Interpreter, source: Source) -> Floats:
    """Interpret a program; return where axes stood as a block lost them that did not move them.

    (axes,) mm or degrees; nan for all others. An axis that goes to a point of the machine is not
    known behind it either, and stands there whatever was written before.
    """
    gone = np.full(len(reads.axes), np.nan)
    for window, reader in windows_of(source, reads.dialect):
        path = reads.interpret(window, reader.table).path
        stood = np.vstack([path.entry, path.end])
        lost = np.append(path.lost, -1)  # what no move follows has lost none of its own
        for axis in np.flatnonzero(np.isfinite(stood).any(axis=0)).tolist():
            last = int(np.flatnonzero(np.isfinite(stood[:, axis]))[-1])
            gone[axis] = stood[last, axis] if int(lost[last]) >> axis & 1 else np.nan
    return np.where(np.isnan(reads.state.position), gone, np.nan)


def _ends(run: Run) -> tuple[State, State]:
    """Return what the source leaves, and what is written for it."""
    assert run.stages is not None
    assert run.stages.verifier is not None
    return run.stages.interpreter.state, run.stages.verifier.interpreter.state


def _steps(run: Run, state: State) -> Floats:
    """Return half of the last decimal of each axis, mm or degrees."""
    assert run.stages is not None
    inch = bool(state.groups["units"])
    steps = [run.plan.manner.step(axis, inch) for axis in run.stages.interpreter.axes]
    return np.array(steps) * 0.5 + EXACT


def _word(run: Run, axis: str, way: float, inch: bool) -> str:
    """Return the word of an axis for a way in mm or degrees."""
    manner = run.plan.manner
    value = way / INCH if inch and axis in "XYZUVW" else way
    return axis + text_of(value, manner.decimals_of(axis, inch), manner.numbers.zeros)


def _refusal(message: str) -> InputError:
    hint = "transform the program that calls it: it is looked up beside that"
    return InputError.one("GX226", message, hint=hint)

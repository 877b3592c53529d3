"""Faults planted into a run that lose or double something: the proof of the run catches each.

The faults are in the writer, the executer and the framing, not in a pass: no test of theirs is
asked, only whether the run says PASS. Every fault is shown to bite: without it the program passes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import gcxform as gx
from gcxform.dialect.program_rules import LookupRule
from gcxform.emit.emitter import Emitted, Emitter
from gcxform.flow import lasting_values as lasting
from gcxform.flow.execution import Execution
from gcxform.flow.line_account import check_walk
from gcxform.flow.listing import Listing
from gcxform.flow.lookup import Folders
from gcxform.flow.macros import MacroB
from gcxform.flow.owords import OWords
from gcxform.modal.line_notes import Assigned, Assignments
from gcxform.modal.program_end import Frame
from gcxform.modal.state import Reading
from gcxform.plugin.registry import default_registry
from gcxform.proof.inventory import assignments_differ

NOWHERE = Folders((), LookupRule())
STRAIGHT = b"""G21 G90 G94
#<_deep>=2.5
G0 X1
(DEBUG, depth #<_deep>)
M3 S100
#100=[#<_deep>*2]
G1 X2 F100
M0
M5
M2
o<kept> sub
G1 X9
o<kept> endsub
"""
LOOP = b"""G21 G90 G94
G0 X0
o1 repeat [3]
#100=[7+#1]
G91 G1 X1 F100
G90
(DEBUG, #100)
o1 endrepeat
G0 X10
G0 X11
M2
o<kept> sub
G1 X9
o<kept> endsub
"""
MACRO = b"O1\nG21 G90\n#1=0\nWHILE[#1LT2]DO1\n#500=#1\nG0 X#1\n#1=#1+1\nEND1\nG0 X5.\nG0 X6.\nM30\n"
LOST = b"""O1
G21 G90 G94
G0 X0. Y0. Z5.
#501=#501+1
#502=#1005
G1 X5. F#510
G0 Y#511
S#512 M3
G4 P#513
G0 Y1.
M30
"""
WAITS = b"""O1
G21 G90 G94
G0 X0. Y0. Z5.
#1=3.
N10 IF[#1005 EQ 0]GOTO10
IF[#501 GT #1]GOTO20
#1=4.
G0 Z6.
N20 G0 X5. Z#1
IF[#1006 EQ 1]THEN #502=#502+1
WHILE[#1007 EQ 0]DO1
G4 P100
END1
G0 Z9.
M30
"""
SLASH = b"O1\nG21 G90 G94\nG0 X0. Y0. Z5.\n/M8\nM1\n/G4 P100\nX5.\nM30\n"
WITHIN = b"O1\nG21 G90 G94\nG0 X0. Y0. Z5. /M8\nX5. /M9\nM30\n"
PROBE = b"G21 G90 G94\nG91 G38.2 Z-20 F50\nG90 G0 Z5\nM2\n"
GRBL = b"G21 G90 G94\nG0 X1\nG1 X2 F100\n"


def run(program: bytes, source: str = "linuxcnc", target: str = "") -> gx.Result:
    pipeline = gx.Pipeline.parse("absolute", source)
    told = replace(pipeline.reading, parameters={"1": 0.0}, increment="IS-B")
    written = default_registry().dialect(target or source)
    return replace(pipeline, reading=told, target=written).run(program)


def rewrites(old: bytes, new: bytes) -> Callable[[pytest.MonkeyPatch], None]:
    """Return a fault: the writer writes something else, and drops lines that become nothing."""

    def plant(patch: pytest.MonkeyPatch) -> None:
        emit = Emitter.emit

        def wrong(self: Emitter, *given: object) -> Emitted:
            right = emit(self, *given)
            lines = right.text.replace(old, new, 1).splitlines(keepends=True)
            before = right.text.splitlines(keepends=True)
            if len(lines) == len(before):
                return replace(right, text=b"".join(lines))
            at = before.index(old)
            columns = np.delete(right.source, at), np.delete(right.nth, at)
            if len(lines) > len(before):
                columns = tuple(np.insert(c, at, c[at]) for c in (right.source, right.nth))
            return Emitted(b"".join(lines), *columns)

        patch.setattr(Emitter, "emit", wrong)

    return plant


def replaces(owner: object, name: str, wrong: object) -> Callable[[pytest.MonkeyPatch], None]:
    return lambda patch: patch.setattr(owner, name, wrong)


def lost_copy(self: Execution, stop: int) -> None:
    """Take the lines but for the last one."""
    lines = np.arange(self.at, stop)
    self.times[lines] += 1
    self.put(self.listing.raw(self.at, stop - 1), lines[:-1])
    self.at = stop


def short_copy(self: Execution, stop: int) -> None:
    """Leave out the first line without any trace, behind which nothing jumps."""
    first = self.at + (self.at > 0 and stop - self.at > 1)
    self.put(self.listing.raw(first, stop), np.arange(first, stop))
    self.times[first:stop] += 1
    self.at = stop


def long_leave(self: OWords, construct: object) -> None:
    """Go on one line too far behind a loop."""
    self.counters.pop(construct.lines[0], None)  # type: ignore[attr-defined]
    self.at = construct.last + 2  # type: ignore[attr-defined]


def long_while(self: MacroB, statement: object) -> None:
    """The same in macro B."""
    if not self._holds(statement):  # type: ignore[arg-type]
        self.at = self.loops[self.line].last + 2


def silent(self: lasting.Lasting, key: object, value: float, kept: str = "") -> str:
    self.outputs.assign(key, value)  # type: ignore[arg-type]
    return ""


def off(self: lasting.Lasting, key: object, value: float, kept: str = "") -> str:
    self.outputs.assign(key, value)  # type: ignore[arg-type]
    return f"#{key}={value + 1.0}" if self.program.arithmetic.outlives(key) else ""  # type: ignore[arg-type]


FAULTS = {
    "an assignment is dropped": (STRAIGHT, rewrites(b"#<_deep>=2.5\n", b"")),
    "an assignment has another value": (STRAIGHT, rewrites(b"=2.5", b"=2.6")),
    "an assignment is another parameter's": (STRAIGHT, rewrites(b"#100=", b"#101=")),
    "an assignment is doubled": (STRAIGHT, rewrites(b"#<_deep>=2.5\n", b"#<_deep>=2.5\n" * 2)),
    "an M code is doubled": (STRAIGHT, rewrites(b"M5\n", b"M5\nM5\n")),
    "an M code is dropped": (STRAIGHT, rewrites(b"M5\n", b"")),
    "an M code is another": (STRAIGHT, rewrites(b"M3 ", b"M4 ")),
    "a stop is dropped": (STRAIGHT, rewrites(b"M0\n", b"")),
    "an optional stop": (STRAIGHT, rewrites(b"M0\n", b"M1\n")),
    "a message is dropped": (STRAIGHT, rewrites(b"(DEBUG, depth #<_deep>)\n", b"")),
    "a message is no message": (STRAIGHT, rewrites(b"(DEBUG,", b"(bug,")),
    "the end is dropped": (STRAIGHT, rewrites(b"M2\n", b"")),
    "a subprogram behind the end loses its name": (STRAIGHT, rewrites(b"o<kept> sub\n", b"")),
    "a line behind the end is dropped": (STRAIGHT, rewrites(b"G1 X9\n", b"")),
    "a run of lines loses its last": (LOOP, replaces(Execution, "_copy", lost_copy)),
    "a run of lines loses its first": (LOOP, replaces(Execution, "_copy", short_copy)),
    "a line behind a loop is dropped": (LOOP, replaces(OWords, "_leave", long_leave)),
    "a line behind a WHILE is dropped": (MACRO, replaces(MacroB, "_while", long_while)),
    "what lasts is not written": (LOOP, replaces(lasting.Lasting, "account", silent)),
    "what lasts is off": (LOOP, replaces(lasting.Lasting, "account", off)),
    "a counter counts otherwise": (LOST, rewrites(b"#501+1", b"#501+2")),
    "a counter is another": (LOST, rewrites(b"=#1005", b"=#1006")),
    "a counter is known": (LOST, rewrites(b"#502=#1005", b"#502=1.")),
    "a feed is another variable": (LOST, rewrites(b"F#510", b"F#514")),
    "a feed that is not known is left out": (LOST, rewrites(b" F#510", b"")),
    "an axis goes to another variable": (LOST, rewrites(b"Y#511", b"Y#514")),
    "an axis is not lost": (LOST, rewrites(b"Y#511", b"Y511.")),
    "a speed is another variable": (LOST, rewrites(b"S#512", b"S#514")),
    "a time is another variable": (LOST, rewrites(b"P#513", b"P#514")),
    "a wait is left out": (WAITS, rewrites(b"N10 IF[#1005 EQ 0]GOTO10\n", b"")),
    "a wait is for another input": (WAITS, rewrites(b"#1005", b"#1006")),
    "a jump goes elsewhere": (WAITS, rewrites(b"GOTO20", b"GOTO10")),
    "a label is lost": (WAITS, rewrites(b"N20 ", b"")),
    "a label is another": (WAITS, rewrites(b"N20 ", b"N21 ")),
    "a branch asks for something else": (WAITS, rewrites(b"GT 3.", b"GE 3.")),
    "what perhaps is set is another": (WAITS, rewrites(b"#502+1", b"#502+2")),
    "a loop has no end": (WAITS, rewrites(b"END1\n", b"")),
    "what is needed is left out": (WAITS, rewrites(b"#1=3.\n", b"")),
    "a slash is lost": (SLASH, rewrites(b"/M8", b"M8")),
    "a slash within a block is lost": (WITHIN, rewrites(b" /M8", b" M8")),
    "what a slash within a block has behind it is lost": (WITHIN, rewrites(b" /M9", b"")),
    "a slash is lost before a dwell": (SLASH, rewrites(b"/G4", b"G4")),
    "a block gets a slash": (SLASH, rewrites(b"M1", b"/M1")),
    "a probe from nowhere known goes further": (PROBE, rewrites(b"Z-20", b"Z-25")),
    "percent signs are forgotten": (GRBL, replaces(Frame, "put", lambda s, t, a, b: (t, 0, 0))),
    "only one percent sign": (
        GRBL,
        replaces(Frame, "put", lambda s, t, a, b: (b"%\n" + t, 1, 0)),
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_the_proof_of_a_run_catches(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    program, plant = FAULTS[name]
    fanuc = "fanuc", "fanuc"
    macros = dict.fromkeys((MACRO, LOST, WAITS, SLASH, WITHIN), fanuc)
    kinds = {**macros, GRBL: ("grbl", "linuxcnc")}.get(program, ("linuxcnc",) * 2)
    assert run(program, *kinds).certificate.verified
    plant(monkeypatch)
    with pytest.raises((gx.VerificationError, gx.InputError)):
        run(program, *kinds)


def test_an_account_of_kinds_and_rules() -> None:
    found = run(LOOP).certificate.inventory
    assert (found["motions"]["source"], found["motions"]["output"]) == (5, 7)
    assert found["motions"]["rules"] == {"calls and loops written out": 2}
    assert found["definitions"] == {"source": 1, "output": 1, "rules": {}}
    assert found["assignments"]["output"] == found["messages"]["output"] == 3
    for kind in found.values():
        assert kind["source"] + sum(kind["rules"].values()) == kind["output"]
    signs = run(GRBL, "grbl", "linuxcnc").certificate.inventory["percent_signs"]
    assert signs == {"source": 0, "output": 2, "rules": {"linuxcnc wants an end": 2}}


# --- each check by itself: a fault that another one would find as well ---


def walked() -> OWords:
    """Return the execution of a loop, as it was."""
    told = Reading(parameters={"1": 0.0})
    lines = Listing(LOOP, default_registry().dialect("linuxcnc"), "-", NOWHERE)
    done = OWords(lines, told, keeps=True)
    done.run()
    check_walk(done)
    return done


def test_a_line_that_is_not_written_out_is_found() -> None:
    done = walked()
    done.origin[0] = done.origin[0][:-1]
    with pytest.raises(gx.VerificationError, match="not written out as often"):
        check_walk(done)


def test_a_line_that_does_not_follow_is_found() -> None:
    done = walked()
    done.times[5] -= 1  # G90 in the loop
    done.origin = [lines[lines != 5] for lines in done.origin] + [np.full(2, 5)]
    with pytest.raises(gx.VerificationError, match="behind this one is not executed as often"):
        check_walk(done)


def test_an_assignment_too_few_or_too_many_is_found() -> None:
    context = gx.Pipeline.parse("absolute", "linuxcnc").context
    trace = SimpleNamespace(line_of=lambda line: line, lines_of=lambda lines: lines)
    one, two = Assigned(0, 100, 1.0), Assigned(1, 101, 2.0)
    both, first = Assignments.of([one, two]), Assignments.of([one])
    assert assignments_differ(both, both, trace, context) is None
    for old, new in ((both, first), (first, both)):
        found = assignments_differ(old, new, trace, context)
        assert found is not None
        assert "#101=2 is missing or too many" in found[0]


def test_assignments_in_columns_are_the_same_by_name_and_text() -> None:
    context = gx.Pipeline.parse("absolute", "linuxcnc").context
    trace = SimpleNamespace(line_of=lambda line: line, lines_of=lambda lines: lines)
    made = [Assigned(0, 100, 1.0), Assigned(1, 101, 1.0), Assigned(2, 100, 1.0, "#100=#5")]
    old = Assignments.of(made)
    assert [*old] == made
    lines, values = np.arange(3), np.ones(3)
    names = (101, ""), (100, "#100=#5"), (100, "")
    turned = Assignments(lines, names, np.array([2, 0, 1]), values)
    assert [*turned] == made
    assert assignments_differ(old, turned, trace, context) is None
    for which in ([2, 2, 1], [2, 0, 2]):
        new = Assignments(lines, names, np.array(which), values)
        assert assignments_differ(old, new, trace, context) is not None


def test_a_name_of_a_program_is_in_the_balance(monkeypatch: pytest.MonkeyPatch) -> None:
    rewrites(b"O1\n", b"")(monkeypatch)
    with pytest.raises(gx.VerificationError, match="1 fewer definitions"):
        run(MACRO, "fanuc")


def test_what_a_straight_program_holds() -> None:
    found = run(STRAIGHT).certificate.inventory
    assert {kind: counts["output"] for kind, counts in found.items()} == {
        "motions": 3,
        "definitions": 1,
        "assignments": 2,
        "messages": 1,
        "stops": 1,
        "ends": 1,
        "m_codes": 2,
    }

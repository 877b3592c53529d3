"""A subprogram by itself: a file that another program calls, read from the state of its call.

What that state is `[entry]` says; what it does not say is unknown. What is written must leave the
state that the source leaves, so modes that the passes have changed are stated again before the
return. Where what is written would depend on what is not known the file is kept, byte for byte, if
no pass turns positions into others: whoever calls it finds what it was. The certificate says so.

A pass that does turn them keeps what moves nothing, or nothing but in what is not of this file, and
one that takes off errors what goes in rapids to points of the machine alone, which it leaves to
that. Errors are those of a place: all else is for the run of the program that calls it, or
`[entry]` says where the axes stand and in which modes. Then it begins and ends at commands that its
caller gives and expects (`at_call.py`).

The values that a call gives are parameters of `[entry]`. A file of O-words of whose call something
is said is read as the program that its one subprogram is (`gcxform/flow/oword_body.py`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import field, replace
from hashlib import sha256
from typing import Any

import numpy as np

from gcxform.diagnostics import Diagnostic, InputError, Location, Severity
from gcxform.dialect.dialect import Dialect
from gcxform.flow.arguments import asked
from gcxform.flow.detection import aliases
from gcxform.flow.lookup import Folders
from gcxform.flow.oword_body import Body, body_of
from gcxform.flow.straightened import located
from gcxform.flow.subprogram_file import Still
from gcxform.flow.uncalled_subprograms import HINT
from gcxform.modal.meaning.tables import COLUMNS, GROUPS, NUMBER, MeaningTable, code_of
from gcxform.modal.reader import windows_of
from gcxform.modal.state import Entry, State
from gcxform.pipeline.at_call import FROM_THE_START, check_left, going_back, led_in
from gcxform.pipeline.certificate import Certificate
from gcxform.pipeline.certify import WHOLE_FILE, certificate
from gcxform.pipeline.chain import compensates
from gcxform.pipeline.leaving import NOTHING, Leaving
from gcxform.pipeline.output import Output, Sink
from gcxform.pipeline.plan import Plan
from gcxform.pipeline.run import Progress, Run
from gcxform.stamps.comment import sealed_anew
from gcxform.syntax.scan import Window
from gcxform.syntax.source import Source, lines_in
from gcxform.system.arrays import Flags
from gcxform.values import dataclass

USES = {
    "units": "XYZUVWIJKRQF",
    "distance": "XYZABCUVW",
    "feed-mode": "F",
    "plane": "IJKR",
    "retract": "ZR",
}
"""The modal groups on which a block depends that has one of these addresses."""
CENTRES = {"arc-distance": "IJK"}
"""That of centres, where a control has more than one way."""
OF_PLACES = {"frame": "XYZABCUVW", "tool-length": "XYZUVW"}
"""Those on which it depends besides where an axis is in the machine."""
STATED_AGAIN = ("units", "plane", "distance", "feed-mode", "arc-distance")
LAST_OF_TEXT = "GX2"
HINT_OF_PLACES = (
    f'{HINT}; or say how it is called: modes = "G91 G21 G94 G17 G54 G49" in [entry], with the '
    "codes in force there, by its start where the axes stand, if that is one place, and by its "
    "parameters what the call gives"
)
AT_ONE_PLACE = (
    "its caller is not compensated, and has none of G41, G52, G68, G92 or a scale in force; where "
    "it is called from another place, the error of this one is taken off"
)
RADII = "its caller has G8 in force, by which X counts radii"
FOR_THIS_CALL = (
    "what is written is for a call with these values of parameters: with others it may go elsewhere"
)


@dataclass
class Held:
    """The text of a run and its source map, until it is known whether they are handed on."""

    parts: list[bytes] = field(default_factory=list)
    lines: list[int] = field(default_factory=list)


def run_subprogram(
    plan: Plan,
    source: Source,
    sink: Sink,
    verify: str,
    source_map: list[int] | None,
    progress: Progress,
) -> Certificate:
    """Run a plan on a file that is a subprogram by itself. Raises GcxformError."""
    folds = any(step.demands.folds for step in plan.path_passes)
    changes, held, again = plan.marks(source).changes, Held(), "on" if verify == "off" else verify
    still = _still_but_for(plan, source) if changes or folds else None
    if still is not None:
        done = certificate(*_run_of_text(plan, source, verify, held))
        but = f" but in {' and in '.join(still)}" if still else ""
        done.assumed.append(f"this is a subprogram in which nothing moves{but}: kept as it stands")
    elif folds:
        raise _refusal(HINT)
    elif changes and plan.reading.entry == Entry():
        done = _the_same(plan, source, again, held)
    elif changes:
        done = _called(plan, source, again, held)
    else:
        try:
            done = _called(plan, source, again, held)
        except InputError as why:
            if plan.source is not plan.target or why.diagnostics[0].code < LAST_OF_TEXT:
                raise
            held = Held()
            done = _kept(plan, source, verify, held, why.diagnostics[0])
    if source_map is not None:
        source_map += held.lines
    for part in held.parts:
        sink(part)
    progress(source.size)
    return done


def _refusal(hint: str) -> InputError:
    message = "this file is a subprogram: where its caller stands is not known here"
    return InputError.one("GX226", message, hint=hint)


def _the_same(plan: Plan, source: Source, verify: str, held: Held) -> Certificate:
    """Run a file of which nobody says how it is called. Raises InputError if it moves or changes.

    What moves in what it calls is not at hand, and nothing has been done that a stamp would say. Of
    a file that moves it is not enough that no byte would change: behind a G52 of its caller it goes
    elsewhere. A file of O-words executes nothing.
    """
    if plan.source.flow_rule.language == "o-words":
        raise _refusal(HINT_OF_PLACES)
    try:
        done = _entered(replace(plan, stamp=False), source, verify, held)
    except InputError as why:
        raise _refusal(HINT_OF_PLACES) from why
    same = b"".join(held.parts) == b"".join(source.windows())
    if done.checked["moves"] or not same:
        raise _refusal(HINT_OF_PLACES)
    done.assumed.remove(AT_ONE_PLACE)
    return done


def _still_but_for(plan: Plan, source: Source) -> list[str] | None:
    """Return in what a file moves that may stay all the same, in words; None if it may not stay.

    Folding shifts is not asked of it then.
    """
    if plan.source is not plan.target:
        return None
    reading, lookup = plan.machine_reading, plan.source.flow_rule.lookup
    beside = [source.folder] if source.folder is not None else []
    folders = Folders([*beside, *reading.subprograms], lookup, source.suffix)
    rapids = compensates(plan.path_passes)
    return Still(plan.source, aliases(reading.control), folders, rapids).but_for(source)


def _entered(plan: Plan, source: Source, verify: str, held: Held) -> Certificate:
    """Transform a subprogram from the state of its call. Raises InputError where that is open."""
    plan, body = at_entry(plan), source
    source = _led(plan, source, verify)
    run, _ = _done(plan, source, verify, Held())
    last = _last_line(run, body) if isinstance(body, Body) else -1
    codes = _left_otherwise(run)
    back = going_back(run) if plan.marks(source).changes else ()
    if codes or back:
        _refuse_moving_returns(run)
    run, out = _done(plan, source, verify, held, Leaving(codes, back, last))
    if codes and _left_otherwise(run):
        raise _open("the modes that it leaves cannot be restored", Location(source.name))
    found = certificate(run, out)
    said = " ".join(_said(plan)) or "nothing is given"
    found.assumed.append(f"this is a subprogram, and is entered in a state of which {said}")
    if plan.reading.parameters:
        found.assumed.append(FOR_THIS_CALL)
    if plan.marks(source).changes:
        check_left(b"".join(held.parts), run)
        found.assumed.append(AT_ONE_PLACE)
    return found


def _called(plan: Plan, source: Source, verify: str, held: Held) -> Certificate:
    """Transform a subprogram of O-words, for a call that says its arguments, if one is said."""
    if plan.source.flow_rule.language != "o-words" or plan.reading.entry == Entry():
        try:
            return _entered(plan, source, verify, held)
        except InputError as why:
            asked(why, source, plan.source, at_entry(plan).reading.parameters)
            raise
    body, inside = body_of(source, plan.source), Held()
    if plan.text_passes:
        raise body.refusal("its text is changed in a run of its own", body.first)
    body.refuse_unsaid(plan.source, at_entry(plan).reading.parameters)
    found = _entered(plan, body, verify, inside)
    found.assumed.append(RADII)
    found.not_checked = [each for each in found.not_checked if not each.startswith(WHOLE_FILE)]
    text = sealed_anew(body.whole(b"".join(inside.parts)))
    held.parts, held.lines = [text], [*inside.lines, *range(body.last + 1, len(body.lines))]
    for side, whole in ((found.source, b"".join(body.lines)), (found.output, text)):
        side |= {"lines": lines_in(whole), "sha256": sha256(whole).hexdigest()}
    return found


def _led(plan: Plan, source: Source, verify: str) -> Source:
    """Return a program whose first move begins where it can: see `at_call.py`."""
    if not plan.marks(source).changes:
        return source
    try:
        _done(plan, source, verify, Held())
    except InputError as why:
        first = why.diagnostics[0]
        if first.code == FROM_THE_START and first.where is not None:
            return led_in(source, plan, first.where) or source
    return source


def _said(plan: Plan) -> Iterator[str]:
    """Yield what is said of the state in which a subprogram is entered."""
    reading = plan.reading
    yield from reading.entry.modes
    yield from (f"{address}{value:g}" for address, value in reading.start.items())
    if reading.feed is not None:
        yield f"F{reading.feed:g}"
    yield from (f"#{name}={value:g}" for name, value in reading.parameters.items())


def at_entry(plan: Plan) -> Plan:
    """Return a plan for programs that begin where `[entry]` says. Raises InputError."""
    if plan.source is not plan.target:
        message = "this file is a subprogram, and is not translated by itself"
        raise InputError.one("GX226", message, hint=HINT)
    entry, reading = plan.reading.entry, plan.reading
    dialect = _begun(plan.source, entry.modes)
    reading = replace(
        reading,
        start=entry.start,
        feed=entry.feed,
        parameters={**reading.parameters, **entry.parameters},
        units="",
    )
    return replace(plan, source=dialect, target=dialect, reading=reading)


def _begun(dialect: type[Dialect], modes: tuple[str, ...]) -> type[Dialect]:
    """Return a dialect whose programs begin in modes, and otherwise in its own."""
    groups = {dialect.codes[code].group: code for code in modes}
    rule = replace(dialect.program_rule, unit_is_set=False)  # its caller sets it
    feeds = replace(dialect.feed_rule, turns_need_speed=False)  # and has said an S
    retract, cycles = groups.pop("retract", ""), dialect.cycle_rule
    if retract and cycles is not None:
        cycles = replace(cycles, initial_level=retract == "G98")
    initial = {**dialect.initial, **groups}
    begun = {"initial": initial, "program_rule": rule, "cycle_rule": cycles, "feed_rule": feeds}
    return type(dialect.__name__, (dialect,), begun)


def _done(
    plan: Plan, source: Source, verify: str, held: Held, leaves: Leaving = NOTHING
) -> tuple[Run, Output]:
    """Run once over the file, in one window. `leaves` is what is to be stated at its end."""
    run = Run(plan, source, verify, leaves)
    _refuse_unknown(run, plan)
    out = Output(held.parts.append, held.lines)
    run.over(out, lambda size: None, max(source.size, run.source.size) + 1)
    run.check_growth(out)
    return run, out


def _kept(plan: Plan, source: Source, verify: str, held: Held, why: Diagnostic) -> Certificate:
    """Keep a file as it stands, but for passes that change text."""
    run, out = _run_of_text(plan, source, verify, held)
    found = certificate(run, out)
    steps = " | ".join(step.name for step in plan.path_passes) or plan.target.name
    found.not_checked.append(f"{steps}: the subprogram is kept as it stands, because {why.message}")
    message = f"kept as it stands, a subprogram by itself: {why.message}"
    found.warnings.append(replace(why, code="GX228", message=message, severity=Severity.WARNING))
    return found


def _run_of_text(plan: Plan, source: Source, verify: str, held: Held) -> tuple[Run, Output]:
    only: Any = replace(plan, passes=plan.text_passes, budget=None)
    run, out = Run(only, source, verify), Output(held.parts.append, held.lines)
    run.over(out, lambda size: None)
    return run, out


# --- what is not known ---


def _refuse_unknown(run: Run, plan: Plan) -> None:
    """Raise InputError for a block that depends on a mode that nobody has said."""
    said = _groups_said(plan)
    uses_of = USES | (CENTRES if "G90.1" in plan.source.codes else {})
    uses_of |= OF_PLACES if plan.marks(run.given).changes else {}
    for window, reader in windows_of(run.source, run.dialect):
        table = reader.table
        table.update()
        found = {}
        for group, letters in uses_of.items():
            if group in said:
                continue
            stated = table.groups[window.shape, COLUMNS.index(group)] >= 0
            columns = [ord(letter) - ord("A") for letter in letters]
            uses = (table.slots[window.shape][:, columns] >= 0).any(axis=1)
            if group == "retract":
                uses &= _drills(table, window, run.dialect)
            uses &= ~np.logical_or.accumulate(stated)
            if uses.any():
                found[group] = int(np.argmax(uses))
            elif stated.any():
                said.add(group)
        if found:
            line = min(found.values())
            where = Location(run.source.name, window.first_line + line + 1)
            text = window.line(line).decode("latin-1")
            where = replace(where, text=text, width=max(1, len(text)))
            message = f"its {' and '.join(found)} are those of its caller"
            raise located(_open(message, where), run.source)


def _drills(table: MeaningTable, window: Window, dialect: type[Dialect]) -> Flags:
    """Return of each line whether it begins a canned cycle, in whichever group that is."""
    rule = dialect.cycle_rule
    codes = [NUMBER[f"G{number}"] for number in rule.cycles] if rule is not None else []
    columns = [COLUMNS.index(group) for group in ("motion", "cycle")]
    return np.asarray(np.isin(table.groups[window.shape][:, columns], codes).any(axis=1))


def _groups_said(plan: Plan) -> set[str]:
    """Return the modal groups of which [entry] says the code in force."""
    return {plan.source.codes[code].group for code in plan.reading.entry.modes}


def _left_otherwise(run: Run) -> tuple[str, ...]:
    """Return the codes of modes in which the output leaves its caller, and the source does not.

    Raises InputError for what a code alone does not restore.
    """
    assert run.stages is not None
    assert run.stages.verifier is not None
    before, after = run.stages.interpreter.state, run.stages.verifier.interpreter.state
    other = [g for g in GROUPS if before.groups[g] != after.groups[g]]
    lost = [group for group in other if group not in STATED_AGAIN]
    lost += [name for name, value in before.memory.items() if after.memory[name] != value]
    lost += ["feed"] * (not _same_feed(before, after) and "units" not in other)
    if lost:
        message = f"its caller would find another {' and '.join(lost)} behind it"
        raise _open(message, Location(run.source.name))
    return tuple(code_of(group, before.groups[group]) for group in other)


def _same_feed(one: State, other: State) -> bool:
    values = one.feed * one.feed_unit, other.feed * other.feed_unit
    return bool(np.isclose(*values, rtol=1e-9, atol=0.0, equal_nan=True))


def _last_line(run: Run, body: Body) -> int:
    """Return the line, of those that are executed, at which a subprogram of O-words returns.

    Raises InputError if it does not, or would call what is written.
    """
    body.refuse_called(run.files)
    body.refuse_asking(run.files, _groups_said(run.plan))
    count = 0
    for window, reader in windows_of(run.source, run.dialect):
        reader.table.update()
        ends = reader.table.flag("ends", window.shape)
        if ends.any():
            line = run.source.line_of(window.first_line + int(np.argmax(ends)) + 1)
            raise body.refusal("called so, it ends the program and does not return", line - 1)
        count += len(window)
    return count - 1


def _refuse_moving_returns(run: Run) -> None:
    """Raise InputError if the block that returns moves: nothing can be said between the two."""
    for window, reader in windows_of(run.source, run.dialect):
        reader.table.update()
        axes = [ord(axis) - ord("A") for axis in USES["distance"]]
        moves = (reader.table.slots[window.shape][:, axes] >= 0).any(axis=1)
        wrong = moves & reader.table.flag("ends", window.shape)
        if wrong.any():
            where = Location(run.source.name, window.first_line + int(np.argmax(wrong)) + 1)
            raise located(_open("the block that returns moves too", where), run.source)


def _open(message: str, where: Location) -> InputError:
    hint = 'say how it is called: modes = "G90 G21 G94" in [entry], with the codes in force there'
    return InputError.one("GX228", message, where, hint)

"""Blocks that move in a way of their own: G28 and G30 over a point to home, G53 in the machine.

So does G31, which is a probing move for its block alone.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite, isnan, nan

import numpy as np

from gcxform.catalogue.remedies import way_home_said
from gcxform.diagnostics import Diagnostic, Severity
from gcxform.dialect.dialect import EXTRUDER, INCH, LINEAR
from gcxform.modal.frames.followed_tips import turned_tip
from gcxform.modal.frames.track import LEFT, Track
from gcxform.modal.line_notes import WayHome, call_of
from gcxform.modal.meaning.calls import CALL
from gcxform.modal.meaning.meaning import ORIENTING, OWN_MOVES, Act
from gcxform.modal.moves.blind_moves import note_way
from gcxform.modal.moves.rows import Own
from gcxform.modal.moves.spindle_and_probe import probe
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Form, Kind, Plane

TOOL_BACK = "draw the tool back, write G49 before, which may move it, and G43 after"
PLAIN = "write G15 before, the place in plain coordinates, and G16 again behind"
PLACE = "write it under G90, with its place in the machine"
CLEAR = "write G0 in this block if the way is clear, or G1"
ALONE = "write it in a block of its own"
RAPID = "write G0 in this block if the way is clear, and G1 again behind it"


def own_moves(track: Track, line: int) -> Own | None:
    """Return the moves of a line that has such a code, None if it has none."""
    meaning = track.lines.table.meanings[int(track.lines.shape[line])]
    for act in meaning.acts:
        if act.name in OWN_MOVES and track.frame.polar:
            _refuse_polar(track, line, act.code)
        if act.name == CALL:
            return _called(track, line)
        if act.name in ORIENTING:
            return _oriented(track, line, act.code)
        if act.name == "home":
            return _home(track, line, _reference(track, line, act))
        if act.name == "probe":
            return probe(track, line)
        if act.name == "machine":
            return _in_machine(track, line)
    return None


def _refuse_polar(track: Track, line: int, code: str) -> None:
    """Refuse words of the plane's axes, of which controls differ in whether they are polar."""
    plane = {"XYZ"[k] for k in Plane(int(track.modes.plane[line])).axes[:2]}
    if plane & set(track.words_on(line)):
        message = f"{code} in polar words: controls differ in what its words are"
        track.findings.add(line, "GX213", message, hint=PLAIN)


def _reference(track: Track, line: int, act: Act) -> str:
    """Return the name of a reference point: G28, G30, or "G30 P3" where P is given."""
    first, slots = int(track.lines.first[line]), dict(act.slots)
    if "P" not in slots:
        return act.code
    number = float(track.lines.window.value[first + slots["P"]])
    if number not in (2, 3, 4):
        message = f"{act.code} P{number:g} is no reference point"
        track.findings.add(line, "GX213", message, hint="P2, P3 and P4 are")
    return f"{act.code} P{number:g}"


def _rows(track: Track, line: int, form: Form, moves: list[tuple[int, list[float]]]) -> Own:
    if moves:
        track.state.position = np.array(moves[-1][1])
    return Own(line, form, moves, len(track.frames) - 1)


def _home(track: Track, line: int, code: str) -> Own:
    """G28: rapid over the point given, then with the axes named to the reference point."""
    words = track.words_on(line)
    moves: list[tuple[int, list[float]]] = []
    if words:
        note_way(track, line)
        moves.append((Kind.RAPID, _reached(track, line, words)))
        if not track.modes.incremental[line]:
            stands = float(track.state.position[2])
            warn_of_plunge(track, line, code, stands, moves[0][1][2])
    elif not track.dialect.motion_rule.g28_without_axes:
        track.findings.add(
            line,
            "GX213",
            f"{code} names no axis: all axes may move at once, or none",
            hint="name the axes, one after another",
        )
        return _rows(track, line, Form.HOME, moves)
    home = list(moves[-1][1]) if moves else track.state.position.tolist()
    _refuse_one_of_turned(track, line, code, words)
    place = track.state.frames.homes.get(code, {})
    for k, axis in enumerate(track.axes):
        if axis in words or (not words and axis != EXTRUDER):
            home[k] = _in_frame(track, k, place.get(axis, nan))
            track.note_lost(int(isnan(home[k])) << k)
    _note_machine(track, line, code, words, home)
    rows = _rows(track, line, Form.HOME, [*moves, (Kind.RAPID, home)])
    if track.dialect.motion_rule.g28_ends_length:
        _let_go_of_length(track, line, code)
    return rows


def _note_machine(
    track: Track, line: int, code: str, words: dict[str, float], home: list[float]
) -> None:
    """Note the frame of the machine, if the block goes nowhere but home, and home is known.

    One that names no axis moves all that there are: those of the program, and those that the
    machine file has a home of, for which there must be words.
    """
    frames = track.state.frames
    every = {*track.axes, *frames.homes.get(code, {})} - {EXTRUDER}
    still = track.modes.incremental[line] and not any(words.values())
    named = set(words) or every
    if not (still or not words) or not named.issubset(track.axes):
        return
    open_ = {a: k for k, a in enumerate(track.axes) if a in named and not isfinite(home[k])}
    if open_:
        track.ways_open[line] = _what_would_say(track, code, open_)
        return
    shift = tuple(np.nan_to_num(frames.machine).tolist())
    frame = Frame(frames.work, shift, (frames.first,) * len(track.axes), machine=True)
    track.homed[line] = WayHome(code.split()[0], frame, not words, track.frame.called)


def _what_would_say(track: Track, code: str, axes: Mapping[str, int]) -> str:
    """Return the settings that say where axes, with their columns, go by a way home; or nothing."""
    frames, found = track.state.frames, list[str]()
    for axis, k in axes.items():
        offset, *lengths = track.frame.origin[k].split(" + ")
        offsets = dict.fromkeys([frames.first] * isnan(frames.machine[k]))
        offsets |= dict.fromkeys([offset] * (offset != frames.first))
        said = way_home_said(code, axis, [*offsets], lengths)
        if not said:
            return ""
        known = isfinite(frames.homes.get(code, {}).get(axis, nan))
        found += said[known:]
    return ", ".join(dict.fromkeys(found))


def _let_go_of_length(track: Track, line: int, code: str) -> None:
    """Take a tool length for unknown behind a return home, until the program states one again."""
    frames = track.state.frames
    if frames.tool_name:
        unknown = *frames.tool[:2], float("nan")
        track.state.frames = frames.with_tool(unknown, f"{frames.tool_name}, after {code}")
        track.enter(line + 1, track.frame)


def warn_of_plunge(track: Track, line: int, code: str, stands: float, by_way: float) -> None:
    """Note a way home that leads down first: `G90 G28 Z0` goes to Z0 of the part, then home."""
    if not by_way < stands:
        return
    message = f"{code} under G90 goes by way of the point it names: down by {stands - by_way:g} mm"
    where = track.findings.location(line, 1, 1)
    hint = f"G91 {code} Z0 goes home from where the tool stands"
    warning = Diagnostic("GX229", message, where, hint, severity=Severity.WARNING)
    track.state.assumed[message] = warning


def _refuse_one_of_turned(track: Track, line: int, code: str, words: dict[str, float]) -> None:
    """Refuse a return of one of two axes that are turned together.

    LinuxCNC then takes the program's axis home, other controls that of the machine. From a tip it
    is only read where no word leads anywhere.
    """
    if track.frame.matrix is None or not words or turned_tip(track.state.frames):
        return
    mixed = np.abs(np.array(track.frame.matrix)) > 1e-15
    for k in range(3):
        together = {"XYZ"[n] for n in np.flatnonzero(mixed[k])} | {"XYZ"[k]}
        if together & set(words) and not together <= set(words):
            message = f"{code} of {' or '.join(sorted(together))} alone, which are turned together"
            track.findings.add(line, "GX213", message, hint="name both, or none")
            return


def _reached(track: Track, line: int, words: dict[str, float]) -> list[float]:
    """Return the position that the words of a line lead to; axes without one stay, to the bit."""
    place = list(track.frame.words_of(track.state.position.tolist()))
    steps = bool(track.modes.incremental[line])
    for axis, value in words.items():
        k = track.axes.index(axis)
        if steps and value and place[k] == LEFT:
            message = f"{axis} is incremental, but where {axis} stands is not known"
            track.findings.add(line, "GX207", message, axis, f"begin with an absolute {axis}")
        place[k] = place[k] + value if steps else value
    found = track.frame.point(place)
    if not track.frame.shifts_only:
        return found
    stands = track.state.position.tolist()
    moved = {axis for axis, value in words.items() if value or not steps}
    return [found[k] if axis in moved else stands[k] for k, axis in enumerate(track.axes)]


def _in_frame(track: Track, k: int, value: float) -> float:
    """Return a machine position of an axis as the position that the frame in force counts.

    nan where that frame counts from a zero that is not known.
    """
    if track.frame.origin[k] != track.state.frames.first:
        return nan
    return float(track.state.frames.machine[k]) + value


def _called(track: Track, line: int) -> Own | None:
    """Return the way to the point at which a call ends, where the machine file says that it does.

    How it gets there is not known, so that the block stays as it is. None for other calls.
    """
    call = call_of(track.lines.kept_calls, line)
    if call is None or not call.led:
        return None
    place = list(track.frame.words_of(track.state.position.tolist()))
    words = _target(track, line)
    for axis in call.led:
        if axis in words:
            place[track.axes.index(axis)] = words[axis]
            track.note_lost(int(isnan(words[axis])) << track.axes.index(axis))
    end = track.frame.point(place)
    return _rows(track, line, Form.HOME, [(Kind.RAPID, end)] if words else [])


def _target(track: Track, line: int) -> dict[str, float]:
    """Return where the axes named in a call go, mm or degrees; nan where that is not certain."""
    meaning = track.lines.table.meanings[int(track.lines.shape[line])]
    first, window = int(track.lines.first[line]), track.lines.window
    text = window.line(line).decode("latin-1")
    block = track.lines.table.shapes.grammar.parse(text)
    found = {word.address: nan for word in block.words if word.address in track.axes}
    sure = not (track.modes.incremental[line] or track.frame.polar or track.frame.diameter)
    for axis, slot in meaning.call_slots if sure else ():
        value = float(window.value[first + slot])
        told = axis in found and track.frame.is_apart(track.axes.index(axis))
        if told and (window.decimals[first + slot] >= 0 or value == 0.0):
            inch = track.modes.inch[line] and axis in LINEAR
            found[axis] = value * INCH if inch else value
    return found


def is_rapid(track: Track) -> bool:
    """Whether G53 moves in rapid whatever is in force, so that it may not stand under G1."""
    return track.dialect.motion_rule.g53_is_rapid and not track.lines.reading.same_words


def _oriented(track: Track, line: int, code: str) -> Own:
    """G53.1: the rotary axes turn in rapid until the tool stands on the plane."""
    if track.words_on(line):
        track.findings.add(line, "GX213", f"{code} beside words of axes", hint=ALONE)
    if int(track.modes.motion[line]) != Kind.RAPID:
        message = f"{code} under a feed move: the axes may turn at the feed"
        track.findings.add(line, "GX213", message, hint="write G0 before")
    plane, end = track.state.frames.plane, track.state.position.tolist()
    for axis, angle in plane.angles.items() if plane is not None else ():
        end[track.axes.index(axis)] = _in_frame(track, track.axes.index(axis), angle)
    form = Form.PLAIN if track.lines.reading.turns_plainly else Form.MACHINE
    return _rows(track, line, form, [(Kind.RAPID, end)])


def _in_machine(track: Track, line: int) -> Own:
    """G53: to a point in the coordinates of the machine, without any offset."""
    kind, words = int(track.modes.motion[line]), track.words_on(line)
    if kind not in (Kind.RAPID, Kind.LINE):
        track.findings.add(line, "GX213", "G53 needs G0 or G1", hint=CLEAR)
        kind = Kind.RAPID
    if not words:
        return _rows(track, line, Form.MACHINE, [])
    if track.modes.incremental[line] and track.dialect.motion_rule.g53_in_g91 != "absolute":
        message = "G53 under G91: controls refuse it, ignore it, or take it as absolute"
        track.findings.add(line, "GX213", message, hint=PLACE)
    if kind == Kind.LINE and is_rapid(track):
        message = "G53 under G1: this control moves in rapid whatever is in force"
        track.findings.add(line, "GX213", message, hint=RAPID)
    end = track.state.position.tolist()
    for axis, value in words.items():
        k = track.axes.index(axis)
        value = value / 2 if axis == "X" and track.state.frames.diameter else value
        end[k] = _in_frame(track, k, value)
        track.note_lost(int(isnan(end[k])) << k)
    return _rows(track, line, Form.MACHINE, [(kind, end)])

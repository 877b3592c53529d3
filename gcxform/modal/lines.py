"""The lines of a window as columns: words, modal groups and feed, filled forward line by line."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from gcxform.dialect.dialect import EXTRUDER, INCH, LINEAR, Dialect
from gcxform.modal.columns import extruded, fill
from gcxform.modal.findings import Findings
from gcxform.modal.line_notes import Assigned, KeptCall, Unknown
from gcxform.modal.meaning.calls import NUMBERED
from gcxform.modal.meaning.lathe import LATHE
from gcxform.modal.meaning.tables import (
    COLUMNS,
    CYCLES,
    FLAGS,
    GROUPS,
    MEMORY,
    NUMBER,
    NURBS_END,
    THREAD_CYCLE,
    MeaningTable,
    column_of,
    of_splines,
)
from gcxform.modal.numbers_without_point import Pointless, why_open
from gcxform.modal.state import CYCLE_OFF, Modes, Reading, State
from gcxform.syntax.scan import Window
from gcxform.syntax.undecided import DECIDED, Undecided
from gcxform.system.arrays import Flags, Floats, Small
from gcxform.system.distinct import one_of

DISTANCES = frozenset({*"XYZABCUVWIJKR", ",C", ",R"})
LENGTHS = LINEAR + "IJKR"
POINT = "write it with a point, where the control has it"
NOTHING = 0  # the shape of an empty line


class Lines:
    """The lines of a window that the control executes.

    live     how many there are; those after the end of the program are not executed
    shape    (live,) their shapes; blocks that are skipped have that of an empty line
    first    (live,) index of the first number of each
    parameters   what the program has set, before the window and, once computed, after it
    assigned     what the window has set, in order, once computed
    unknown      what of it only the machine can compute
    undecided    what of the program only the machine decides, nothing where that is elsewhere
    feed_lost    (live,) whether a feed is in force that only the machine knows
    """

    def __init__(
        self,
        dialect: type[Dialect],
        reading: Reading,
        state: State,
        window: Window,
        table: MeaningTable,
        file: str,
        undecided: Undecided = DECIDED,
    ) -> None:
        self.dialect = dialect
        self.reading = reading
        self.state = state
        self.window = window
        self.table = table
        self.findings = Findings(file, window, table)
        self.pointless = Pointless(dialect, reading, self.findings, state.assumed)
        self.parameters = dict(state.parameters)
        self.assigned: list[Assigned] = []
        self.unknown: list[Unknown] = []
        self.undecided = undecided.within(window.first_line, len(window))
        self.feed_lost: Flags = np.zeros(0, np.bool_)
        self.live = self._live()
        self.shape = window.shape[: self.live]
        self.first = window.first_number[: self.live]
        used = np.flatnonzero(np.bincount(self.shape))
        self._used = table.slots[used].max(axis=0, initial=-1) >= 0
        self._stated = table.groups[used].max(axis=0, initial=-1) >= 0
        self._flagged = np.asarray(table.flags[used].any(axis=0))
        for number in used.tolist() if dialect.chosen or dialect.block_rule.m_order_chosen else ():
            state.assumed.update(dict.fromkeys(table.meanings[number].choices))

    def flag(self, name: str) -> Flags:
        """Return a flag of the meaning of each line."""
        none = not self._flagged[FLAGS.index(name)]
        return np.zeros(self.live, np.bool_) if none else self.table.flag(name, self.shape)

    def loses_position(self) -> Flags:
        """Return the lines after which no position is known: not those that the machine excepts."""
        lost, inert = self.flag("loses_position"), self.reading.inert_m
        if still := [each.line for each in self.kept_calls if each.ends not in ("", "unknown")]:
            lost = lost & ~np.isin(np.arange(self.live), still)
        if not inert or not lost.any():
            return lost
        known = np.array([meaning.lost_by <= inert for meaning in self.table.meanings], np.bool_)
        return np.asarray(lost & ~known[self.shape])

    @cached_property
    def kept_calls(self) -> tuple[KeptCall, ...]:
        """The calls of programs that are not there, in order."""
        found = []
        for line in np.flatnonzero(self.flag("calls")).tolist():
            meaning = self.table.meanings[int(self.shape[line])]
            name = meaning.call
            if name == NUMBERED:
                slot = dict(meaning.call_slots).get("P", 0)
                name = f"P{float(self.window.value[int(self.first[line]) + slot]):g}"
            code = self.dialect.codes.get(name)
            ends = self.reading.control.get(f"macro {name}", code.act if code else "")
            found.append(KeptCall(line, name, str(ends)))
        return tuple(found)

    @cached_property
    def inch(self) -> Flags:
        """The lines in inches."""
        return np.asarray(self._group("units") == 1)

    def stated(self, group: str) -> Flags:
        """Return which lines have a code of a group."""
        return np.asarray(self.table.groups[self.shape, COLUMNS.index(group)] >= 0)

    def refuse_statically(self) -> None:
        """Raise InputError for what can be seen without numbers."""
        self._deleted_blocks()
        self._lone_line_ends()
        stays = {line - self.window.first_line for line in self.undecided.lines}
        wrong = [n for n in np.flatnonzero(self.flag("wrong")).tolist() if n not in stays]
        lathe = [line for line in wrong if self._refusal_code(line) == LATHE]
        for line in lathe[:1] or wrong:  # one sign of a lathe explains all the others
            self.findings.add_refusal(line)
        self.findings.raise_if_any()

    def _refusal_code(self, line: int) -> str:
        """Return the code with which a line is refused by its shape."""
        return getattr(self.table.meanings[int(self.shape[line])].refusal, "code", "")

    def _live(self) -> int:
        """Return how many lines the control executes before the program ends."""
        if self.state.ended:
            return 0
        shape = self.window.shape
        ends = np.zeros(len(shape), np.bool_)
        if self.dialect.program_rule.stops_at_end:
            ends |= self.table.flag("ends", shape)
            if self.reading.blocks_with_a_slash(self.dialect) != "execute":
                ends &= ~self.table.flag("deleted", shape)
        self.undecided.settle_ends(ends, self.window.first_line)
        percent = np.flatnonzero(self.table.flag("percent", shape))
        ends[percent[max(0, 1 - self.state.percents) :][:1]] = True
        self.state.percents += len(percent)
        self.state.ended = bool(ends.any())
        return int(np.argmax(ends)) + 1 if self.state.ended else len(shape)

    def _deleted_blocks(self) -> None:
        """Execute or silence blocks with a slash, or refuse them."""
        deleted, asides = np.flatnonzero(self.flag("deleted")), np.flatnonzero(self.flag("asides"))
        policy = self.reading.blocks_with_a_slash(self.dialect)
        if len(deleted) + len(asides) and self.reading.block_delete:
            done = {"execute": "executed", "skip": "skipped"}[self.reading.block_delete]
            self.state.assumed[f"blocks with a slash are {done}"] = None
        if policy == "skip":
            self.shape = self.shape.copy()
            self.shape[deleted] = NOTHING
        for line in () if policy else sorted({*deleted.tolist(), *asides.tolist()}):
            meaning = self.table.meanings[int(self.shape[line])]
            still = meaning.switches or not meaning.deleted  # no other block hangs on it
            if still and not self.reading.crosses:
                continue  # it stays, and so does the question
            self.findings.add(
                line,
                "GX211",
                "a switch of the control decides whether this block is executed",
                hint='block-delete = "execute" in [input], or block-delete = "skip" in [input]',
            )

    def _lone_line_ends(self) -> None:
        """Refuse lines that the control would take together."""
        window = self.window
        if not self.dialect.text_rule.lone_cr_is_blank or b"\r" not in window.text:
            return
        text = np.frombuffer(window.text + b"\n", np.uint8)
        stop = window.end[: self.live]
        lone = (text[stop] == 13) & (window.next[: self.live] - stop == 1)
        for line in np.flatnonzero(lone)[: Findings.enough].tolist():
            self.findings.add(
                line,
                "GX102",
                f"the line ends with CR alone, which {self.dialect.name} reads as a blank",
                hint="convert the line ends of the file to LF or CRLF",
            )

    def word(
        self, address: str, among: Flags | None = None, distance: bool | None = None
    ) -> tuple[Floats, Flags] | None:
        """Return value and presence of a word on each line; None if no line has it.

        Only lines `among` count, where given. Whether it is a `distance`, for which a point
        matters, goes by its address unless it is said.
        """
        column = column_of(address)
        if not self._used[column]:
            return None
        slot = self.table.slots[:, column][self.shape]
        present = slot >= 0 if among is None else (slot >= 0) & among
        number = np.where(present, self.first + slot, 0)
        value, rows = np.zeros(self.live), np.flatnonzero(present)  # faster than the flags
        value[rows] = self.window.value[number[rows]]
        if distance is None:
            distance = address in DISTANCES
        if self.dialect.point_rule.required and distance:
            decimals = self.window.decimals[number]
            known = present & ~np.isnan(value)  # a value of the machine's is rounded by itself
            value = self.pointless.distances(address, value, known, decimals, self.inch)
        return value, present

    def refuse_pointless(self, line: int, address: str, number: int) -> None:
        """Refuse a distance without a point in a word that a code takes for itself."""
        if not self.dialect.point_rule.required or address not in DISTANCES:
            return
        value, decimals = float(self.window.value[number]), int(self.window.decimals[number])
        if why := why_open(address, value, decimals, bool(self.inch[line])):
            message = f"{address} {why} depends on the control"
            self.findings.add(line, "GX205", message, address, POINT)

    def _group(self, name: str) -> Small:
        """Return the number of the code in force of a group, on each line."""
        index, resets = COLUMNS.index(name), self.dialect.program_rule.resets_at_end
        before = self.state.memory[name] if name in MEMORY else self.state.groups[name]
        if not self._stated[index] and name not in resets:
            return np.broadcast_to(np.int8(before), (self.live,))
        values = self.table.groups[self.shape, index]
        present = values >= 0
        if present.any():
            self.state.stated.add(name)
        if name in resets:
            after = np.flatnonzero(self.flag("ends")[:-1]) + 1
            after = after[~present[after]]
            values[after] = NUMBER[resets[name]]
            present[after] = True
        return fill(values, present, before)

    def modes(self) -> Modes:
        """Return what holds on each line after its words."""
        groups = {name: self._group(name) for name in GROUPS}
        groups["motion"] = self._without_splines(groups["motion"])
        inch = groups["units"] == 1
        feed, feed_unit = self._feed(groups["feed-mode"], inch)
        return Modes(
            groups["motion"],
            groups["plane"],
            groups["distance"] == 1,
            self._extruded(groups["distance"]),
            groups["arc-distance"] == 1,
            groups["feed-mode"],
            inch,
            groups["frame"],
            groups["cutter-comp"],
            feed,
            feed_unit,
            self._tool(),
            self._cycle(groups["motion"]),
            self.remembered("retract"),
            self.remembered("spindle"),
        )

    def _extruded(self, distance: Small) -> Small:
        """Return whether words of an extruder are distances on each line, as `Modes` has it."""
        if EXTRUDER not in self.dialect.axes:
            return distance
        own, said = self.remembered("extrusion"), self.stated("extrusion")
        stated, rule = self.stated("distance"), self.dialect.motion_rule.extruder
        return extruded(rule, own, said, distance, stated, self.state.memory)

    def _without_splines(self, motion: Small) -> Small:
        """Return the motion code in force on each line: a spline's is that of its own block alone.

        After it no code is in force, as after G80.
        """
        if not self._stated[COLUMNS.index("motion")]:
            return motion
        over = (of_splines(motion) | (motion == NURBS_END)) & ~self.stated("motion")
        return np.where(over, np.int8(NUMBER["G80"]), motion) if over.any() else motion

    def remembered(self, name: str) -> Small:
        """Return the number in force of a group that matters to cycles or tool vectors alone."""
        values = self._group(name)
        if name == "spindle" and self.flag("ends").any():
            values = np.where(self.flag("ends"), 0, values).astype(np.int8)
        if self.live:
            self.state.memory[name] = int(values[-1])
        return values

    def lost_before(self, letters: str) -> dict[int, str]:
        """Return the lines of the window before which some of these letters are lost, and which."""
        found = {n: {*axes} & {*letters} for n, axes in self.undecided.lost.items()}
        first, last = self.window.first_line, self.window.first_line + self.live
        return {n - first: "".join(sorted(a)) for n, a in found.items() if a and n < last}

    @property
    def apart(self) -> Flags:
        """The lines that are joined with no other: with a mark, and where a jump may be."""
        found = self.flag("marked")
        return found | self.undecided.at_jumps(*self._span) if self.undecided else found

    @property
    def perhaps(self) -> Flags | None:
        """The lines that move something and may not be executed; None if there are none."""
        return self.undecided.skipped(*self._span) if self.undecided.perhaps else None

    @property
    def _span(self) -> tuple[int, int]:
        return self.window.first_line, self.live

    def _cycle(self, motion: Small) -> Small:
        """Return the canned cycle in force on each line, `CYCLE_OFF` for none.

        On some controls cycles are of the group of G0 to G3; on others a code of that group ends
        the cycle, and is in force again after G80.
        """
        if self.dialect.cycle_rule is None:
            return np.broadcast_to(np.int8(CYCLE_OFF), (self.live,))
        drill = self.dialect.codes.get("G81")
        if drill is not None and drill.group == "motion":
            cycle = one_of(motion, CYCLES) & (motion != THREAD_CYCLE)
            return np.where(cycle, motion, CYCLE_OFF).astype(np.int8)
        if not (self._stated[COLUMNS.index("cycle")] or self.state.memory["cycle"] != CYCLE_OFF):
            return np.broadcast_to(np.int8(CYCLE_OFF), (self.live,))
        values = self.table.groups[self.shape, COLUMNS.index("cycle")]
        values = np.where((values < 0) & self.stated("motion"), np.int8(CYCLE_OFF), values)
        cycle = fill(values, values >= 0, self.state.memory["cycle"])
        if self.live:
            self.state.memory["cycle"] = int(cycle[-1])
        return np.asarray(cycle)

    def behind_cycle(self, cycle: Small) -> Flags:
        """Return the lines whose motion code was given before a cycle that is over.

        Only of controls on which cycles are of another group than it.
        """
        begins: Flags = self.stated("cycle") & (cycle != CYCLE_OFF)
        if not (begins.any() or self.state.memory["behind"]):
            return np.zeros(self.live, np.bool_)
        behind = fill(begins, begins | self.stated("motion"), self.state.memory["behind"])
        self.state.memory["behind"] = int(behind[-1]) if self.live else 0
        return np.asarray(behind & (cycle == CYCLE_OFF))

    def _tool(self) -> Floats:
        """Return the tool number last programmed on or before each line, -1 for none."""
        word = self.word("T")
        if word is None:
            return np.broadcast_to(self.state.tool_word, (self.live,))
        tool = fill(word[0], word[1], self.state.tool_word)
        if self.live:
            self.state.tool_word = float(tool[-1])
        return tool

    def _feed(self, feed_mode: Small, inch: Flags) -> tuple[Floats, Floats]:
        """Return the feed number in force after each line's words, and its unit in mm."""
        word = self.word("F")
        value = np.full(self.live, np.nan)
        present = np.zeros(self.live, np.bool_)
        if word is not None:
            value, present = np.where(word[1], word[0], np.nan), word[1]
            if self.dialect.point_rule.required:
                slot = self.table.slots[self.shape, ord("F") - 65]
                decimals = self.window.decimals[np.where(present, self.first + slot, 0)]
                known = present & ~np.isnan(value)
                value = self.pointless.feeds(value, known, decimals, feed_mode, inch)
        named = present & np.isnan(value)
        for line in self.lost_before("F"):
            named[line] = named[line] or not present[line]
            present[line] = True
        for call in self.kept_calls:  # F in its block is the call's, and what it left behind
            named[call.line] = present[call.line] = call.ends not in ("", "unchanged")
        present = present | self._cleared(feed_mode, inch)
        self.feed_lost = fill(named, present, self.state.feed_lost)
        if self.live:
            self.state.feed_lost = bool(self.feed_lost[-1])
        if self.dialect.feed_rule.before_units:
            inch = np.append(self.state.groups["units"] == 1, inch[:-1])[: self.live]
        unit = np.where(inch, INCH, 1.0)
        feed = fill(value, present, self.state.feed)
        return feed, fill(unit, present, self.state.feed_unit)

    def _cleared(self, feed_mode: Small, inch: Flags) -> Flags:
        """Return the lines that leave no feed in force unless they program one."""
        cleared = np.zeros(self.live, np.bool_)
        cleared[[call.line for call in self.kept_calls if not call.ends]] = True
        if self.dialect.feed_rule.mode_clears:
            cleared |= self.stated("feed-mode")
        mode = np.append(np.int8(self.state.groups["feed-mode"]), feed_mode)
        cleared |= mode[1:] != mode[:-1]
        if self.dialect.feed_rule.change_clears:
            unit = np.append(self.state.groups["units"] == 1, inch)
            cleared |= unit[1:] != unit[:-1]
        return cleared

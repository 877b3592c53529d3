"""Blocks that stay as they stand and hang on what is in force: refused where that would be another.

They set coordinates from where the axes stand, read what only the machine knows, take lengths in
the unit of the program, or call what is not there to be read.
"""

from __future__ import annotations

import numpy as np

from gcxform.catalogue.remedies import put_before
from gcxform.diagnostics import InputError
from gcxform.dialect.dialect import run_alike
from gcxform.emit.bored_places import bores_beside
from gcxform.emit.manner import Believed, Task
from gcxform.emit.positions import Positions
from gcxform.emit.same_rows import EXACT, SameRows
from gcxform.modal.line_notes import BY_WAY, Unknown
from gcxform.modal.meaning.meaning import FRAMING
from gcxform.modal.state import CYCLE_OFF
from gcxform.system.arrays import Flags, Small

STORES = "store-home"
PLACED = ("place", "motion")
UNCORRECTED = "a place that no pass has corrected"
LED = "before it, lead there by a move that names X, Y and Z; where rapids are left alone by a cut"


class Depending:
    """Looks at the blocks of a window whose effect depends on modes or places.

    `exact` (rows,): after the row the control stands exactly where the source program put it.
    `motion` (live,): the number of the code of motion that is in force before the line.
    """

    def __init__(
        self,
        task: Task,
        positions: Positions,
        believed: Believed,
        same: SameRows,
        exact: Flags,
        motion: Small,
    ) -> None:
        self.task = task
        self.path, self.original = task.path, task.read.path
        self.positions = positions
        self.believed = believed
        self.same = same
        self.exact = exact
        self.motion = motion

    def check(self) -> None:
        """Raise InputError for the first block that would do something else."""
        self._refuse_presets()
        self._refuse_other_values()
        self._refuse_calls()
        self._refuse_lengths()

    def _refuse_presets(self) -> None:
        """Refuse blocks that set coordinates from where the axes stand if they stand elsewhere."""
        if self.path.folded:
            return
        for line in self.task.counted_from_axes():
            elsewhere = self._stands_elsewhere(line, named=self._preset(line))
            if elsewhere and not self._follows(line):
                message = "this block counts from where the axes stand, and they stand elsewhere"
                hint = put_before("offsets")
                raise InputError.one("GX506", message, self.task.location(line), hint)

    def _follows(self, line: int) -> bool:
        """Whether what a block sets can be said by other words (`gcxform/emit/presets.py`).

        What outlives the program is no such thing: ways home would lead to where the machine was
        told to be, and tools would be longer by its error, now and in other programs.
        """
        acts = {act.name: act.code for act in self.task.table.meanings[self.task.shape[line]].acts}
        stores = acts.get(STORES) or self._table_written(line)
        if not stores or not self.task.manner.compensates:
            return self.task.manner.compensates and not self.task.manner.crossing
        message = f"{stores} would store where the machine is told to stand to make up for"
        message += " its error, for this program and others"
        hint = "store it before the first move, or leave out the pass that compensates"
        raise InputError.one("GX506", message, self.task.location(line), hint)

    def _table_written(self, line: int) -> str:
        """Return the G10 of a line that takes a tool's length from where an axis stands, if any."""
        kinds = self.task.manner.source.offset_rule.g10_tools
        first = int(self.task.window.first_number[line])
        for act in self.task.table.meanings[int(self.task.shape[line])].acts:
            slot = dict(act.slots).get("L") if act.name == "set-work" else None
            kind = 0.0 if slot is None else float(self.task.read.value[first + slot])
            if kind in kinds:
                return f"{act.code} L{kind:g}"
        return ""

    def _preset(self, line: int) -> list[bool] | None:
        """Return which axes a block sets to where they stand, if that is all it does (G92)."""
        acts = self.task.table.meanings[int(self.task.shape[line])].acts
        if any(act.name != "preset" for act in acts):
            return None
        named = {address for act in acts for address, _ in act.slots}
        return [axis in named for axis in self.path.axes]

    def _stands_elsewhere(
        self, line: int, by: float = EXACT, named: list[bool] | None = None
    ) -> bool:
        """Whether the axes stand elsewhere before a line than in the source, by a distance (mm).

        Only those that are `named` count, where that is given.
        """
        now = np.searchsorted(self.path.block, line) - 1
        was = np.searchsorted(self.original.block, line) - 1
        if self.exact[now] if now >= 0 else self.believed.exact:
            return False
        stands = self.positions.after[now] if now >= 0 else self.believed.position
        gap = np.abs(stands - (self.original.end[was] if was >= 0 else self.original.entry))
        return bool((gap > by)[np.array(named) if named else ...].any())

    def _refuse_other_values(self) -> None:
        """Refuse what only the machine can compute if it would compute something else.

        That is so where it reads positions and they are others, or are said in coordinates that are
        folded away, or is a length in another unit.
        """
        for each in self.task.read.unknown:
            if self._has_other_value(each):
                message = f"{each.text} is computed by the machine, and would have another value"
                hint = "leave out the pass that changes the unit, the modes or the positions here"
                raise InputError.one("GX506", message, self.task.location(each.line), hint)

    def _has_other_value(self, each: Unknown) -> bool:
        now, old, line = self.path.blocks, self.original.blocks, each.line
        if each.hangs_on == BY_WAY:
            return False  # its block stays, or is refused as a move
        if self.task.manner.crossing:
            return bool(self.task.manner.saying.instead(each.text))
        if each.hangs_on and now.inch[line] != old.inch[line]:
            return True
        if each.hangs_on and now.feed_mode[line] != old.feed_mode[line]:
            return True
        said = self._probes() if each.hangs_on == "units" else each.hangs_on in PLACED
        if said and self._shifts_go():
            return True
        if each.hangs_on not in PLACED:
            return False
        if each.hangs_on == "motion" and self._other_motion(line):
            return True
        return not bool(self.same.modes()[line]) or self._stands_elsewhere(line)

    def _other_motion(self, line: int) -> bool:
        """Whether another code of motion is in force before a line than in the source, or no cycle.

        A cycle is in force behind its line, and goes with the code that ends it in another one.
        """
        read = self.task.read
        was = read.modes.motion[line - 1] if line else read.before.groups["motion"]
        drills = read.modes.cycle[max(line - 1, 0)] != CYCLE_OFF
        return bool(self.motion[line] != was) or (self.task.manner.expands and bool(drills))

    def _refuse_calls(self) -> None:
        """Refuse calls of what is not there, if they would find another control than in the source.

        Where a pass has compensated the machine the tool stands where it ought to; how far that
        may be is an option of the pass. By any other the axes stay within what is promised.
        """
        flag, shape = self.task.table.flag, self.task.shape
        macros = flag("runs_macro", shape) & self.task.read.loses
        macros &= not self.task.manner.crossing
        for line in np.flatnonzero(flag("calls", shape) | macros).tolist():
            if why := self._finds_other(line):
                message = f"this call, whose program is not known, would find {why}"
                if self._cuts(line):
                    message = f"what the control cuts by this code would find {why}"
                hint = LED if why == UNCORRECTED else "leave out the pass that changes this"
                if macros[line]:
                    message = f"{self._macro_codes(line)}, which may run a macro, would find {why}"
                    hint = self._inert(line)
                raise InputError.one("GX506", message, self.task.location(line), hint)

    def _finds_other(self, line: int) -> str:
        """Return what a program that a line calls would find otherwise than in the source."""
        now, old, manner = self.path.blocks, self.original.blocks, self.task.manner
        if manner.compensates and self._cuts(line):
            return "errors of the machine that its own moves do not make up for"
        if manner.compensates and bores_beside(self.task, self.believed, line):
            return UNCORRECTED
        stays = EXACT + manner.promised + manner.rounding(bool(now.inch[line]))
        if not manner.compensates and self._stands_elsewhere(line, stays):
            return "other places of the axes"
        if self._shifts_go():
            return "coordinates that are not shifted"
        if manner.expands and self._drills(line):
            return "no canned cycle to drill"
        if not self.same.modes()[line] or now.feed_mode[line] != old.feed_mode[line]:
            return "other modes (G20 or G21, G90 or G91, G93 or G94)"
        return "" if run_alike(manner.source, manner.target) else "another dialect"

    def _drills(self, line: int) -> bool:
        """Whether a code drills the canned cycle in force at places of its own."""
        rule = self.task.manner.source.cycle_rule
        called = self.task.table.meanings[int(self.task.shape[line])].call
        return rule is not None and called in rule.patterns

    def _probes(self) -> bool:
        """Whether the program has probed, or may have: what it measures is said in coordinates."""
        shapes = np.arange(len(self.task.table.meanings))
        return any(self.task.table.flag(name, shapes).any() for name in ("probes", "calls"))

    def _shifts_go(self) -> bool:
        """Whether coordinates are folded away in which places would be read and words be taken."""
        frames = self.original.frames
        return self.path.folded and any(any(each.shift) or each.matrix for each in frames)

    def _cuts(self, line: int) -> bool:
        """Whether a line has a code that cuts in a way of its own."""
        called = self.task.table.meanings[int(self.task.shape[line])].call
        code = self.task.manner.source.codes.get(called)
        return code is not None and bool(code.reason)

    def _macro_codes(self, line: int) -> str:
        """Return the M codes of a line that may run macros."""
        lost_by = self.task.table.meanings[int(self.task.shape[line])].lost_by
        return " ".join(f"M{number}" for number in sorted(lost_by - {-1}))

    def _inert(self, line: int) -> str:
        numbers = self._macro_codes(line).replace("M", "").replace(" ", ", ")
        said = f"inert-m = [{numbers}] in [control] of the machine file"
        return f"if it runs none: {said}, beside those that it has"

    def refuse_shared(self, copied: Flags) -> None:
        """Refuse to change words beside a code that may take them as arguments of a macro.

        An M code that a parameter makes a call of a macro (6080 to 6089 of a Fanuc) hands it the
        words of its block, as G65 does. `copied` (live,) are the lines that stay as they are.
        """
        shares = self.task.table.flag("shares_words", self.task.shape) & self.task.read.loses
        for line in np.flatnonzero(shares & ~copied)[:1].tolist():
            codes = self._macro_codes(line)
            message = f"{codes or 'a tool change'} may be a call of a macro that takes these words"
            hint = "write it in a block of its own"
            hint = f"{hint}, or {self._inert(line)}" if codes else hint
            raise InputError.one("GX506", message, self.task.location(line), hint)

    def _refuse_lengths(self) -> None:
        """Refuse lengths that codes take for themselves where another unit would be in force."""
        takes = self.task.table.flag("takes_lengths", self.task.shape)
        inch = self.path.blocks.inch != self.original.blocks.inch
        halved = self.path.folded and any(frame.diameter for frame in self.original.frames)
        for line in np.flatnonzero(takes & (inch | halved)).tolist():
            for name, address in self._lengths_kept(line):
                if inch[line] or address == "X":
                    message = f"{address} of {name} would have to be written in another unit"
                    hint = "leave out the pass that changes the unit"
                    if (name, address) not in self._lengths_left(line):
                        hint = put_before("offsets")
                    elif address == "D":
                        hint = put_before("cutter-comp")
                    raise InputError.one("GX506", message, self.task.location(line), hint)

    def _lengths_left(self, line: int) -> list[tuple[str, str]]:
        """Return what of those lengths folding would leave."""
        meaning = self.task.table.meanings[int(self.task.shape[line])]
        framing = {act.code for act in meaning.acts if self._framing(act.name)}
        return [(name, address) for name, address, _ in meaning.lengths if name not in framing]

    def _framing(self, act: str) -> bool:
        """Whether folding takes an act into the words of moves."""
        return act in FRAMING or self.task.manner.saying.folds_value(act)

    def _lengths_kept(self, line: int) -> list[tuple[str, str]]:
        """Return code and address of lengths, not 0, that codes of a line take and that stay."""
        window, first = self.task.window, int(self.task.window.first_number[line])
        meaning = self.task.table.meanings[int(self.task.shape[line])]
        folds = self.path.folded
        folded = {act.code for act in meaning.acts if folds and self._framing(act.name)}
        if self.path.blocks.uncompensated:
            folded.add(meaning.groups.get("cutter-comp", ""))
        return [
            (name, address)
            for name, address, slot in meaning.lengths
            if name not in folded and window.value[first + slot]
        ]

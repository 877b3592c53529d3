"""Where a control that is switched by M codes follows the tip of the tool.

A program that switches with codes of the control is one of tips while they are on, and of axes
while they are off. With all rotary axes at 0 tip and axes are at one position. With an axis turned
the same numbers are another place after a switch: X, Y and Z are then known again where a rapid has
named them.

Rows that are off are positions of axes already, and stay. No code in the output says which these
are, so the verifier tells by the lines of the source that they came from; and of what the source
does not know it only takes that it rests (`gcxform/proof/known_positions.py`).
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

import gcxform as gx
from gcxform.vocabulary import Flags, Floats
from gcxform_plugins.passes.rtcp.place import off_zero

SAY = 'switch it before; or say what holds: tip-at-start = "off" in [control] of the machine file'
TURN_BACK = (
    "before it, draw the tool back along its axis and turn them to 0; or say where they stand: "
    "start = { A = 0.0, ... } in [input]"
)
UNKNOWN, OFF, ON = 0, 1, 2


class Switches:
    """What a window says of the codes; `codes` are those of the machine file, of which none may be.

    `angles` (n + 1, m) are those of the rotary axes before each row and behind the last one, nan
    where they are not known; `state` (n,) holds in each row, and `before` in the one before it.
    """

    def __init__(self, path: gx.Toolpath, context: gx.PassContext) -> None:
        assert context.machine is not None
        self.path = path
        self.codes = {*context.switches}
        self.spelled = context.source.tip_rule.spelled
        last = path.end[-1:] if len(path) else path.entry[None, :]
        self.angles = self._angles(np.vstack([path.start, last]), gx.chain_of(context.machine))
        of_frame = np.array([self._state(frame) for frame in path.frames])
        self.state = of_frame[path.frame]
        self.before = np.append(of_frame[:1], self.state[:-1])[: len(path)]

    def _angles(self, positions: Floats, chain: gx.Chain) -> Floats:
        unknown = np.full(len(positions), np.nan)
        axes = self.path.axes
        columns = [positions[:, axes.index(a)] if a in axes else unknown for a in chain.letters]
        return np.stack(columns, axis=1)

    @staticmethod
    def _state(frame: gx.Frame) -> int:
        if frame.following is None:
            return UNKNOWN
        return ON if frame.following else OFF

    def refuse(self, tips_only: bool) -> None:
        """Refuse what is not certain wherever axes are turned. Raises InputError.

        `tips_only`: the program may be off, and switch, only where all axes are at 0.
        """
        if not self.codes:
            return
        self.refuse_company()
        for line, message, hint in self._wrong(tips_only):
            raise gx.InputError.one("GX330", message, gx.Location("", line + 1), hint)

    def refuse_company(self) -> None:
        """Refuse codes beside a move, or one another: which acts first is not known.

        Raises InputError.
        """
        lines = np.array([event.line for event in self.path.events if event.what in self.codes])
        twice = lines[1:][lines[1:] == lines[:-1]]
        company = np.append(twice, lines[np.isin(lines, self.path.source)])
        if len(company):
            message = "what follows the tip is switched beside a move, or twice in a block"
            where = gx.Location("", int(company.min()) + 1)
            raise gx.InputError.one("GX330", message, where, "give each code its own block")

    def _wrong(self, tips_only: bool) -> Iterator[tuple[int, str, str]]:
        """Yield lines of what is refused, with messages and hints."""
        off = off_zero(self.angles)
        turned, rest = off & np.isfinite(self.angles), np.asarray(~off.any(axis=1))
        if tips_only:
            yield from self._switched_turned(rest)
        turns = np.asarray(turned.any(axis=1))
        step = np.nan_to_num(np.diff(self.angles, axis=0))
        moves = turns[1:] | turns[:-1]
        moves |= (step != 0.0).any(axis=1) & (self.path.kind != gx.Kind.RAPID)
        if tips_only:
            message = "axes are turned while the control does not follow the tip"
            yield from self._rows((self.state == OFF) & moves, message)
        message = "axes are turned, and whether the control follows the tip is not known"
        yield from self._rows((self.state == UNKNOWN) & moves, message, SAY)

    def _switched_turned(self, rest: Flags) -> Iterator[tuple[int, str, str]]:
        """Yield switches where not all axes (n + 1,) rest at 0."""
        for event in self.path.events:
            if event.what in self.codes and not rest[event.row]:
                called = self.spelled.get(event.what, event.what)
                message = f"{called} where not all rotary axes are known to be at 0"
                yield event.line, message, TURN_BACK
        changed = (self.state != self.before) & ~rest[:-1]
        yield from self._rows(changed, "the control was switched where axes may be turned")

    def _rows(
        self, wrong: Flags, message: str, hint: str = TURN_BACK
    ) -> Iterator[tuple[int, str, str]]:
        for row in np.flatnonzero(wrong)[:1].tolist():
            yield int(self.path.source[row]), message, hint

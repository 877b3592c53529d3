"""How one control says what a code of another does: by the same name, by another, or not at all.

A code is one spelling of an *act*. Controls that agree on an act may spell it differently; where a
control has no code for one, a stronger act may stand for it, or the code is left out because the
control does so by itself, or because nothing on it could be different. All else is refused by who
writes, unless the user has said what takes its place (`m_codes`) or that it may go (`drop`).

What is left out of events is what the proof does not look for, so a rule here is a claim:

| act of the source | what stands for it where the target has no such code |
|---|---|
| exact-path (G61 of LinuxCNC, of GRBL) | exact-stop: the path is the same, and slower |
| blend (G64) | nothing: corners stay nearer to the program |
| blend, without the tolerance that it has there | nothing: without one it would have no bound |
| look-ahead, rpm, cancel | nothing: no position, no feed hangs on it there |
| arc-corners, linear-corners | nothing: G41 joins moves there as that control does |
| no-rotate, no-scale, no-mirror, no-polar | nothing, where nothing there begins what they end |
| G28, to a point of another kind there, or letting go of the tool length | G53 to the point |
| G53 at a feed, where G53 is always rapid there | the place, by words of the work offset |
| a tool length by its value (G43.1) | nothing, where `offsets` takes it into the words |
| a tip that is followed (G43.4) | the length (G43), where `offsets` takes the rest into words |
| a tool length by its number (G43 H) | the length itself (G43.1 Z), where that is known |
| M29, where taps are said in step with the spindle | nothing: G33.1 is nothing else |
| a comment that shows or logs something | a comment |
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field

from gcxform import diagnostics
from gcxform.dialect.codes import Code, Effect
from gcxform.dialect.cycle_rule import TAPPING, Level
from gcxform.dialect.dialect import Dialect
from gcxform.values import dataclass

EXACT_STOP, EXACT_PATH, BLEND = "exact-stop", "exact-path", "blend"
LOOK_AHEAD, RPM, CANCEL = "look-ahead", "rpm", "cancel"
AROUND = frozenset({"arc-corners", "linear-corners"})
"""What joins two moves outside under compensation, up to the dash."""
SPOKEN = frozenset({EXACT_STOP, EXACT_PATH, BLEND, LOOK_AHEAD, RPM, CANCEL}) | AROUND
"""Acts of codes that change no position."""
HOME, MACHINE, FOLLOW = "home", "machine", "follow-tip"
NUMBERED, VECTOR = frozenset({"length", "length-negative"}), "length-vector"
NO_LENGTH = "no-length"
STORE_HOME = "store-home"
IN_STEP = "G33.1"
RIGID = "tapping"
"""The group of M codes that make the next tap one in step with the spindle."""
ABORT = "ABORT"
"""A comment that ends the program: it stays."""
STRONGER: Mapping[str, str] = {EXACT_PATH: EXACT_STOP}
NEEDLESS = frozenset({BLEND, LOOK_AHEAD, RPM, CANCEL}) | AROUND
ENDS = "no-"
SWITCHED = "/"
LASTING, EXECUTED = "#", "()"
"""What is no code and may be left out: assignments that last, and comments that are executed."""


def stores_home(dialect: type[Dialect]) -> bool:
    """Whether a program can choose the point to which G28 goes."""
    return any(code.act == STORE_HOME for code in dialect.codes.values())


@dataclass(frozen=True)
class Saying:
    """From one control to another; `m_codes` and `drop` are what the user says of codes.

    `tips` are codes that follow a tip, where another control gets words of the axes instead, each
    with the one that is left of it: it only takes the length of the tool. `taps`: what the user
    says of G74 and G84: "alike", both tie the spindle to the feed in the same way; "in-step", they
    tap in step with it.
    """

    source: type[Dialect]
    target: type[Dialect]
    m_codes: Mapping[str, str] = field(default_factory=dict)
    drop: frozenset[str] = frozenset()
    tips: Mapping[str, str] = field(default_factory=dict)
    taps: str = ""
    _known: dict[str, str] = field(default_factory=dict, compare=False, repr=False)

    @property
    def crosses(self) -> bool:
        """Whether the program changes its control."""
        return self.source is not self.target

    @property
    def taps_in_step(self) -> bool:
        """Whether taps are in step with the spindle, and the target says so by G33.1."""
        return self.taps == "in-step" and self.can_tap_in_step

    @property
    def can_tap_in_step(self) -> bool:
        """Whether the target has G33.1 for taps in step that the source says by a cycle."""
        rule = self.source.cycle_rule
        by_cycle = rule is not None and not rule.taps_float
        return self.crosses and by_cycle and self.target.codes.get(IN_STEP) == Code("motion")

    @property
    def taps_as_cycles(self) -> bool:
        """Whether G33.1 of the source is a cycle of the target, which the user says is in step."""
        return self.taps == "in-step" and self.can_tap_by_cycle

    @property
    def makes_taps_rigid(self) -> bool:
        """Whether such a cycle has M29 before it."""
        return self.taps_as_cycles and any(c.group == RIGID for c in self.target.m_codes.values())

    @property
    def can_tap_by_cycle(self) -> bool:
        """Whether the target has G84 and G74 for G33.1, back to where they begin, and not that."""
        rule = self.target.cycle_rule
        only_there = IN_STEP in self.source.codes and IN_STEP not in self.target.codes
        if rule is None or rule.taps_float or not only_there:
            return False
        steps = (rule.cycles[n].steps[1:2] if n in rule.cycles else () for n in TAPPING)
        return all(each and each[0].level == Level.CLEARANCE for each in steps)

    def dropping(self, name: str) -> str:
        """Return the setting that leaves this out as well, to be pasted over the one that is."""
        said = ", ".join(f'"{each}"' for each in (*sorted(self.drop - {name}), name))
        return f"drop = [{said}] in [output]"

    def m_coding(self, name: str, text: str) -> str:
        """Return the setting that replaces this code as well, to be pasted over the one that is."""
        codes = {**self.m_codes, name: text}
        said = ", ".join(f'{each} = "{codes[each]}"' for each in codes)
        return f"m-codes = {{ {said} }} in [output]"

    def check(self) -> None:
        """Refuse what the user says of codes that cannot go. Raises UsageError."""
        for name in (*self.drop, *self.m_codes):
            if not self._may_go(name):
                message = f"{name} of {self.source.name} cannot be left out or replaced"
                hint = "what waits, moves, sets frames or modes of moves, or ends a program, stays"
                raise diagnostics.UsageError.one("GX707", message, hint=hint)
        known = self.target.m_codes
        for name in self.m_codes.values():
            if int(name[1:]) not in known and self.target.block_rule.unknown_m is None:
                raise diagnostics.UsageError.one("GX707", f"{self.target.name} has no code {name}")
            code = known.get(int(name[1:]))
            if code is not None and (code.ends or code.barrier):
                message = f"{name} of {self.target.name} ends or calls a program"
                raise diagnostics.UsageError.one("GX707", message)

    def _may_go(self, name: str) -> bool:
        if name in (LASTING, EXECUTED):
            return True
        if name in self.source.codes:
            return self.source.codes[name].effect is Effect.INERT
        if name[0] != "M" or "." in name:
            return False
        code = self.source.m_codes.get(int(name[1:]), self.source.block_rule.unknown_m)
        return code is not None and not (code.ends or code.barrier or code.act == "tip-on")

    def instead(self, what: str) -> str:
        """Return the name that a code or an event has in the target, "" where it is left out.

        One for which there is no other name keeps its own: whether it is one there is not asked.
        """
        if what not in self._known:
            bare = what.removeprefix(SWITCHED)
            said = self._instead(bare)
            self._known[what] = said and what.replace(bare, said)
        return self._known[what]

    def words_of(self, what: str, taken: str) -> str:
        """Return which of the words that a code takes stand beside the one that stands for it."""
        what = what.removeprefix(SWITCHED)
        said = self.instead(what)
        if not said or (said == what and not self.agrees(what)):
            return taken if said else ""
        code = self.target.codes.get(said)
        return "".join(a for a in taken if code is not None and a in code.takes)

    @property
    def machine(self) -> str:
        """The code of the target for a move in coordinates of the machine."""
        return self._named(MACHINE)

    def agrees(self, what: str) -> bool:
        """Whether the act of a code says that the code in its place does the same, or more."""
        code, other = self.source.codes.get(what), self.target.codes.get(self.instead(what))
        if code is None or other is None or not self.crosses:
            return False
        inert = code.effect is other.effect is Effect.INERT and code.act in SPOKEN
        return inert and other.act in (code.act, STRONGER.get(code.act))

    def _instead(self, what: str) -> str:
        if what in self.drop:
            return ""
        if what in self.m_codes:
            return self.m_codes[what]
        if not self.crosses:
            return what
        if self.taps_in_step and self._makes_rigid(what):
            return ""
        what = self.tips.get(what, what)
        if what.startswith(("(", ";")):
            tells = self.source.text_rule.tells(what)
            tells |= EXECUTED in self.drop and ABORT not in what.upper()
            return "" if tells and not self.target.text_rule.executes(what) else what
        code = self.source.codes.get(what)
        if self.lengthens(what):
            return self._named(VECTOR)
        if code is not None and code.act == HOME:
            return what if self._same_home(what) else self._named(MACHINE) or what
        if code is None or not code.act or code.effect not in (Effect.INERT, Effect.FRAME):
            return what
        return self._spelled(what, code.act)

    def _makes_rigid(self, what: str) -> bool:
        """Whether a code says that the next tap is in step with the spindle, and nothing else."""
        number = what[1:] if what[0] == "M" and what[1:].isdigit() else "-1"
        code = self.source.m_codes.get(int(number))
        return code is not None and code.group == RIGID

    @property
    def length_said(self) -> str:
        """The code of the target for a tool length by its value; "" where it takes numbers."""
        if not self.crosses:
            return ""
        return self._named(VECTOR) if any(map(self.lengthens, self.source.codes)) else ""

    def lengthens(self, what: str) -> bool:
        """Whether a code that calls a tool length by a number is the length itself there."""
        bare = what.removeprefix(SWITCHED)
        code = self.source.codes.get(self.tips.get(bare, bare))
        if code is None or code.act not in NUMBERED or not self.crosses:
            return False
        return not any(other.act == code.act for other in self.target.codes.values()) and bool(
            self._named(VECTOR)
        )

    def folds_value(self, act: str) -> bool:
        """Whether an act gives a tool length by its value, and the target has none that does."""
        there = any(code.act == VECTOR for code in self.target.codes.values())
        return act == VECTOR and self.crosses and not there

    def ends_length_alone(self, what: str) -> bool:
        """Whether a code that lets go of a tool length has a block of its own there.

        It may stand beside others here, and takes the axis words there (GRBL's G49).
        """
        code = self.source.codes.get(what.removeprefix(SWITCHED))
        rules = self.source.tool_rule, self.target.tool_rule
        if code is None or code.act != NO_LENGTH or not self.crosses:
            return False
        takes = rules[1].g49_takes_axes and not rules[0].g49_takes_axes
        return takes and bool(self.instead(what))

    def moves_home(self, what: str, bare: bool, called: bool) -> bool:
        """Whether a way home of the source is G53 in the target.

        `bare`: it is one of all axes; `called`: a tool length is in force.
        """
        here, there = self.source.motion_rule, self.target.motion_rule
        unknown = bare and self.crosses and not there.g28_without_axes
        unknown |= called and there.g28_ends_length and not here.g28_ends_length
        return self.instead(what) not in (what, "") or (unknown and bool(self.machine))

    @property
    def feeds_in_work(self) -> bool:
        """Whether moves in the machine at a feed are said in the work offset: G53 is rapid."""
        here, there = self.source.motion_rule, self.target.motion_rule
        return self.crosses and there.g53_is_rapid and not here.g53_is_rapid

    def _same_home(self, what: str) -> bool:
        """Whether a code goes to the same point of the machine in the target."""
        other = self.target.codes.get(what)
        same = stores_home(self.source) == stores_home(self.target)
        return other is not None and other.act == HOME and same

    def _named(self, act: str) -> str:
        """Return the one code of the target that does an act, "" if there is none."""
        names = [name for name, code in self.target.codes.items() if code.act == act]
        return names[0] if len(names) == 1 else ""

    def _spelled(self, what: str, act: str) -> str:
        """Return the code of the target that does an act, or a stronger one."""
        there = {name: code.act for name, code in self.target.codes.items()}
        if there.get(what) == act:
            return "" if act == BLEND and self._unbounded(what) else what
        for wanted in filter(None, (act, STRONGER.get(act))):
            names = [name for name, other in there.items() if other == wanted]
            if len(names) == 1 and self._takes_alike(what, names[0], wanted):
                return names[0]
        ends_nothing = act.startswith(ENDS) and act.removeprefix(ENDS) not in there.values()
        return "" if act in NEEDLESS or ends_nothing else what

    def _unbounded(self, what: str) -> bool:
        """Whether a code that rounds corners has a tolerance in the target, which is not said."""
        return "P" in self.target.codes[what].takes and "P" not in self.source.codes[what].takes

    def _takes_alike(self, what: str, other: str, act: str) -> bool:
        """Whether a code may stand for another: one that changes frames takes the same words."""
        codes = self.source.codes[what], self.target.codes[other]
        return act in SPOKEN or set(codes[0].takes) == set(codes[1].takes)

"""G and M words of a block that is written again, and the codes that it has to state.

A code of a group whose mode has to be stated becomes the one that is wanted; what the block leaves
to modes that no longer hold is stated before its first word. Codes that act before the motion stand
in the first piece of a split block, those that act after it in the last. A code that the target has
not, or takes otherwise, is refused.
"""

from __future__ import annotations

from typing import Final, NoReturn

from gcxform.catalogue.remedies import put_before
from gcxform.dialect.code_translation import FOLLOW, HOME, IN_STEP, MACHINE, RIGID, STORE_HOME
from gcxform.dialect.codes import Code, Effect, MCode
from gcxform.emit.draft import Draft
from gcxform.emit.expressible import STATED, TAPPING, code_of, like, other_in, same_m, same_tap
from gcxform.emit.fields import Key, Role
from gcxform.emit.manner import Manner
from gcxform.emit.own_blocks import apart, m_codes_of, over_hole
from gcxform.modal.meaning.asides import OWN_BLOCK, codes_in
from gcxform.modal.meaning.meaning import FRAMING, Meaning
from gcxform.modal.meaning.sorting import only_for_cycles
from gcxform.modal.meaning.tables import CYCLES
from gcxform.syntax.shapes import Shape
from gcxform.syntax.tree import CODES, Mark, Number, Word

WAY_HOME: Final = (
    "write the point on the way, if there is one, in a block of its own before; G91 G28 Z0 and the "
    "like are said by G53 where the machine file has [home.G28] and the zero of the work offset"
)
BY_TAP: Final = (
    "let the CAM write the tap for this control: whether the spindle turns in step with the feed, "
    "or a floating chuck makes up for it, each says in its own way, and some by a parameter"
)
THE_LAST: Final = "write H in this block, with the number of the last H before it"
THE_TOOLS: Final = "write H in this block, with the number of the tool in the spindle"
IF_ALIKE: Final = (
    'taps = "alike" in [output] if the spindle turns in step with the feed on both controls, or '
    "a floating chuck makes up for it on both; else let the CAM write the tap for this control"
)
BY_PLACE: Final = (
    "no program can choose there where G28 goes: write G53 with the place where G28 goes to it"
)
BY_CYCLE: Final = (
    'taps = "in-step" in [output] if the spindle turns in step with the feed in G74 and G84 of {}; '
    "else let the CAM write the tap for this control"
)
IF_IN_STEP: Final = (
    'taps = "in-step" in [output] if the spindle turns in step with the feed in G74 and G84 of {}, '
    "and they need no floating chuck; else let the CAM write the tap for this control"
)
SPLINES: Final = frozenset({"G5", "G5.1", "G5.2", "G5.3"})
EXPANDED: Final = frozenset(f"G{number}" for number in CYCLES) - frozenset(TAPPING)
"""Cycles whose moves can be written one by one."""


FRAMES: Final = FRAMING | {FOLLOW}
"""Acts of codes that `offsets` takes into the words of moves, whole or but for a tool length."""
TURNS = frozenset({"M3", "M4", "M5"})
UNKNOWN_M = ", if it turns no spindle and clamps nothing; m-codes in [output] has another for it"
SET_TOOL = "set-tool"
"""The act of a code that says which tool is in the spindle, and changes none."""


class CodeWords:
    """Writes the codes of one piece of a block into its draft."""

    def __init__(
        self, draft: Draft, key: Key, shape: Shape, meaning: Meaning, manner: Manner
    ) -> None:
        self.draft = draft
        self.key = key
        self.shape = shape
        self.meaning = meaning
        self.source, self.target = manner.source, manner.target
        self.manner, self.saying = manner, manner.saying
        self.stated: set[str] = set()
        self.repairs_wait = True

    def g_word(self, word: Word, lead: bytes) -> None:
        """Write a G word, or the one that stands for it; `lead` is what stood before it."""
        assert isinstance(word.value, Number)
        name = f"G{round(word.value.value, 6):g}"
        code = self.source.codes.get(name)
        group = code.group if code is not None else ""
        if self.key.role in (Role.MIDDLE, Role.LAST):
            lead = self.draft.gap_before(lead)
        if group == "cycle" and self.key.expanded:
            return
        if group in self.stated:
            return  # of several codes of a group one has been written
        if group in STATED and self._states(word, name, group, lead):
            return
        after = code is not None and code.after
        if self.key.role in ((Role.FIRST, Role.MIDDLE) if after else (Role.MIDDLE, Role.LAST)):
            return
        if only_for_cycles(name, self.source, self.target):
            return
        self._say(word, name, code, lead)

    def _say(self, word: Word, name: str, code: Code | None, lead: bytes) -> None:
        """Write a code that sets no mode that is stated, or the one that stands for it."""
        text, said = self.draft.said(word.start, word.end), self.saying.instead(name)
        asked, name = name, self.saying.tips.get(name, name)
        if name != asked:
            text, code = like(text, name), self.source.codes.get(name)
        if code is not None and code.act == HOME and (said != name or self.key.homed):
            if not self.key.homed:
                what = f"{name}: it goes to a point of another kind there"
                self.draft.refuse(word, what, WAY_HOME)
            return  # G53 stands before the axis words
        if code is not None and code.act == MACHINE and self.key.role not in self._machine_roles:
            return  # its words are of the work offset
        if said != name:
            text = like(text, said)
        elif self.source is not self.target and code and not self.saying.agrees(name):
            alike = self.saying.taps == "alike"
            what = other_in(self.source, self.target, name, code, self.meaning, asked, alike)
            if what:
                self._refuse(word, name, what)
        self.draft.literal(lead, text)

    @property
    def _machine_roles(self) -> tuple[Role, ...]:
        """In which pieces a code of the machine stays; with no axis another control needs none."""
        crossing = self.source is not self.target
        return (Role.VERBATIM,) if crossing else (Role.VERBATIM, Role.NONE)

    def _refuse(self, word: Word, name: str, what: str) -> NoReturn:
        """Refuse a G code, with the pass, or the option, that leads out."""
        code = self.source.codes.get(name)
        if code is not None and code.group == "cutter-comp":
            self.draft.refuse(word, what, put_before("cutter-comp"))
        folds = code is not None and (code.act in FRAMES or self.saying.folds_value(code.act))
        if folds:
            self.draft.refuse(word, what, put_before("offsets"))
        if code is not None and code.effect is Effect.INERT:
            self.draft.refuse(word, what, f"{self.saying.dropping(name)} leaves it out")
        if what == f"{name} without H":
            self.draft.refuse(word, what, THE_LAST if self.source.tool_rule.h_stays else THE_TOOLS)
        rule = self.source.cycle_rule
        cycle = None if rule is None else rule.cycles.get(int(float(name[1:])))
        if name in TAPPING or name == IN_STEP:
            same = name in TAPPING and same_tap(self.source, self.target, name, self.meaning)
            self.draft.refuse(word, what, IF_ALIKE if same else self._how_to_tap(name))
        if cycle is not None and cycle.refused:
            self.draft.refuse(word, what, f"{cycle.refused}: let the CAM write it for this control")
        if name not in EXPANDED or cycle is None:
            stores = code is not None and code.act == STORE_HOME
            self.draft.refuse(word, what, BY_PLACE if stores else "")
        if name in self.target.codes:
            what += f" as {self.source.name} means it"
        self.draft.refuse(word, what, put_before("cycles"))

    def _how_to_tap(self, name: str) -> str:
        """Return how the user says that taps are in step with the spindle, if that leads out."""
        if self.saying.can_tap_by_cycle and self.meaning.groups.get("motion") == IN_STEP:
            return BY_CYCLE.format(self.target.name)
        rule = self.source.cycle_rule
        both = IN_STEP in self.source.codes and IN_STEP in self.target.codes
        if rule is not None and rule.taps_float and both:
            return f"{IN_STEP} is a tap in step with the spindle; {BY_TAP}"
        return IF_IN_STEP.format(self.source.name) if self.saying.can_tap_in_step else BY_TAP

    def _states(self, word: Word, name: str, group: str, lead: bytes) -> bool:
        """Write the code that has to be stated for a group; return whether this settles it."""
        wanted = self._wanted(group)
        self.stated.add(group)
        if wanted is not None:
            if not self._goes_without_saying(word, wanted):
                text = self.draft.said(word.start, word.end)
                self.draft.literal(lead, text if wanted == name else like(text, wanted))
            return True
        if group != "motion":
            return False
        # A spline that goes nowhere is left out, and its words are.
        left_out = name in SPLINES and self.key.role is Role.NONE
        stays = self.key.as_it_stands or self.key.thread or self.key.tap
        return left_out or not stays or self.key.silent

    def m_word(self, word: Word, lead: bytes) -> None:
        """Write an M word, in the piece in which it acts."""
        assert isinstance(word.value, Number)
        number = int(word.value.value)
        code = self.source.m_codes.get(number, self.source.block_rule.unknown_m)
        text = self.draft.said(word.start, word.end)
        if self.source is not self.target or f"M{number}" in self.saying.m_codes:
            self._check_m(word, number, code)
            text = like(text, self.saying.instead(f"M{number}"))
            if self.key.role is not Role.NONE and any(
                word in w for w in apart(self.manner, self.shape)
            ):
                return  # it has a block of its own
        drills = self.key.expanded and self.key.role is not Role.NONE
        if drills and word in over_hole(self.source, self.shape):
            return  # it has one between the moves
        after = code is not None and code.after
        whole = self.key.role is Role.ONLY or self.key.as_it_stands
        if whole or self.key.role is (Role.LAST if after else Role.FIRST):
            self.draft.literal(self.draft.gap_before(lead), text)

    def aside(self, item: Mark, lead: bytes) -> None:
        """Write M codes behind a slash, with it, in the piece in which they act."""
        text = self.draft.said(item.start, item.end)
        for number, *_ in codes_in(text):
            one, other = m_codes_of(self.manner, number)
            said = self.saying.instead(f"M{number}") != f"M{number}"
            crosses = self.source is not self.target and not self.target.text_rule.asides
            if said or crosses or one is None or other is None or not same_m(one, other, set()):
                self.draft.refuse(item, "codes behind a slash within a block", OWN_BLOCK)
        after = any(event.after for event in self.meaning.events if event.aside)
        whole = self.key.role is Role.ONLY or self.key.as_it_stands
        if whole or self.key.role is (Role.LAST if after else Role.FIRST):
            self.draft.literal(self.draft.gap_before(lead), text)

    def _check_m(self, word: Word, number: int, code: MCode | None) -> None:
        """Refuse an M code that the target has not, or takes otherwise."""
        name = f"M{number}"
        _, other = m_codes_of(self.manner, number)
        words = {word.address for word in self.shape.block.words}
        said = self.saying.instead(name) != name
        own = code is other and self.source.name == self.target.name
        if other is None or code is None or not (said or own or same_m(code, other, words)):
            self.draft.refuse(word, name, self._way_out(name, code))

    def _way_out(self, name: str, code: MCode | None) -> str:
        """Return how the user says what takes the place of an M code."""
        if code is None or name in TURNS or code.group == "stop" or code.ends:
            return ""
        if code.group == "tool" and code.act != SET_TOOL:
            return f"{self.saying.m_coding(name, 'M0')}, where the operator changes it"
        if code.group == RIGID and self.saying.can_tap_in_step:
            return self._how_to_tap(name)
        left_out = f"{self.saying.dropping(name)} leaves it out"
        unknown = code is self.source.block_rule.unknown_m
        return f"{left_out}{UNKNOWN_M}" if unknown else left_out

    # --- what has to be stated ---

    def _wanted(self, group: str) -> str | None:
        """Return the code that has to be stated for a group, if any."""
        value = getattr(self.key, STATED[group][0])
        return None if value < 0 else STATED[group][1][value]

    def _goes_without_saying(self, word: Word, code: str) -> bool:
        """Whether the target has no such code because it knows nothing else."""
        if code in self.target.codes:
            return False
        if code != "G91.1":
            self.draft.refuse(word, code)
        return True

    def repair_before(self, word: Word, lead: bytes) -> bytes:
        """State before the first word what the block leaves to modes that no longer hold."""
        self.repairs_wait = False
        explicit = {code for code in self.meaning.groups if code in STATED}
        texts = []
        for group in STATED:
            wanted = self._wanted(group)
            if wanted is not None and group not in explicit:
                if not self._goes_without_saying(word, wanted):
                    texts.append(wanted)
                self.stated.add(group)
        if not texts:
            return lead
        self._refuse_call(word, texts)
        self.draft.literal(lead, self.draft.gap.decode().join(texts))
        return self.draft.gap

    def _refuse_call(self, word: Word, texts: list[str]) -> None:
        """Refuse words in front of a call: in what order they and the call act is not certain."""
        name = code_of(word) if word.address in CODES else ""
        code = self.source.codes.get(name)
        if code is not None and code.effect is Effect.CALL:
            stated = " ".join(texts)
            what = f"{name}, for which {stated} would have to be stated in front of it"
            self.draft.refuse(word, what, "leave such programs without the pass")

    def repair(self) -> None:
        """State what is still to be stated, in a block that had no word to put it before."""
        if self.repairs_wait and self.key.role is not Role.NONE:
            self.repairs_wait = False
            texts = [w for g in STATED if (w := self._wanted(g)) is not None]
            self.draft.literal(b"", self.draft.gap.decode().join(texts))

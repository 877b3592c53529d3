"""A dialect: one controller's language, as class attributes that a plugin overrides.

A new dialect inherits its nearest relative and overrides what differs:

    class Acme(gx.Dialect):
        "Acme 9000, firmware 3."
        name = "acme"
        axes = "XYZ"
        arc_rule = gx.ArcRule(planes=frozenset({"XY"}))

Its facts are in rules, each with its defaults and a table of what they mean: those of a class on
top of `gx.Dialect` are new (`gx.FeedRule(change_clears=True)`), those of one on top of a relative
are the relative's with changes (`replace(Fanuc.feed_rule, before_units=True)`).

Everything is data; the reader, the emitter and the verifier ask here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import is_dataclass
from typing import ClassVar

from gcxform.config import arguments
from gcxform.dialect.codes import ISO, ISO_M, Code, CutterComp, MCode
from gcxform.dialect.cycle_rule import CycleRule
from gcxform.dialect.frame_rules import OffsetRule, TipRule, ToolRule
from gcxform.dialect.increments import PointRule
from gcxform.dialect.language import Language
from gcxform.dialect.move_rules import ArcRule, FeedRule, MotionRule
from gcxform.dialect.program_rules import BlockRule, FlowRule, ProgramRule, TextRule
from gcxform.machine.control import Setting, declare
from gcxform.syntax.grammar import Grammar, load
from gcxform.values import dataclass

MOST_DECIMALS = 15  # what a double holds
INCH = 25.4  # mm, exact by definition
EXTRUDER = "E"
LINEAR = "XYZUVW" + EXTRUDER
ROTARY = "ABC"


@dataclass(frozen=True, slots=True)
class NumberFormat:
    """How numbers are written: decimals of lengths in mm and inch, of angles and of feeds.

    A number always has its point on a distance word; trailing zeros are cut unless `zeros`.
    """

    mm: int = 3
    inch: int = 4
    angle: int = 3
    feed: int = 3
    zeros: bool = False

    def __post_init__(self) -> None:
        """Refuse what is no number of decimals. Raises UsageError."""
        for name in ("mm", "inch", "angle", "feed"):
            object.__setattr__(
                self, name, arguments.whole(name, getattr(self, name), MOST_DECIMALS)
            )
        object.__setattr__(self, "zeros", arguments.flag("zeros", self.zeros))


class Dialect:
    """The base every controller dialect inherits: the common part of ISO word-address programs."""

    name: ClassVar[str] = ""
    kin: ClassVar[str] = ""
    """The dialect for which programs are taken where nothing in them tells the two apart."""
    grammar: ClassVar[tuple[str, str]] = ("gcxform_grammars", "iso")
    axes: ClassVar[str] = "XYZABC"
    translator: ClassVar[type[Language] | None] = None
    """What turns programs that are not written in words into blocks that are, which is what all
    else here is about. Such a dialect is only read: see `gcxform/flow/translation.py`."""
    codes: ClassVar[Mapping[str, Code]] = ISO
    m_codes: ClassVar[Mapping[int, MCode]] = ISO_M
    initial: ClassVar[Mapping[str, str]] = {
        "motion": "G80",
        "plane": "G17",
        "distance": "G90",
        "arc-distance": "G91.1",
        "feed-mode": "G94",
        "units": "G21",
        "frame": "G54",
        "cutter-comp": "G40",
    }
    """The modal state a program is taken to start in; the certificate says what was taken."""
    chosen: ClassVar[Mapping[str, str]] = {}
    """What is taken for the meaning of a code, or of words of an axis, where a parameter decides:
    a sentence for the certificate."""
    settings: ClassVar[tuple[Setting, ...]] = ()
    """Settings in [control] of a machine file that the dialect asks for, beside the common ones."""

    # --- programs ---
    program_rule: ClassVar[ProgramRule] = ProgramRule()
    text_rule: ClassVar[TextRule] = TextRule()
    block_rule: ClassVar[BlockRule] = BlockRule()
    flow_rule: ClassVar[FlowRule] = FlowRule()

    # --- numbers ---
    numbers: ClassVar[NumberFormat] = NumberFormat()
    point_rule: ClassVar[PointRule] = PointRule()

    # --- moves ---
    feed_rule: ClassVar[FeedRule] = FeedRule()
    motion_rule: ClassVar[MotionRule] = MotionRule()
    arc_rule: ClassVar[ArcRule] = ArcRule()
    cutter_comp: ClassVar[CutterComp] = CutterComp()

    # --- what words count from ---
    offset_rule: ClassVar[OffsetRule] = OffsetRule()
    tool_rule: ClassVar[ToolRule] = ToolRule()
    tip_rule: ClassVar[TipRule] = TipRule()

    cycle_rule: ClassVar[CycleRule | None] = None
    """What the control makes of canned cycles; None: it has none, or they are not known."""
    differs: ClassVar[Mapping[str, str]] = {}
    """What is otherwise here than on controls that agree, on purpose: a code, the name of one of
    these attributes or a fact of a rule (`arc_rule.turns`), and from where that is known. The
    conformance kit asks for it. It excuses nothing by which two things would become one."""

    def __init_subclass__(cls) -> None:
        """Let machine files have the settings that the dialect asks for.

        Raises TypeError for an attribute that nothing would read, as one that is misspelled, and
        for a rule that is none.
        """
        super().__init_subclass__()
        added = [part for part in cls.__mro__ if part not in Dialect.__mro__]
        stated = [(f"{part.__name__}.{k}", k, v) for part in added for k, v in vars(part).items()]
        for place, name, value in stated:
            if not (name.startswith("_") or hasattr(Dialect, name)):
                raise TypeError(f"{place}: gcxform.Dialect has no {name}")
            known = getattr(Dialect, name, None)
            if is_dataclass(known) and not isinstance(value, type(known)):
                raise TypeError(f"{place} is no {type(known).__name__}: {value!r}")
        declare(cls.settings)

    @classmethod
    def load_grammar(cls) -> Grammar:
        """Return the dialect's grammar, built once."""
        return load(*cls.grammar)


def run_alike(one: type[Dialect], other: type[Dialect]) -> bool:
    """Whether programs of both are for one control; of one language it may be written anew."""
    return one is other or (one.translator is not None and one.translator is other.translator)

"""What a line of plain words hangs on, so that its like need not be translated one by one.

`key` is that, but for where axes stand, which is carried along as text. Where a frame, a cycle or a
decision is in force nothing is learnt. To leave something out here is no danger: of a line that
looks at anything else nothing is learnt (`gcxform/flow/learned.py`).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from operator import attrgetter
from typing import Any, ClassVar

from gcxform_plugins.dialects.siemens.frames import Frame
from gcxform_plugins.dialects.siemens.units import Units

ROLES = {
    **dict.fromkeys((*"XYZABCIJKF", "CR"), "any"),
    **dict.fromkeys("GS", "code"),
    "N": "digits",
}
"""M codes are not here: they may return from a call, which counts in its place."""
KINDS = frozenset(("word", "value", "named"))
MODES = (
    *("motion", "said", "plane", "work", "unit", "steps", "said_steps", "said_centres", "comp"),
    *("corners", "around"),
    *(
        "changed",
        "tool",
        "waiting",
        "edge",
        "promised",
        "fed",
        "feed_mode",
        "feed_open",
        "feed_other",
        "orientation",
    ),
    *("following", "stopped", "decides", "perhaps"),
)
WITHOUT = (
    *("stay", "drilling", "once", "unknown_cycle", "unsaid", "loses", "holes"),
    *("begins", "rounding", "has_tangents", "kept_until", "owed"),
)
"""What is not, where anything is learnt."""
OTHERS = ("line", "frame", "levels", "given", "calls", "place", "heads")
PLAIN = Frame()
modes_of, without = attrgetter(*MODES), attrgetter(*WITHOUT)


class Learning(Units):
    """Says what a line hangs on."""

    keyed: ClassVar[Mapping[str, frozenset[str]]] = {
        "": frozenset(MODES),
        "place": frozenset(("at", "shifted", "unwound", "named", "moved")),
    }
    fixed: ClassVar[frozenset[str]] = frozenset(("dialect", "reading", "read", *WITHOUT, *OTHERS))

    def role(self, part: Any) -> str:
        """Return what numbers of an item may be: of G and S each is another line."""
        return ROLES.get(part.names[0], "") if part.kind in KINDS and len(part.slots) == 1 else ""

    def key(self) -> Hashable | None:
        """Return the state; None where nothing is learnt in it."""
        if any(without(self)) or self.frame != PLAIN:
            return None
        place = self.place
        known = frozenset([axis for axis, value in place.at.items() if value is not None])
        sets = known, frozenset(place.shifted), frozenset(place.unwound), frozenset(place.named)
        return modes_of(self), frozenset(self.levels[-1]), bool(self.calls), sets, place.moved

    def take_key(self, key: Any) -> None:
        """Take a state, with the axes that are lost in it."""
        modes, _, _, (known, shifted, unwound, named), moved = key
        vars(self).update(zip(MODES, modes, strict=True))
        place = self.place
        place.shifted, place.unwound, place.named = {*shifted}, {*unwound}, {*named}
        place.moved = moved
        place.at.update(dict.fromkeys(place.at.keys() - known))

    def told(self) -> dict[str, Any]:
        """Return where axes are."""
        return self.place.at

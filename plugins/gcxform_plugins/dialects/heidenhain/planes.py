"""PLANE where it tilts nothing: RESET, and SPATIAL with three angles of 0."""

from __future__ import annotations

import re
from collections.abc import Sequence
from decimal import Decimal
from typing import NoReturn

import gcxform as gx
from gcxform_plugins.dialects.heidenhain.cycles import Cycles
from gcxform_plugins.dialects.heidenhain.datums import VALUE
from gcxform_plugins.dialects.heidenhain.words import ROTARY

NULL = r"[+-]?(?:0+(?:[.,]0*)?|[.,]0+)"
UNTILTED = re.compile(
    rf"PLANE\s+(?:RESET|(SPATIAL\s+SPA\s*{NULL}\s+SPB\s*{NULL}\s+SPC\s*{NULL}))"
    rf"\s+(STAY|TURN|MOVE)((?:\s+(?:F\s*MAX|F\s*{VALUE}|(?:SEQ|SYM)\s*[+-]|(?:TABLE|COORD)\s+ROT"
    rf"|(?:DIST|ABST)\s*{VALUE}))*)\s*"
)
FEED = re.compile(rf"\sF\s*{VALUE}")
ALONE = "PLANE turns no rotary axis but {}"
STARTS = "say where they stand: start = {{ {} }} in [input]"


class Planes(Cycles):
    """Reads PLANE where it leaves words as they are."""

    def plane_of(self, item: gx.Item) -> list[str]:
        """PLANE: what tilts nothing goes along. Raises InputError for what may, or that moves.

        TURN and MOVE lead the rotary axes to 0, which is nothing where they stand there.
        """
        found = UNTILTED.fullmatch(item.name)
        if found is None:
            self.refuse(f"{item.name.strip()[:40]} is not resolved", item)
        spatial, how, options = found.groups()
        self.ends(f"PLANE {'SPATIAL' if spatial else 'RESET'}", item)
        axes = sorted({*self.reading.rotary, *self.turned()})
        open_ = [axis for axis in axes if axis not in self.place]
        turned = any(Decimal(self.place[axis]) for axis in axes if axis in self.place)
        if how != "STAY":
            self.assumed[ALONE.format(" and ".join(axes))] = None
            if turned or open_ or not axes or self.following:
                self._refuse_turned(item, axes, open_)
        elif spatial and (turned or self.following or (open_ and not self.reading.stays)):
            self._refuse_turned(item, axes, open_)
        self.untilted = bool(spatial)
        if FEED.search(options):
            self.feed_lost = True
        return self.along()

    def _refuse_turned(self, item: gx.Item, axes: Sequence[str], open_: Sequence[str]) -> NoReturn:
        """Refuse PLANE where an axis is turned, or may be: `open_` are those that may."""
        known = axes and not open_
        places = ", ".join(f"{axis} = 0" for axis in axes or "AC")
        why = "an axis is turned" if known else "whether an axis is turned is not known"
        told = known or {*self.moved, *self.lost}.intersection(open_ or ROTARY)
        hint = () if told else (STARTS.format(places),)
        self.refuse(f"{item.name.strip()[:40]}: {why}", item, *hint)

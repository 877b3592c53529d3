"""Calls with arguments in a line for a SINUMERIK: cycles, patterns, and what moves nothing."""

from __future__ import annotations

from collections.abc import Sequence

import gcxform as gx
from gcxform_plugins.dialects.siemens import cycles as cycles
from gcxform_plugins.dialects.siemens.asides import TELLING
from gcxform_plugins.dialects.siemens.axes_of_lines import MILLING
from gcxform_plugins.dialects.siemens.line import Line
from gcxform_plugins.dialects.siemens.place import LINEAR
from gcxform_plugins.dialects.siemens.reading import WHY
from gcxform_plugins.dialects.siemens.structure import HEAD, code
from gcxform_plugins.dialects.siemens.swivelling import Swivelling


class CycleCalls(Swivelling):
    """Takes calls into a line."""

    def _call(self, line: Line, item: gx.Item) -> None:
        name, given = cycles.arguments(item)
        if name == "TRAORI" and given in ([""], ["1"]):
            self._switched(line, item, name)
        elif name in cycles.READ or (self.reading.asides and self._may_stay(name)):
            self._one(line, "cycle", item)
            self._drilled(line, item, name, given)
        elif name in ("HOLES1", "HOLES2") and self.drilling is not None:
            self._one(line, "cycle", item)
            self.once = self.drilling
            try:
                stands = [self.place.known(axis) for axis in self.plane]
                self.holes = cycles.row(given, stands) if name[-1] == "1" else cycles.circle(given)
            except cycles.CycleError as error:
                self.refuse(f"{name}: {error}", item)
        elif line.modal is not None:
            self.refuse(WHY.get(name, f"MCALL of {name}(...) is not read"), item)
        elif self._quiet(name, given):
            self._one(line, "alone", item)
            if name != "CYCLE800":
                self._goes_along(line, item, "", self.text_of(item))
            else:
                self.end_plane(line)
                if self.reading.asides:
                    line.asides.append(self.text_of(item))
        elif name == "CYCLE800" and self.may_swivel(given):
            self._one(line, "alone", item)
            self.take_swivel(line, item, given)
        else:
            why = WHY.get(name, f"{name}(...) is not read")
            self.refuse(f"{why}, with these arguments" if name in WHY else why, item)

    def _quiet(self, name: str, given: Sequence[str]) -> bool:
        """Whether a call moves nothing and changes no word behind it."""
        if name == "CYCLE800":
            return given == [""] or self._stands_still(given)
        steers = name == "CYCLE832" and cycles.keeps_path(given, self.following)
        usual = name == "FGROUP" and sorted(given) in ([""], [*LINEAR])
        return name in TELLING or steers or usual

    def _stands_still(self, given: Sequence[str]) -> bool:
        """Whether a swivel to nowhere turns no axis: two of them at least are known to be at 0."""
        return (
            self.place.unturned() and self.place.rotary_axes > 1 and cycles.swivels_nowhere(given)
        )

    def _drilled(self, line: Line, item: gx.Item, name: str, given: Sequence[str]) -> None:
        """Take a cycle, for this place or, behind MCALL, for those of the lines that follow."""
        if self.following or self.comp:
            self.refuse(f"{name} under TRAORI or compensation", item)
        try:
            hole = self._hole(item, name, given)
        except cycles.CycleError as error:
            self.refuse(f"{name}: {error}", item)
        if line.modal is None:
            self.once = hole
        else:
            self.drilling, line.cycle = hole, None

    def _may_stay(self, name: str) -> bool:
        return name in cycles.OF_CALL or MILLING.fullmatch(f"{name}(") is not None

    def _hole(self, item: gx.Item, name: str, given: Sequence[str]) -> cycles.Drilling:
        """Return what a cycle does: of one that is not read, if its call may stay.

        Raises CycleError.
        """
        axis = next(a for a in LINEAR if a not in self.plane)
        try:
            if name in cycles.READ:
                return cycles.drilling(name, given, axis)
        except cycles.CycleError:
            if not self.reading.asides:
                raise
        if name in cycles.OF_CALL:
            deep = self.reading.compensates
            return cycles.kept_hole(name, given, axis, self.text_of(item), deep)
        if any(map(self._is_label, cycles.texts_in(given))):
            raise cycles.CycleError("its contour stands in this program, and may become another")
        return cycles.kept_path(name, given, axis, self.text_of(item))

    def _is_label(self, name: str) -> bool:
        """Whether a text names lines of the program: a label, the number of a block, or two."""
        named = {each.strip().upper() for each in name.split(":")}
        heads = (HEAD.match(code(line)) for line in self.lines)
        said = ((head["label"] or "", f"N{head['number']}") for head in heads if head)
        return any(label.upper() in named or number in named for label, number in said)

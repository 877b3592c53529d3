"""The pages that are written: of one program, of two that are compared, and of a pipeline's run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np

from gcxform.diagnostics import InputError
from gcxform.pipeline.plan import Plan
from gcxform.system.arrays import Floats, Ints
from gcxform.values import dataclass
from gcxform.view import document
from gcxform.view.linking import Linked, linked, owners
from gcxform.view.packing import Store
from gcxform.view.programs import Told, described, line_of_rows
from gcxform.view.reading import Shown
from gcxform.view.results import outcome

PARTED = "From some line on nothing of the two paths fits: what has no colour was not compared."

TIP = "{}: X, Y, Z are taken for those of the axes, and drawn is the tip, by the machine file."


@dataclass
class Page:
    """What is shown besides the programs.

    speeds       top speeds of axes in mm/min or degrees/min, for rapids
    certificate  as it is written
    scene        what stands around the path
    """

    title: str
    speeds: Mapping[str, float] = field(default_factory=dict)
    certificate: Mapping[str, Any] | None = None
    scene: Mapping[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)

    def of_one(self, shown: Shown) -> bytes:
        """Return the page of one program."""
        return self._written((shown, Told()))

    def of_two(self, source: Shown, output: Shown, origin: Ints | None = None) -> bytes:
        """Return the page of two programs; `origin` is the source line of each of the output.

        Without it lines belong together if their moves do.
        """
        found = linked(source.path, output.path, _owner(source, output, origin))
        if origin is None:
            origin = _origin(source, output, found)
        self._note(found)
        one, other = found.distance
        told = Told({"deviation": other}, source=origin)
        return self._written((source, Told({"deviation": one})), (output, told))

    def of_run(self, plan: Plan, source: Shown, output: Shown, origin: Ints) -> bytes:
        """Return the page of a program and of what a pipeline made of it."""
        try:
            owner = _owner(source, output, origin)
            found = outcome(plan, source.path, output.path, owner)
        except InputError as refused:
            self.notes.append(f"Steps are not told apart: {refused.diagnostics[0].message}.")
            return self.of_two(source, output, origin)
        self._note(found.belongs)
        names = ["unchanged", *(step.name for step in plan.path_passes)]
        error = None if found.error is None else found.error[source.path.source]
        step = found.step[source.path.source]
        row, known = np.maximum(found.belongs.row, 0), found.belongs.row >= 0
        one, other = found.belongs.distance
        before = Told(_sizes(one, error), {"pass": (names, step)})
        theirs = None if error is None else np.where(known, error[row], np.nan)
        after = Told(
            _sizes(other, theirs), {"pass": (names, np.where(known, step[row], 0))}, origin
        )
        return self._written((source, before), (output, after))

    def _note(self, found: Linked) -> None:
        if found.parted:
            self.notes.append(PARTED)

    def _written(self, *programs: tuple[Shown, Told]) -> bytes:
        store = Store()
        found = [described(shown, store, self.speeds, told) for shown, told in programs]
        for program in found:
            if "tips" in program["path"]:
                self.notes.append(TIP.format(program["name"]))
        head = {
            "title": self.title,
            "programs": found,
            "certificate": self.certificate,
            "scene": self.scene,
            "notes": self.notes,
        }
        return document.written(self.title, head, store).encode()


def _sizes(deviation: Floats, error: Floats | None) -> dict[str, Floats]:
    return {"deviation": deviation} | ({} if error is None else {"error": error})


def _owner(source: Shown, output: Shown, origin: Ints | None) -> Ints | None:
    """Return the row of the source that each of the output came from, where that is certain."""
    lines = line_of_rows(output.path, output.line)
    if origin is None or int(lines.max(initial=-1)) >= len(origin):
        return None
    return owners(line_of_rows(source.path, source.line), origin[lines])


def _origin(source: Shown, output: Shown, found: Linked) -> Ints:
    """Return the source line, from 0, of each line of the output whose moves belong to some."""
    lines = int(output.line.max(initial=-1)) + 1
    origin = np.full(lines, -1)
    ours = line_of_rows(source.path, source.line)
    rows = np.flatnonzero(found.row >= 0)[::-1]
    origin[line_of_rows(output.path, output.line)[rows]] = ours[found.row[rows]]
    return origin

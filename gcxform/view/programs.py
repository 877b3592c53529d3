"""What the page is told of a program."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any, Final

import numpy as np

from gcxform.system.arrays import Floats, Ints
from gcxform.toolpath.frames import Frame
from gcxform.toolpath.path import Toolpath
from gcxform.toolpath.tools import ToolInSpindle
from gcxform.values import dataclass
from gcxform.view import lines, paths
from gcxform.view.packing import Section, Store
from gcxform.view.reading import Shown
from gcxform.view.tips import described_chain, rotary_chain, tips

RAPID_SPEED: Final = 10_000.0  # mm/min or degrees/min of axes of which no file says theirs
FINE: Final = 0.01  # um
UM: Final = 1000.0  # per mm


@dataclass(frozen=True)
class Told:
    """What is known of the moves of a program besides: sizes (n,) in mm, and sorts (n,) by name.

    `source` (lines of the text,) is the line of the program it was made of, from 0, -1 for none.
    """

    sizes: Mapping[str, Floats] = field(default_factory=dict)
    sorts: Mapping[str, tuple[Sequence[str], Ints]] = field(default_factory=dict)
    source: Ints | None = None


def described(
    shown: Shown, store: Store, speeds: Mapping[str, float], told: Told | None = None
) -> dict[str, Any]:
    """Add a program to a store; return what the page is told of it.

    `speeds` are the top speeds of axes in mm/min or degrees/min, for rapids.
    """
    told = told or Told()
    count, blocks = lines.packed(shown.text, store)
    plain = len(shown.line) == count and bool((shown.line == np.arange(count)).all())
    sorts = {"tool": _tools(shown), **told.sorts}
    chain = rotary_chain(shown.machine)
    tip = None if shown.tips or shown.machine is None else tips(shown.path, shown.machine)
    on_part = shown.tips or tip is not None
    path = paths.packed(shown.path, store)
    return {
        "name": Path(shown.name).name,  # a page may be mailed: where files lie is nobody's business
        "dialect": shown.dialect.name,
        "words": shown.dialect.translator is None,
        "lines": count,
        "blocks": blocks,
        "line": None if plain else store.ints(shown.line),
        "mode": store.ints(shown.mode),
        "modes": shown.modes,
        "path": path | ({} if tip is None else {"tips": tip.packed(store)}),
        "chain": None if chain is None else described_chain(chain),
        "frames": [_frame(frame) for frame in shown.path.frames],
        "follows": [on_part or bool(frame.following) for frame in shown.path.frames],
        "from": None if told.source is None else store.ints(told.source[:count]),
        "speeds": {"assumed": RAPID_SPEED, **speeds},
        "sizes": [_size(name, values, store) for name, values in told.sizes.items()],
        "sorts": [_sort(name, *sort, store) for name, sort in sorts.items() if len(sort[0]) > 1],
    }


def _frame(frame: Frame) -> dict[str, Any]:
    """Return how positions become words: they are shifted back, turned back, and X doubled."""
    found: dict[str, Any] = {"work": frame.work}
    if any(frame.shift):
        found["shift"] = np.nan_to_num(frame.shift).tolist()
    if frame.matrix is not None:
        found["inverse"] = np.linalg.inv(np.array(frame.matrix)).tolist()
    if np.nan_to_num(frame.tool).any():
        found["tool"] = np.nan_to_num(frame.tool).tolist()
    if frame.following:
        found["following"] = True
    if frame.diameter:
        found["diameter"] = True
    return found


def _size(name: str, values: Floats, store: Store) -> Section:
    """Add a column of mm as um; what is not known is -1."""
    known = np.where(np.isfinite(values), UM * values, -1.0)
    return {"name": name, "unit": "um", "of": store.lengths(known, FINE)}


def _sort(name: str, names: Sequence[str], values: Ints, store: Store) -> Section:
    return {"name": name, "names": list(names), "of": store.ints(values)}


def _tools(shown: Shown) -> tuple[list[str], Ints]:
    """Return the tools by name, and which of them makes each move."""
    path = shown.path
    spindle = ToolInSpindle(shown.dialect, {event.what for event in path.events})
    names, found = [spindle.loaded], np.zeros(len(path), np.int64)
    for event in path.events:
        if spindle.see(event):
            if spindle.loaded not in names:
                names.append(spindle.loaded)
            found[event.row :] = names.index(spindle.loaded)
    return _used(names, found)


def _used(names: list[str], found: Ints) -> tuple[list[str], Ints]:
    """Leave out names that nothing has."""
    used, which = np.unique(found, return_inverse=True)
    return [names[k] for k in used.tolist()], which.astype(np.int64)


def line_of_rows(path: Toolpath, line: Ints) -> Ints:
    """Return the line of the text, from 0, of each move."""
    return np.asarray(line[path.source])

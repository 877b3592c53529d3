"""What the page is told of a program."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from gcxform.system.arrays import Ints
from gcxform.view import lines, paths
from gcxform.view.packing import Store
from gcxform.view.reading import Shown

RAPID_SPEED: Final = 10_000.0  # mm/min or degrees/min of axes of which no file says theirs


def described(
    shown: Shown, store: Store, speeds: Mapping[str, float], source: Ints | None = None
) -> dict[str, Any]:
    """Add a program to a store; return what the page is told of it.

    `source` (lines of the text,) is the line of the program it was made of, from 0, -1 for none.
    """
    count, blocks = lines.packed(shown.text, store)
    plain = len(shown.line) == count and bool((shown.line == np.arange(count)).all())
    return {
        "name": shown.name,
        "dialect": shown.dialect.name,
        "words": shown.dialect.translator is None,
        "lines": count,
        "blocks": blocks,
        "line": None if plain else store.ints(shown.line),
        "mode": store.ints(shown.mode),
        "modes": shown.modes,
        "path": paths.packed(shown.path, store),
        "from": None if source is None else store.ints(source),
        "speeds": {"assumed": RAPID_SPEED, **speeds},
        "sizes": [],
        "sorts": [],
    }

"""A light picture of paths: lines in space from one side, as SVG of a few kilobytes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from gcxform.system.arrays import Floats

WIDTH, HEIGHT, EDGE = 360.0, 240.0, 8.0
MOST: Final = 3000  # points; more do not show at this size
COLOURS: Final = {"rapid": "#999999", "feed": "#0072b2", "error": "#d55e00"}
"""Told apart by colour-blind eyes, on white and on black."""


class Stroke(NamedTuple):
    """A line through points (n, 3) in mm; nan breaks it. `name` is one of `COLOURS`."""

    points: Floats
    name: str


def drawn(strokes: Sequence[Stroke], what: str) -> str:
    """Return strokes as SVG: from above if they are flat, otherwise from a corner.

    `what` is said to who does not see it. Nothing is drawn of nothing.
    """
    known = [s for s in strokes if np.isfinite(s.points).all(axis=1).any()]
    if not known:
        return ""
    flat = _flat([stroke.points for stroke in known])
    seen = [_seen(stroke.points, flat) for stroke in known]
    low, high = _box(seen)
    scale = min((WIDTH - 2 * EDGE) / max(high[0] - low[0], 1e-9), _tall(high[1] - low[1]))
    lines = "".join(
        _line((points - low) * scale, (high[1] - low[1]) * scale, stroke.name)
        for points, stroke in zip(seen, known, strict=True)
    )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" '
        f'width="{WIDTH:g}" height="{HEIGHT:g}" role="img" aria-label="{what}">{lines}</svg>'
    )


def _flat(points: Sequence[Floats]) -> bool:
    heights = np.concatenate([each[:, 2] for each in points])
    return bool(np.nanmax(heights, initial=0.0) - np.nanmin(heights, initial=0.0) < 1e-9)


def _seen(points: Floats, flat: bool) -> Floats:
    """Return points (n, 2) of the picture, upwards, mm."""
    x, y, z = points.T
    if flat:
        return np.stack([x, y], axis=1)
    cosine, sine = math.cos(math.radians(30.0)), 0.5
    return np.stack([(x - y) * cosine, (x + y) * sine + z], axis=1)


def _box(seen: Sequence[Floats]) -> tuple[Floats, Floats]:
    everything = np.concatenate(seen)
    known = everything[np.isfinite(everything).all(axis=1)]
    return known.min(axis=0), known.max(axis=0)


def _tall(height: float) -> float:
    return (HEIGHT - 2 * EDGE) / max(height, 1e-9)


def _line(points: Floats, height: float, name: str) -> str:
    """Return a stroke; of very many points some are left out, and both ends of each part stay."""
    step = max(1, len(points) // MOST)
    parts = []
    gaps = np.flatnonzero(~np.isfinite(points).all(axis=1))
    for part in np.split(points, gaps):
        part = part[np.isfinite(part).all(axis=1)]
        if len(part) > 1:
            kept = np.concatenate([part[:-1:step], part[-1:]])
            words = (f"{x + EDGE:.1f} {height - y + EDGE:.1f}" for x, y in kept.tolist())
            parts.append("M" + "L".join(words))
    if not parts:
        return ""
    dashes = ' stroke-dasharray="3 3"' if name == "rapid" else ""
    return (
        f'<path d="{"".join(parts)}" fill="none" stroke="{COLOURS[name]}" '
        f'stroke-width="1"{dashes}/>'
    )

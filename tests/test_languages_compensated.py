"""Programs in a language of their own are compensated in that language, and the tool goes right.

What is written is read by the readers of `tests/reference/shop.py`, which share no code with the
engine, and taken through the error of the machine by a formula of the test's own.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import seeds_kit
from reference import shop
from shop_kit import Drawn
from test_across_drawn import reading_of

import gcxform as gx

MODEL = 'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nA0Z = 1e-4\n'
NEAR = 2.5e-3  # mm: what the pass may leave, and three decimals


def reached(place: shop.Point) -> np.ndarray:
    """Return where the machine goes for a command, counted from the zero of G54."""
    x, y, z = np.array(place) - np.array(shop.OFFSETS[1], float)
    return np.array([x - 1e-4 * y, y - 1e-4 * z, z]) + np.array(shop.OFFSETS[1], float)


def split(found: list[shop.Move | str]) -> tuple[list[shop.Move], list[str]]:
    moves = [each for each in found if isinstance(each, shop.Move)]
    return moves, [each for each in found if isinstance(each, str)]


@pytest.mark.parametrize("language", ["siemens", "fagor"])
def test_the_tool_goes_where_the_program_says(language: str, tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    volumetric = f"volumetric model={tmp_path}/model.toml part-origin=0,0,0"
    pipeline = gx.Pipeline.parse(f"segment chord-error=5um | {volumetric}", language)
    done = 0
    for seed in seeds_kit.some(50):
        text = Drawn(seed, language).text()
        out = replace(pipeline, reading=reading_of(language)).run(text.encode()).text.decode()
        (meant, told), (moves, said) = (
            split(shop.read(language, text)),
            split(shop.read(language, out)),
        )
        assert told == said, out
        at = 0
        said_z = (k for k, move in enumerate(meant) if move.end[2] != 0)
        first = next(said_z, len(meant))  # before it Z is where the machine stands
        for move in meant[first:]:
            ends = (np.abs(reached(each.end) - np.array(move.end)).max() for each in moves[at:])
            found = next((k for k, far in enumerate(ends) if far < NEAR), None)
            assert found is not None, f"{move}\n{text}\n{out}"
            at += found
            done += 1
    assert done > 50


def test_what_is_compensated_is_not_compensated_again(tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    volumetric = f"volumetric model={tmp_path}/model.toml part-origin=0,0,0"
    pipeline = gx.Pipeline.parse(volumetric, "siemens")
    text = b"G710 G17 G90 G54 G94\nG0 X10 Y10 Z5\nG1 X50 F100\nM30\n"
    once = pipeline.run(text).text
    assert once.startswith(b"; GCXFORM STAMP") or b"\n; GCXFORM STAMP" in once
    with pytest.raises(gx.GcxformError, match="done already"):
        pipeline.run(once)


@pytest.mark.parametrize(
    ("language", "chain", "says"),
    [
        ("siemens", "renumber", "changes text"),
        ("siemens", "volumetric model=MODEL part-origin=0,0,0 | renumber", "changes text"),
        ("heidenhain", "volumetric model=MODEL part-origin=0,0,0", "have no place for it"),
    ],
)
def test_what_a_language_has_no_place_for_is_refused(
    language: str, chain: str, says: str, tmp_path: Path
) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    with pytest.raises(gx.UsageError, match=says):
        gx.Pipeline.parse(chain.replace("MODEL", f"{tmp_path}/model.toml"), language)

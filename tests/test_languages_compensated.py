"""Programs in a language of their own are compensated in that language, and the tool goes right.

What is written is read by the readers of `tests/reference/shop.py`, which share no code with the
engine, and taken through the error of the machine by a formula of the test's own.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import seeds_kit
from gcxform_plugins.dialects.heidenhain.lines import Lines
from gcxform_plugins.dialects.heidenhain.positioning import ROUNDS, SHORTEST, SILENT
from heidenhain_kit import program
from reference import heidenhain as klartext
from reference import shop
from shop_kit import Drawn
from test_across_drawn import reading_of
from test_heidenhain import TOOLS
from test_heidenhain import Writer as Klartext

import gcxform as gx
from gcxform.flow.speller import Speller
from gcxform.flow.tool_names import ToolNames
from gcxform.modal.state import Reading
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source

MODEL = 'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nA0Z = 1e-4\n'
PROGRAMS = {
    "siemens": "G710 G17 G90 G54 G94\nG0 X10 Y10 Z5\nG1 X50 F100\nG91 X1\nM30\n",
    "fagor": "%P\nG71 G17 G90 G54 G94\nG0 X10 Y10 Z5\nG1 X50 F100\nG91 X1\nM30\n",
    "heidenhain": "0 BEGIN PGM P MM\n1 L X+10 Y+10 Z+5 R0 FMAX\n2 L X+50 F100\n3 L IX+1\n"
    "4 M30\n5 END PGM P MM\n",
}
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


class Still(Klartext):
    """Draws programs in Klartext that follow no tip."""

    def switch(self) -> list[str]:
        return self.quiet()


def in_machine(step: klartext.Step) -> np.ndarray:
    return np.array([step.end.get(a, np.nan) + step.shift.get(a, 0.0) for a in "XYZABC"])


def told_once(events: list[str]) -> list[str]:
    """Return events without a tool that is fetched right before it is called."""
    same = zip(events, [*events[1:], ""], strict=True)
    return [one for one, after in same if not (one[0] == "T" and one == after)]


def leads_there(step: klartext.Step, there: np.ndarray, feed: float | None) -> bool:
    same = step.feed == feed if feed is None or step.feed is None else abs(step.feed - feed) < 0.1
    return same and bool(np.abs(in_machine(step) - there).max() < NEAR)


@pytest.mark.parametrize("structure", ["keep", "written-out"])
def test_klartext_goes_where_the_program_says(structure: str, tmp_path: Path) -> None:
    (tmp_path / "model.toml").write_text('format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\n')
    volumetric = f"volumetric model={tmp_path}/model.toml part-origin=0,0,0 max-correction=1mm"
    pipeline = gx.Pipeline.parse(f"segment chord-error=5um | {volumetric}", "heidenhain")
    done = 0
    for seed in seeds_kit.some(60):
        text = Still(seed).program()
        known = replace(pipeline, reading=Reading(tools=TOOLS), structure=structure)
        found = known.run(text.encode())
        meant, written = (klartext.read(each) for each in (text, found.text.decode()))
        assert told_once(meant.events) == told_once(written.events), found.text.decode()
        at = 0
        for step in meant.steps:
            there = in_machine(step)
            if not np.isfinite(there).all():
                continue
            there[0] += 1e-4 * there[1]
            ways = enumerate(written.steps[at:])
            more = next((k for k, each in ways if leads_there(each, there, step.feed)), None)
            assert more is not None, f"{step}\n{text}\n{found.text.decode()}"
            at += more
            done += 1
    assert done > 300


def compensating(folder: Path) -> gx.Pipeline:
    """Return a pipeline that compensates Klartext, writes it whole, and without a stamp."""
    (folder / "model.toml").write_text(MODEL)
    volumetric = f"volumetric model={folder}/model.toml part-origin=0,0,0"
    pipeline = gx.Pipeline.parse(volumetric, "heidenhain")
    return replace(pipeline, stamp=False, structure="written-out")


@pytest.mark.parametrize("code", sorted((SILENT | SHORTEST) - {ROUNDS} | {129}))
def test_m_functions_of_klartext_go_along(code: int, tmp_path: Path) -> None:
    text = program("L X+1 Y+1 Z+1 FMAX", f"M{code}", "L X+2 F100", f"L X+3 M{code}", "L X+4")
    lines = compensating(tmp_path).run(text.encode()).text.decode().splitlines()
    said = [k for k, line in enumerate(lines) if line.endswith(f" M{code}")]
    moves = [k for k, line in enumerate(lines) if " X+" in line]
    assert moves[0] < said[0] < moves[1]
    assert len(said) == 2
    assert said[1] in (moves[2] - 1, moves[2] + 1)


def test_tools_that_are_made_up_are_several() -> None:
    names = ToolNames(Reading(tools=TOOLS, asides=True))
    numbers = [names.number(name) for name in ("a", "b", "a", "A")]
    assert len({*numbers}) == 3
    assert numbers[0] == numbers[2]
    assert not {*map(int, numbers)} & {*TOOLS}


def test_letters_of_comments_stay_whole(tmp_path: Path) -> None:
    text = program("* - Vis à", "L X+1 Y+1 Z+1 FMAX ; Å", "FN 15: PRINT à", "L X+2 F100 ; voilà ")
    lines = compensating(tmp_path).run(text.encode()).text.decode().splitlines()
    assert lines[1] == "1 * - Vis à"
    assert [line.partition(" ; ")[2] for line in lines if ";" in line] == ["Å", "voilà"]
    assert lines[3] == "3 FN 15: PRINT à"


def test_what_goes_along_is_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    heard = Speller.heard

    def misheard(*said: str) -> tuple[list[str], list[str], list[tuple[str, str]]]:
        asides, comments, words = heard(*said)
        return [each.replace("M126", "M127") for each in asides], comments, words

    monkeypatch.setattr(Speller, "heard", misheard)
    with pytest.raises(gx.GcxformError, match="what goes along"):
        compensating(tmp_path).run(program("L X+1 Y+1 Z+1 FMAX", "M126").encode())


def test_what_goes_along_has_its_place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    gathered = Lines.gathered

    def moved(self: Lines, lines: list[tuple[str, int]]) -> list[tuple[str, int]]:
        found = [*gathered(self, lines)]
        said = next(each for each in found if each[0] == "M126")
        return [each for each in found if each != said] + [said]

    monkeypatch.setattr(Lines, "gathered", moved)
    text = program("L X+1 Y+1 Z+1 FMAX", "M126", "L X+2 F100")
    with pytest.raises(gx.GcxformError, match="M9001 is M9001"):
        compensating(tmp_path).run(text.encode())


@pytest.mark.parametrize(("language", "text"), PROGRAMS.items())
def test_what_is_compensated_is_not_compensated_again(
    language: str, text: str, tmp_path: Path
) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    volumetric = f"volumetric model={tmp_path}/model.toml part-origin=0,0,0"
    pipeline = gx.Pipeline.parse(volumetric, language)
    once = pipeline.run(text.encode()).text
    assert re.search(rb"^(\d+ )?; GCXFORM STAMP", once, re.MULTILINE)
    with pytest.raises(gx.GcxformError, match="done already"):
        pipeline.run(once)
    again = gx.Pipeline.parse("absolute", language).run(once).text
    assert stamps_in(Source.of_bytes(again)).fits
    assert len(again.splitlines()) == len(once.splitlines())
    assert once != again  # steps stay where positions become others
    edited = gx.Pipeline.parse("absolute", language).run(once.replace(b"10", b"11")).text
    assert not stamps_in(Source.of_bytes(edited)).fits


@pytest.mark.parametrize(
    ("language", "chain", "says"),
    [
        ("siemens", "renumber", "changes text"),
        ("siemens", "volumetric model=MODEL part-origin=0,0,0 | renumber", "changes text"),
    ],
)
def test_what_a_language_has_no_place_for_is_refused(
    language: str, chain: str, says: str, tmp_path: Path
) -> None:
    (tmp_path / "model.toml").write_text(MODEL)
    with pytest.raises(gx.UsageError, match=says):
        gx.Pipeline.parse(chain.replace("MODEL", f"{tmp_path}/model.toml"), language)

"""Never twice, for programs that nobody has chosen: generated ones, and the cases of the corpus."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest
import stamp_kit as kit
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from oracles import rs274
from test_corpus import PLACES, all_cases, name

import gcxform as gx
from gcxform.stamps.comment import stamps_in
from gcxform.syntax.source import Source
from gcxform.testing.strategies import programs

WIDE = f"{kit.VOLUMETRIC} outside=clamp"
CHAINS = (WIDE, f"absolute | {WIDE}", f"metric | absolute | segment chord-error=5um | {WIDE}")
AFTER = ("absolute", "strip", "renumber", "strip | renumber")
CHANGES = [
    case
    for case in all_cases()
    if re.search('use = "(volumetric|rtcp|to-tip|repost|retarget)"', case.text("pipeline.toml"))
]
FEW = settings(max_examples=10, suppress_health_check=[HealthCheck.function_scoped_fixture])


def once(pipe: gx.Pipeline, program: bytes) -> bytes | None:
    """Return what becomes of a program; None where it is refused for another reason."""
    try:
        return pipe.run(program).text
    except gx.InputError:
        return None


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc", "haas", "grbl"])
@FEW
@given(data=st.data())
def test_what_was_done_is_not_done_again(tmp_path: Path, dialect: str, data: st.DataObject) -> None:
    kit.workplace(tmp_path)
    program = data.draw(programs(dialect, max_blocks=12))
    end = data.draw(st.sampled_from([b"\n", b"\r\n"]))
    program = program.replace(b"\r", b"").replace(b"\n", end)
    pipe = kit.pipeline(data.draw(st.sampled_from(CHAINS)), tmp_path, dialect, budget=1.0)
    plain = once(dataclasses.replace(pipe, stamp=False), program)
    text = once(pipe, program)
    assert (text is None) == (plain is None)
    if text is None or not stamps_in(Source.of_bytes(text)):
        assert text == plain
        return
    assert kit.bare(text) == plain or kit.bare(text) == (plain or b"") + end
    assert kit.code(pipe, text) == "GX241"
    assert kit.code(dataclasses.replace(pipe, words="all"), text) == "GX240"
    first, last = text.index(b"(GCXFORM STAMP"), text.index(b"(GCXFORM SEAL")
    place = data.draw(st.integers(0, last))
    inside = first < place < text.index(b")", first)
    for edited in (text[:place] + b"\n" + text[place:], text[:place] + text[last:], text[:place]):
        if place < last and not inside and (stamps := stamps_in(Source.of_bytes(edited))):
            assert stamps.edited
            assert kit.code(pipe, edited) == "GX240"
    after = once(kit.pipeline(data.draw(st.sampled_from(AFTER)), tmp_path, dialect), text)
    if after is not None:
        assert stamps_in(Source.of_bytes(after)).fits
        assert kit.code(pipe, after) == "GX241"


@pytest.mark.by_turns
@pytest.mark.parametrize("case", CHANGES, ids=lambda case: name(case.path))
def test_a_stamp_is_all_that_is_new(case, tmp_path):
    """And LinuxCNC goes the same way with it."""
    text = case.sections["pipeline.toml"]
    for key, content in case.sections.items():
        (tmp_path / key).write_bytes(content)
    for key, path in PLACES.items():
        text = text.replace(f'= "{key}"'.encode(), f"= '{path}'".encode())
    (tmp_path / "pipeline.toml").write_bytes(text)
    try:
        pipe = gx.Pipeline.load(tmp_path / "pipeline.toml")
        plain = dataclasses.replace(pipe, stamp=False).run(case.sections["input.nc"])
    except gx.GcxformError:
        return
    stamped = pipe.run(case.sections["input.nc"])
    assert kit.bare(stamped.text).rstrip() == plain.text.rstrip()
    largest, bare = stamped.certificate.largest, plain.certificate.largest
    assert largest.get("deviation") == bare.get("deviation")  # none where nothing moves
    if not stamps_in(Source.of_bytes(stamped.text)):
        return
    if pipe.target.name == pipe.source.name:
        with pytest.raises(gx.InputError, match="GX241"):
            pipe.run(stamped.text)
    if pipe.target.name == "linuxcnc" and rs274.available():
        paths = [[move.machine for move in rs274.run(each.text).moves] for each in (plain, stamped)]
        assert paths[0] == paths[1]

"""The matrix of corpus/offsets has no hole: every code, in every dialect that has it, both ways."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import gcxform as gx
from gcxform.modal.meaning.meaning import FRAMING
from gcxform.plugin.registry import default_registry

CASES = Path(__file__).parents[1] / "corpus" / "offsets"
KINDS = {
    "work": ("g55", "g54.1"),
    "diameter": ("g7",),
    "polar": ("g16",),
    "rotate": ("g68",),
    "mirror": ("g51.1",),
    "set-work": ("g10-l2",),
    "local": ("g52",),
    "preset": ("g92",),
    "home": ("g28",),
    "machine": ("g53",),
}
"""Acts, with the beginnings of the names of their cases."""
ENDED = frozenset({"no-polar", "no-rotate", "no-scale", "no-mirror"})
ENDED |= {"preset-clear", "preset-suspend", "preset-restore"}
UNREAD = frozenset({"scale"})  # refused: what a factor of 1 is depends on a parameter
ELSEWHERE = {("grbl", "home"), ("grbl", "machine"), ("fanuc", "machine")}


@pytest.mark.parametrize("dialect", ["fanuc", "grbl", "linuxcnc"])
def test_every_shift_has_a_case(dialect: str) -> None:
    names = [case.stem for case in CASES.glob("*.txt")]
    acts = {code.act for code in default_registry().dialect(dialect).codes.values() if code.act}
    for act in acts & (FRAMING | {"home", "machine"}) - ENDED - UNREAD:
        if (dialect, act) not in ELSEWHERE:
            begins = tuple(f"{dialect}-{name}" for name in KINDS[act])
            assert any(name.startswith(begins) for name in names), (dialect, act)


@pytest.mark.parametrize("case", sorted(CASES.glob("*.txt")), ids=lambda case: case.stem)
def test_a_case_has_arcs_both_ways_and_distances(case: Path) -> None:
    """One case for each code has them; the others are about something else."""
    text = case.read_text(encoding="utf-8")
    plain = re.fullmatch(r"\w+-g(52|92|55|54\.1|10-l2|10-l20|10-l2-r|68|51\.1|7)", case.stem)
    if plain:
        assert {"G90", "G91", "G2", "G3"} <= set(re.findall(r"G\d+", text)), case.stem


def test_nothing_of_a_shift_is_left() -> None:
    source = b"G21 G90\nG0 X0 Y0 Z5\nN5 G52 X1 (one)\nG92.1 G0 X2 ;two\n/G92 X0\nG54 X3\nM2\n"
    pipeline = gx.Pipeline.parse("offsets", "linuxcnc")
    with pytest.raises(gx.InputError, match="switch"):
        pipeline.run(source)
    text = pipeline.run(source.replace(b"/", b""), "full").text
    assert text == b"G21 G90\nG0 X0 Y0 Z5\nN5 (one)\nG0 X2. ;two\nG54 X5.\nM2\n"


@pytest.mark.parametrize(("block", "count"), [("G10 L2 P2 X30.", 1), ("G92 X1.", 1), ("G55", 0)])
def test_the_certificate_says_what_stays_unset_in_the_control(block: str, count: int) -> None:
    """G10 and G92 outlive a program of GRBL: what runs next finds other zeros."""
    program = f"G21 G90 G54\nG0 X0 Y0 Z0\n{block}\nM30\n".encode()
    said = gx.Pipeline.parse("offsets", "grbl").run(program).certificate.not_checked
    found = [int(line.rpartition(" ")[2]) for line in said if line.startswith("zeros that codes")]
    assert found == [count][: bool(count)]

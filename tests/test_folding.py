"""Subprograms and loops in what is written: what is said of it, and what the proof finds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import gcxform as gx
from gcxform.emit.folding import Folded
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.pipeline.structure import Structure
from gcxform.syntax.source import Source
from gcxform.testing.cases import read_case, run_case

ROOT = Path(__file__).parents[1] / "corpus" / "structure"
CASES = sorted(ROOT.glob("*.txt"))
START = dict.fromkeys("XYZ", 0.0)
PROGRAM = b"""o100 sub
G1 X#1 F100
o100 endsub
o200 sub
G91 X1
G90
o200 endsub
G21 G90 G0 X0 Y0 Z0
o100 call [1]
o200 call
o200 call
o1 if [0]
Y9
o1 endif
#100=5
M2
"""
WRITTEN = b"""o100 sub
G1 X#1 F100
o100 endsub
o200 sub
G91 X1
G90
o200 endsub
G21 G90 G0 X0 Y0 Z0
o100 call [1]
G90 X2.
G90
G90 X3.
G90
o1 if [0]
Y9
o1 endif
#100=5
M2
"""


def absolute(**options: object) -> gx.Pipeline:
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    return replace(pipeline, reading=replace(pipeline.reading, start=START), **options)


def test_what_is_said_of_a_program_that_keeps_its_structure() -> None:
    done = absolute().run(PROGRAM)
    assert done.text == WRITTEN
    said = done.certificate
    assert said.written_out == ["O200, lines 4 to 7: line 5 became 'G90 X2.' and 'G90 X3.'"]
    lines = [1, 2, 3, 4, 5, 6, 7, 8, 9, 5, 6, 5, 6, 12, 13, 14, 15, 16]
    assert [line + 1 for line in done.source_map] == lines
    assert (said.source["lines"], said.output["lines"]) == (16, 18)
    assert said.growth["ratio"] == pytest.approx(18 / 16)


def test_a_file_beside_that_is_written_out_names_its_line(tmp_path: Path) -> None:
    (tmp_path / "O200.nc").write_bytes(b"O200\nG91 G1 X1. F100.\nG90\nM99\n")
    main = tmp_path / "main.nc"
    main.write_bytes(b"%\nO1\nG21 G90 G94 G17 G54\nG0 X0. Y0. Z5.\nM98 P200\nM30\n%\n")
    (why,) = gx.Pipeline.parse("absolute", "fanuc").run(main).certificate.written_out
    assert "line 2 of" in why
    assert "O200.nc became 'G90 G1 X1. F100.'" in why


def test_both_files_are_counted_as_they_stand() -> None:
    held = absolute().run(PROGRAM).certificate.inventory
    for kind, (source, output) in {
        "motions": (4, 6),
        "definitions": (2, 2),
        "assignments": (1, 1),
    }.items():
        assert (held[kind]["source"], held[kind]["output"]) == (source, output)
        assert source + sum(held[kind]["rules"].values()) == output


def test_all_of_it_can_be_written_out() -> None:
    done = absolute(structure="written-out").run(PROGRAM)
    assert b"sub" not in done.text
    assert b"call" not in done.text
    with pytest.raises(gx.UsageError):
        absolute(structure="some")


@pytest.mark.parametrize("size", [1, 7, 40])
def test_windows_make_no_difference(size: int) -> None:
    parts: list[bytes] = []
    run = Run(absolute(), Source.of_bytes(PROGRAM), "on")
    run.over(Output(parts.append, None), lambda count: None, size)
    assert b"".join(parts) == WRITTEN


@pytest.mark.parametrize("name", [path.stem for path in CASES])
def test_a_case_of_the_corpus(name: str, tmp_path: Path) -> None:
    """As `test_corpus.py` does; for faults it is quicker here."""
    run_case(read_case(ROOT / f"{name}.txt"), tmp_path)


FAULTS: dict[str, Callable[[bytes], bytes]] = {
    "a number": lambda text: text.replace(b"G90 X2.", b"G90 X2.5"),
    "a value of a call": lambda text: text.replace(b"call [1]", b"call [1.5]"),
    "a call too many": lambda text: text.replace(b"call [1]\n", b"call [1]\no100 call [1]\n"),
    "a mode": lambda text: text.replace(b"G90\nG90 X3.", b"G90 X3."),
    "an assignment": lambda text: text.replace(b"#100=5", b"#100=6"),
    "no assignment": lambda text: text.replace(b"#100=5\n", b""),
    "what is not executed": lambda text: text.replace(b"Y9\n", b""),
    "no definition": lambda text: text.replace(WRITTEN[: WRITTEN.index(b"G21")], b""),
    "a definition that nothing calls": lambda text: text.replace(
        WRITTEN[33 : WRITTEN.index(b"G21")], b""
    ),
    "a condition": lambda text: text.replace(b"[0]", b"[1]"),
}


@pytest.mark.parametrize("fault", FAULTS.values(), ids=FAULTS)
def test_the_proof_executes_what_was_written(
    fault: Callable[[bytes], bytes], monkeypatch: pytest.MonkeyPatch
) -> None:
    right = Structure.fold

    def wrong(self: Structure) -> Folded | None:
        folded = right(self)
        assert folded is not None
        assert folded.text == WRITTEN
        return replace(folded, text=fault(folded.text))

    monkeypatch.setattr(Structure, "fold", wrong)
    with pytest.raises(gx.VerificationError) as caught:
        absolute().run(PROGRAM)
    assert [each.code for each in caught.value.diagnostics] == ["GX601"]

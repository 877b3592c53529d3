"""Subprograms of O-words by themselves, held to LinuxCNC: a caller that gives the arguments said.

What is written without a compensation moves as what was read. Of what is compensated the tool,
errors included, is where it was meant to be, and the caller finds its axes and modes.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from oracles import rs274
from seeds_kit import some

import gcxform as gx

needs_rs274 = pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")

PIPELINE = """
format = 1
[input]
dialect = "linuxcnc"
[entry]
modes = "{modes} G21 G94 G17 G54 G49 G40"
start = {{ X = 100.0, Y = 200.0, Z = 50.0 }}
feed = 100.0
parameters = {{ {values} }}
[[pass]]
use = "{use}"
"""
MODEL = 'format = 1\nkind = "skew"\n[squareness]\nC0Y = 1e-4\nA0Z = 1e-4\n'
COMPENSATED = 'volumetric"\nmodel = "model.toml"\npart-origin = [0.0, 0.0, 0.0]\n#"'
START = "G21 G94 G17 G54 G49 G40 F100 G90\nG0 X100 Y200 Z50\n"
NEAR = 2e-3  # mm: commands of four decimals, and what a cut may leave
Point = tuple[float, ...]


def written(text: str, modes: str, values: list[float], use: str, folder: Path) -> gx.Result:
    """Return what is written for a subprogram that is called with some values from START."""
    (folder / "model.toml").write_text(MODEL)
    said = ", ".join(f'"{number}" = {value}' for number, value in enumerate(values, 1))
    (folder / "pipeline.toml").write_text(PIPELINE.format(modes=modes, values=said, use=use))
    return gx.Pipeline.load(folder / "pipeline.toml").run(text.encode())


def executed(text: str, modes: str, values: list[float]) -> tuple[list[tuple[str, Point]], Point]:
    """Return what LinuxCNC does in a call, and where a step of the caller behind it leads."""
    given = " ".join(f"[{value}]" for value in values)
    caller = f"{START}{modes}\no<part> call {given}\nG0 X1\nM2\n"
    moves = rs274.run(caller.encode(), {"part.ngc": text.encode()}).moves
    ends = [(each.kind, tuple(each.end[axis] for axis in "XYZ")) for each in moves]
    return ends[1:-1], ends[-1][1]


def reached(command: Point) -> Point:
    """Return where the machine goes: squareness between X and Y, and between Y and Z."""
    x, y, z = command
    return x - 1e-4 * y, y - 1e-4 * z, z


def near(one: Point, other: Point) -> bool:
    return all(abs(a - b) < NEAR for a, b in zip(one, other, strict=True))


def drawn(seed: int) -> tuple[str, str, list[float]]:
    """Return a subprogram, the mode of its call, and values for its arguments."""
    draw = random.Random(seed)
    mode = draw.choice(["G90", "G91"])
    values = [draw.randint(1, 40) / 8 for _ in range(4)]
    base = {"X": "100 + ", "Y": "200 + ", "Z": "50 + "} if mode == "G90" else {}

    def move(code: str = "") -> str:
        axis, other = draw.choice(["XY", "YX", "XZ"])
        word = f"{axis}[{base.get(axis, '')}#{draw.randint(1, 4)} * {draw.randint(1, 3)}]"
        more = f" {other}[{base.get(other, '')}#<n>]" if draw.random() < 0.5 else ""
        return f"{code or draw.choice(['G0', 'G1', ''])} {word}{more}".strip()

    loop = ["#20 = 0", "o1 while [#20 LT 2]", move(), move("G1"), "#20 = [#20 + 1]", "o1 endwhile"]
    branch = ["o2 if [#2 GT #3]", move(), "o2 else", move(), "o2 endif"]
    parts = [[move()], loop, branch, ["G4 P0.1"], [f"G1 F[#4 * 10] {move('G1')[3:]}"]]
    body = [line for part in draw.sample(parts, draw.randint(1, 5)) for line in part]
    first = [f"#<n> = [#1 + #{draw.randint(1, 4)}]", move("G0")]
    head, tail = draw.choice([([], []), (["(of #1)"], ["M2"]), (["%"], ["%"])])
    lines = [*head, "o<part> sub (what it does)", *first, *body, "o<part> endsub", *tail, ""]
    return "\n".join(lines), mode, values


@needs_rs274
@pytest.mark.parametrize("seed", some(20))
def test_a_caller_that_gives_these_values_moves_the_same(seed: int, tmp_path: Path) -> None:
    text, mode, values = drawn(seed)
    result = written(text, mode, values, "absolute", tmp_path)
    assert not result.certificate.warnings
    (before, stands), (after, found) = (
        executed(each, mode, values) for each in (text, result.text.decode())
    )
    assert [kind for kind, _ in before] == [kind for kind, _ in after]
    assert all(near(a, b) for (_, a), (_, b) in zip(before, after, strict=True))
    assert near(stands, found)


@needs_rs274
@pytest.mark.parametrize("seed", some(20))
def test_the_tool_goes_where_the_call_meant_it_to_go(seed: int, tmp_path: Path) -> None:
    text, mode, values = drawn(seed)
    result = written(text, mode, values, COMPENSATED, tmp_path)
    (before, stands), (after, found) = (
        executed(each, mode, values) for each in (text, result.text.decode())
    )
    assert near(stands, found)
    gone = [reached(command) for _, command in after]
    for _, point in before:
        while gone and not near(gone[0], point):
            gone.pop(0)
        assert gone, f"{point} is not reached"


@pytest.mark.parametrize(
    ("body", "says"),
    [
        ("G0 X[#1 + 1]\no1 if [#1 GT 1]\no<part> call [#1 - 1]\no1 endif", "calls itself"),
        ("G0 X#1\no1 if [#1 GT 1]\no<part> return\no1 endif\nG0 Y#1", "returns from the midst"),
        ("G0 X#1\no1 if [#1 GT 1]\nM2\no1 endif", "ends the program"),
        ("M73\nG0 X#1", "given back by its return"),
        ("G0 X#1\no<stores> call", "stores.ngc, which it calls, has M70 to M73"),
        ("G0 X[#1 + #<_value>]", "returned before"),
        ("G0 X#1\no<part> endsub\no<other> sub\nG0 X1\no<other> endsub", "more than one"),
    ],
)
def test_what_a_call_does_besides_is_refused(body: str, says: str, tmp_path: Path) -> None:
    rest = "" if "other" in body else "o<part> endsub\n"
    text = f"o<part> sub\n{body}\n{rest}"
    (tmp_path / "part.ngc").write_text(text)
    (tmp_path / "stores.ngc").write_text("o<stores> sub\nM73\nG91\nG0 X1\no<stores> endsub\n")
    (tmp_path / "model.toml").write_text(MODEL)
    said = PIPELINE.format(modes="G90", values='"1" = 2.0', use=COMPENSATED)
    (tmp_path / "pipeline.toml").write_text(said)
    with pytest.raises(gx.InputError, match=says) as why:
        gx.Pipeline.load(tmp_path / "pipeline.toml").run(tmp_path / "part.ngc")
    assert why.value.diagnostics[0].code == "GX226"


def test_modes_that_it_asks_for_are_said(tmp_path: Path) -> None:
    """What is not said is no default of the control: G20 may be in force."""
    text = "o<part> sub\no1 if [#<_imperial>]\nM8\no1 endif\nG53 G0 Z0\no<part> endsub\n"
    (tmp_path / "pipeline.toml").write_text(
        PIPELINE.format(modes="G90", values="", use="absolute").replace(" G49", "")
    )
    result = gx.Pipeline.load(tmp_path / "pipeline.toml").run(text.encode())
    assert "its tool-length are not said" in result.certificate.warnings[0].message
    assert result.text == text.encode()


def test_all_arguments_that_are_missing_are_asked_for_at_once(tmp_path: Path) -> None:
    """But for those that the subprogram sets before it reads them."""
    text = "o<part> sub\n#3 = [#2 * 2]\nG0 X#3 Y#1\nG0 X#5\no<part> endsub\n"
    with pytest.raises(gx.InputError) as why:
        written(text, "G90", [1.0], COMPENSATED, tmp_path)
    assert why.value.diagnostics[0].message == "what its call gives as #2, #5 is not said"
    assert 'parameters = { "2" = ..., "5" = ... } in [entry]' in why.value.diagnostics[0].hint

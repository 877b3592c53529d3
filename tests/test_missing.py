"""`gcxform check` says all at once: every cause once, and one block that ends all of them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from cli_kit import call, workplace
from missing_kit import as_toml, filled, pasted

import gcxform as gx
from gcxform.cli.program.missing import Missing, Visit
from gcxform.diagnostics import Diagnostic, Location
from gcxform.machine.file import load_machine
from gcxform.syntax.source import Source

BODIES = {
    "a start in G91": (
        "fanuc",
        "G91 G41 D1 G1 X1. Y1. F99.\nX2.\nG2 X1. Y1. I1.\nG40 G90 G1 X0 Y0 Z5.",
        "",
    ),
    "increments": ("fanuc", "G90 G0 X10 Y10\nG1 X20. F100.\nZ-2", ""),
    "feeds": ("haas", "G90 G0 X10. Y10.\nG1 X20. F100\nY5.", ""),
    "a switch": ("fanuc", "G90 G0 X10. Y10.\n/G1 X20. F100.\nY5.", ""),
    "pecks": (
        "fanuc",
        "G0 Z5. X0 Y0\nG73 X1. Z-9. R2. Q2. F99.\nG83 X2. Q2.\nG80",
        "cycles",
    ),
    "a setting of G52": ("haas", "G90 G0 X1. Y1. Z1.\nG52 X1. Y0.\nG0 X2.\nG52 X0 Y0", ""),
    "a code of the maker": ("linuxcnc", "G90 G0 X1. Y1. Z1.\nM120\nG90 G0 X2. Y2. Z2.", ""),
    "a parameter": (
        "linuxcnc",
        "G90 G0 X1. Y0. Z1.\n#1=[#<depth>+1]\nG1 Z#1 F100.\nG1 X8. F9.",
        "",
    ),
    "two work offsets": ("fanuc", "G90 G0 X1. Y1. Z1.\nG55 X1. Y1. Z1.\nG1 X2. F99.", "offsets"),
    "all of it": (
        "fanuc",
        "G91 G0 X10 Y10\n/M8\nG90 G43 H3 Z50.\nG73 X1. Y1. Z-9. R2. Q2. F99.\nG80\nG55 X1. Z2. Y1.",
        "",
    ),
}


def check(here: Path, dialect: str, chain: str, *more: str) -> tuple[int, str, str]:
    found = call("check", "-f", dialect, "-x", chain, *more, str(here / "p.nc"))
    return found.exit_code, found.stdout, found.stderr


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    return workplace(tmp_path, monkeypatch)


@pytest.mark.parametrize("name", list(BODIES))
def test_what_is_missing_is_all_that_is_missing(here: Path, name: str) -> None:
    dialect, body, chain = BODIES[name]
    (here / "p.nc").write_text(f"%\nG21 G17 G40 G80 G94 G54\n{body}\nM30\n%\n")
    chain = chain or "absolute"
    code, out, _ = check(here, dialect, chain)
    assert code == 1
    said = filled(pasted(out))
    pipeline = {"format": 1, "input": {"dialect": dialect, **said.pop("input", {})}}
    (here / "m.toml").write_text(as_toml({"format": 1, **said}))
    text = as_toml(pipeline) + "".join(f'[[pass]]\nuse = "{each}"\n' for each in chain.split(" | "))
    (here / "full.toml").write_text(text)
    found = call("check", "-p", "full.toml", "-m", "m.toml", "p.nc")
    assert (found.exit_code, found.stderr) == (0, "")
    assert call("run", "-q", "-p", "full.toml", "-m", "m.toml", "p.nc").exit_code == 0


def test_one_unknown_start_is_one_finding_with_twelve_places(here: Path) -> None:
    body = "".join(f"G1 X{n}. F100.\n" for n in range(1, 13))
    (here / "p.nc").write_text(f"O0001\nG21 G91\n{body}M30\n")
    _, out, err = check(here, "fanuc", "absolute", "-t", "haas")
    assert "1 finding at 12 lines" in out
    assert err.count("error[") == 1
    assert "also at lines 4, 5, 6, 7, 8 (6 more)" in err
    assert pasted(out) == {"input": {"start": {"X": "?"}}}
    assert "--start 'X=?'" in out


def test_what_a_setting_does_not_end_is_not_asked_for(here: Path) -> None:
    (here / "p.nc").write_text("G90 G0 X0 Y0 Z0\nM120\nG91 X1.\nM2\n")
    (here / "m.toml").write_text('format = 1\n[control]\nuser-codes = "keep"\n')
    code, out, err = check(here, "linuxcnc", "", "-m", "m.toml", "-t", "grbl")
    assert code == 1
    assert "GX207" in err
    assert "start" not in out


def test_behind_a_block_that_nothing_helps_the_rest_is_found(here: Path) -> None:
    (here / "p.nc").write_text("O0001\nG90 G0 X0 Y0 Z0\nG27 X1.\nG1 X10 F100.\n/X5.\nM30\n")
    _, out, err = check(here, "fanuc", "absolute")
    assert re.findall(r"GX\d+", err) == ["GX210", "GX211", "GX205"]
    assert pasted(out)["input"] == {"increment": "?", "block-delete": "?"}


def test_what_a_block_left_out_may_have_said_is_not_asked_for(here: Path) -> None:
    (here / "p.nc").write_text("O0001\nG90 G27 X0 Y0 Z0\nG91 G1 X1. F9.\nM30\n")
    _, out, err = check(here, "fanuc", "absolute")
    assert re.findall(r"GX\d+", err) == ["GX210"]
    assert "start" not in out


def test_of_two_values_on_trial_the_one_with_which_least_is_found_counts(here: Path) -> None:
    text = "O0001\nG90 G0 X0 Y0\nG43 H1 Z100\nG81 X9. Y2. Z-20. R2. F20.\nG80\nM30\n"
    (here / "p.nc").write_text(text)
    _, out, err = check(here, "fanuc", "absolute")
    assert "1 finding" in out
    assert "GX215" not in err  # 0.1 mm, below R2., in IS-B


def test_m_codes_that_are_asked_about_are_named(here: Path) -> None:
    text = "O0001\nG21 G94 G90 G0 X0. Y0.\nM20\nG91 X1.\nM21\nG91 X1.\nM22\nX1.\nM30\n"
    (here / "p.nc").write_text(text)
    _, out, _ = check(here, "fanuc", "absolute")
    assert "and 1 more (M21, M22)" in out


def test_what_is_open_is_refused_with_its_place_and_only_where_it_is_needed(here: Path) -> None:
    file = 'format = 1\n[input]\ndialect = "fanuc"\nincrement = "?"\n[[pass]]\nuse = "absolute"\n'
    (here / "open.toml").write_text(file)
    (here / "m.toml").write_text('format = 1\n[control]\npeck-return = "?"\n')
    (here / "p.nc").write_text("O0001\nG90 G0 X10 Y0 Z0\nM30\n")
    found = call("run", "-p", "open.toml", "-m", "m.toml", "p.nc")
    assert found.exit_code == 3
    assert 'still "?" at open.toml:4:1' in found.stderr
    assert "gcxform check" in found.stderr
    found = call("check", "-p", "open.toml", "-m", "m.toml", "p.nc")
    assert "fill in   open.toml:4:1, asked by line 2" in found.stdout
    assert "[input]" not in found.stdout
    (here / "p.nc").write_text("O0001\nG90 G0 X10. Y0 Z0\nM30\n")
    assert call("run", "-q", "-p", "open.toml", "-m", "m.toml", "p.nc").exit_code == 0


def test_half_a_tool_is_none(here: Path) -> None:
    text = """format = 1
[tool.3]
radius = 5.0
length = "?"
[tool.4]
length = 90.0
[work-offset.G55]
X = 1.0
Z = "?"
[home.G28]
X = "?"
Z = 0.0
"""
    (here / "m.toml").write_text(text)
    machine = load_machine(here / "m.toml")
    assert list(machine.tools) == [4]
    assert machine.work_offsets == {}
    assert machine.homes == {"G28": {"Z": 0.0}}
    assert {keys: place.line for keys, place in machine.open.items()} == {
        ("tool", "3", "length"): 4,
        ("work-offset", "G55", "Z"): 9,
        ("home", "G28", "X"): 11,
    }


def visit(*rounds: list[Diagnostic]) -> Missing:
    """Return what a visit makes of findings, those of the last round again and again."""
    left = iter([*rounds[1:], *[rounds[-1]] * 30])
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    source = Source.of_bytes(b"G91 G0 X1\nX2\nX3\nM2\n")
    return Visit(pipeline, source, lambda *_: next(left)).run(rounds[0])


def finding(code: str, line: int, hint: str = "") -> Diagnostic:
    return Diagnostic(code, f"as {code} says", Location("-", line), hint=hint)


def test_a_loop_without_an_end_is_not_left_out() -> None:
    """The loop around it would run to the limit of steps."""
    assert visit([finding("GX224", 2)]).left_out == set()
    assert visit([finding("GX215", 2)]).left_out == {2}


def test_a_value_that_ends_nothing_is_not_asked_for() -> None:
    asks = finding("GX207", 1, "say start = { X = ... } in [input]")
    found = visit([asks], [asks])
    assert not found.asked()
    assert [cause.told().code for cause in found.causes.values()] == ["GX207"]


def test_behind_a_block_that_is_left_out_only_blocks_by_themselves_are_judged() -> None:
    wrong, lost, unknown = finding("GX201", 1), finding("GX208", 2), finding("GX202", 3)
    found = visit([wrong], [lost, unknown])
    assert [each.code for each in found.told()] == ["GX201", "GX202"]

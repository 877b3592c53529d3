"""Programs that are executed: lines, hashes, values, and what is left as it is."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call

import gcxform as gx
from gcxform.flow.constructs import Construct
from gcxform.flow.listing import Listing
from gcxform.flow.lookup import Folders
from gcxform.flow.loops_alike import LoopsAlike
from gcxform.flow.owords import OWords
from gcxform.flow.run_state import NAMED
from gcxform.plugin.registry import default_registry
from gcxform.system.limits import in_force

LOOP = b"G21 G90 G0 X0 Y0 Z0\no1 repeat [2]\nG91 X1\no1 endrepeat\nM2\n"
FANUC = b"O1\nG21 G90 G94 G0 X0. Y0. Z0.\nM98 P2\nM30\nO2\n#100=1/3\nX[#100]\nM99\n"


def absolute(dialect: str) -> gx.Pipeline:
    return gx.Pipeline.parse("absolute", dialect)


def test_the_certificate_and_the_map_name_lines_of_the_file() -> None:
    done = absolute("linuxcnc").run(LOOP)
    assert done.source_map == [0, 2, 2, 4]
    assert done.certificate.source["sha256"] == hashlib.sha256(LOOP).hexdigest()
    assert done.certificate.verified


def test_a_finding_names_the_line_of_the_file() -> None:
    program = LOOP.replace(b"G91 X1", b"G2 X1")
    for run in (absolute("linuxcnc").run, lambda text: gx.read(text, "linuxcnc").path):
        with pytest.raises(gx.InputError) as error:
            run(program)
        assert error.value.diagnostics[0].where.line == 3


def test_what_is_only_copied_is_not_executed() -> None:
    assert b"repeat[2]" in gx.Pipeline.parse("strip", "linuxcnc").run(LOOP).text


@pytest.mark.parametrize(
    "text",
    [b"G0 X1 (o1 repeat [2])\nM2\nafter\n", b"G0 X1 ; M98 P1\nM2\n", b"G0 X1 ; o1 sub\nM2\n"],
)
def test_a_comment_about_calls_calls_nothing(text: bytes) -> None:
    assert gx.read(text, "linuxcnc").executed == text
    done = absolute("linuxcnc").run(text)
    assert done.text == text
    assert not any("calls" in what for what in done.certificate.not_checked)


@pytest.mark.parametrize(
    "text",
    [
        b"m 098 p1\nM2\nO1\nG0 X1\nM99\n",
        b"G21 G90\nM70\nG91\nM72\nG0X1\nX1\nM2\n",
        b"n5 o1 REPEAT [1]\nG0 X1\no1 endrepeat\nM2\n",
        b"#1=0\ng #1 X1\nM2\n",
        b"g [0] X1\nM2\n",
        b"G0 X1\nY# 5420\nM2\n",
        b"G0 @ 1 ^0\nM2\n",
    ],
)
def test_flow_is_seen_however_it_is_written(text: bytes) -> None:
    start = dict.fromkeys("XYZ", 0.0)
    program = gx.read(text, "linuxcnc", start=start)
    assert program.executed != text
    assert program.path.end[-1, 0] == 1.0


def test_the_certificate_says_that_blocks_were_executed() -> None:
    done = absolute("linuxcnc").run(LOOP)
    assert any("calls and loops" in what for what in done.certificate.not_checked)


def test_nothing_is_executed_behind_the_second_percent_sign() -> None:
    text = b"%\no1 repeat [2]\nG0 X1\no1 endrepeat\n%\no2 while [1]\no2 endwhile\n"
    assert gx.read(text, "linuxcnc").executed == b"%\nG0 X1\nG0 X1\n%\n"


def test_a_copy_of_executed_blocks_compares_equal() -> None:
    done = absolute("linuxcnc").run(LOOP)
    found = gx.compare(gx.read(LOOP, "linuxcnc"), gx.read(done.text, "linuxcnc"))
    assert found.same
    other = done.text.replace(b"X2.", b"X2.5")
    found = gx.compare(gx.read(LOOP, "linuxcnc"), gx.read(other, "linuxcnc"))
    assert (found.same, found.parted) == (False, None)
    assert found.deviation == pytest.approx(0.5)


@pytest.mark.parametrize(("increment", "x"), [(0.001, 0.333), (0.01, 0.33), (1 / 3, 0.33333333)])
def test_a_computed_distance_is_on_the_increment(increment: float, x: float) -> None:
    path = gx.read(FANUC, "fanuc", increment=increment).path
    assert np.isclose(path.end[-1, 0], x, atol=1e-12)


def test_a_computed_distance_is_lost_without_the_increment() -> None:
    assert np.isnan(gx.read(FANUC, "fanuc").path.end[-1, 0])


def test_long_loops_are_executed() -> None:
    text = b"#1=0\no1 while [#1 lt 5000]\nG1 X[#1/8] F100\n#1=[#1+1]\no1 endwhile\nM2\n"
    path = gx.read(text, "linuxcnc", start={"X": 0.0, "Y": 0.0, "Z": 0.0}).path
    assert len(path) == 5000
    assert np.array_equal(path.end[:, 0], np.arange(5000) / 8)


def test_a_loop_that_waits_for_its_parameter_is_stopped() -> None:
    text = b"#1=0\no1 while [1]\n#1=[#1+1]\no1 endwhile\nM2\n"
    with in_force(gx.Limits(steps=50_000)), pytest.raises(gx.InputError, match="GX224"):
        _ = gx.read(text, "linuxcnc").path


def test_check_and_info_execute(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("part.nc").write_bytes(LOOP)
    assert call("check", "-f", "linuxcnc", "part.nc").exit_code == 0
    assert "X 0 ... 2" in call("info", "-f", "linuxcnc", "part.nc").stdout


def test_a_line_that_the_control_takes_together_with_the_next_is_refused() -> None:
    with pytest.raises(gx.InputError, match="GX102"):
        _ = gx.read(LOOP.replace(b"[2]\n", b"[2]\r"), "linuxcnc").executed


def test_only_line_ends_part_lines_where_modes_are_stored() -> None:
    """A byte that is a line end to Python alone, as in a comment in UTF-8."""
    text = b"M70\n(\xc3\x85) G91\nM72\nM2\n"
    assert gx.read(text, "linuxcnc").executed == b"(\xc3\x85) G91\nG90\nM2\n"


def test_an_error_names_few_of_many_calls() -> None:
    text = b"O1\nG21 G90\nM97 P100\nM30\nN100 M97 P100\nM99\n"
    with pytest.raises(gx.InputError, match="GX224") as error:
        _ = gx.read(text, "haas").executed
    assert error.value.diagnostics[0].context.count("M97") == NAMED


INSIDE_EACH_OTHER = b"""G21 G90 G17 G94 F100
G0 X0 Y0 Z5
o1 if [#5399 GT 1]
G1 X5
o2 if [#5399 GT 2]
G1 Y5
o2 endif
S100
o1 endif
G1 Z1
M2
"""


@pytest.mark.parametrize("shapes", [1, 2, 3, 20_000])
def test_a_table_that_has_grown_large_is_not_begun_anew_within_a_branch(monkeypatch, shapes):
    """What the outer branch may have moved is told by lines that were read before the inner one."""
    monkeypatch.setattr("gcxform.modal.reader.SHAPES_AT_MOST", shapes)
    path = gx.read(INSIDE_EACH_OTHER, "linuxcnc").path
    np.testing.assert_array_equal(path.end[-1], [np.nan, np.nan, 1.0])


TOUCHES = {  # loops that the machine ends; whether they begin is not known of the first kind alone
    "what the probe tells": "#5070=1\no{n} while [#5070 NE 0]\nG38.3 x-{n}\no{n} endwhile\n",
    "where it stands": "G0 X{n}\no{n} while [#5420 LT 90]\nG38.3 X99\no{n} endwhile\n",
    "not at all": "G0 X99\no{n} while [#5420 LT 90]\nG38.3 X99\no{n} endwhile\n",
}


@pytest.mark.parametrize("between", ["", "not at all"])
@pytest.mark.parametrize("name", TOUCHES)
def test_loops_that_are_written_alike_are_found_at_once(monkeypatch, name, between):
    """And are what each would be found to be; one that does not begin is left out as ever."""
    parts = [TOUCHES[each] for each in (name, between) if each]
    loops = "".join(part.format(n=n) for n in range(10, 22) for part in parts[n % len(parts) :][:1])
    program = f"G21 G90 G94 G17 F100\nG0 X0 Y0 Z5\n{loops}G0 X0 Y0 Z5\nM2\n".encode()
    runs = []
    run = OWords.run
    monkeypatch.setattr(OWords, "run", lambda self: (runs.append(1), run(self))[1])
    found = absolute("linuxcnc").run(program).text
    assert len(runs) <= 8
    monkeypatch.setattr(LoopsAlike, "others", lambda *_: frozenset())
    assert absolute("linuxcnc").run(program).text == found


@pytest.mark.parametrize(
    "inside", ["x-3", "G1 X3", "G38.3 X#1", "#1=2\nG38.3 X3", "(DEBUG, a)", "M98 P1", "M70", ""]
)
@pytest.mark.parametrize("probe", ["G38.3 X5\n", "G1 X5\n"])
def test_loops_that_may_be_others_are_found_one_by_one(inside, probe):
    lines = f"o7 while [#5070 NE 0]\n{probe}{inside}\no7 endwhile\n"
    dialect = default_registry().dialect("linuxcnc")
    folders = Folders([], dialect.flow_rule.lookup, ".ngc")
    listing = Listing((lines + "M2\n").encode(), dialect, "p", folders)
    loop = Construct("while", [0, lines.count("\n") - 1])
    alike = bool(LoopsAlike(listing, [loop]).others(0))
    assert alike == ("38" in probe and inside in ("G1 X3", ""))

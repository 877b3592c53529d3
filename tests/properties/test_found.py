"""Small programs on which a law was once broken."""

from pathlib import Path

import pytest

import gcxform as gx
from gcxform.plugin.registry import default_registry


def run(chain: str, dialect: str, program: str) -> str:
    """Return what a chain makes of a program."""
    return gx.Pipeline.parse(chain, dialect).run(program.encode(), verify="full").text.decode()


def cross(source: str, target: str, program: str) -> str:
    """Return a program in another dialect."""
    find = default_registry().dialect
    return (
        gx.Pipeline(find(source), find(target)).run(program.encode(), verify="full").text.decode()
    )


@pytest.mark.parametrize("loses", ["M6", "G55", "M123"])
def test_a_line_from_a_lost_position_is_not_cut(loses: str) -> None:
    program = f"G90 G0 X0. Y0. Z0.\n{loses}\nG1 X10. Y10. Z5. F100.\n"
    assert run("segment chord-error=2um max-length=10mm", "fanuc", program) == program


@pytest.mark.parametrize("loses", ["M6", "G55"])
def test_an_arc_from_a_lost_position_is_refused(loses: str) -> None:
    program = f"G90 G0 X0. Y0. Z0.\n{loses}\nG2 X10. Y10. Z5. R8. F100.\n"
    with pytest.raises(gx.InputError, match="where it starts is not known"):
        run("segment chord-error=200um", "fanuc", program)


def test_a_line_with_one_unknown_axis_is_not_cut() -> None:
    program = "G90 G1 X0. Y0. F100.\nX10. Z-5.\n"
    assert run("segment chord-error=2um max-length=5mm", "fanuc", program) == program


def test_a_helix_from_an_unknown_height_is_refused() -> None:
    with pytest.raises(gx.InputError, match="not known"):
        run("absolute", "fanuc", "G90 G17 G1 X0. Y0. F100.\nG2 X10. Y0. Z-5. I5. J0.\n")


def test_rotary_axes_along_a_compensated_arc_are_within_rounding() -> None:
    model = Path(__file__).parents[2] / "examples" / "lddm" / "model.toml"
    program = "G0 X100. Y100. Z100. A0.\nG2 X102. Y100. I1. J0. A3600. F100.\n"
    run(f"volumetric model={model} part-origin=0,0,0", "fanuc", program)


def test_a_fanuc_feed_in_inverse_time_keeps_its_point() -> None:
    program = "G90 G20 G93 G17 G0 X0. Y0. Z0.\nG2 X2. I1. J0. F2.\n"
    assert "F252." in run("segment chord-error=2um", "fanuc", program)


def test_blanks_do_not_count_in_a_grbl_block() -> None:
    program = "G0 X-139.00 Y113.4 Z-20\nG1" + " " * 70 + "X1 Y1 Z1 F100\n"
    run("segment max-length=5mm chord-error=1um", "grbl", program)


@pytest.mark.parametrize("chain", ["renumber", "strip"])
def test_text_passes_leave_a_refused_line(chain: str) -> None:
    text = run(chain, "linuxcnc", "A0A\nG1 X10 Y-2.5 F100\n")
    assert "X10" in text
    assert "Y-2.5" in text
    assert "F100" in text


@pytest.mark.parametrize("target", ["fanuc", "grbl"])
def test_a_mode_the_target_has_not_is_left_out_or_refused(target: str) -> None:
    code, said = ("G91.1" if target == "fanuc" else "G90.1"), ""
    try:
        said = cross("linuxcnc", target, f"{code}\n")
    except gx.VerificationError as error:
        pytest.fail(str(error))
    except gx.InputError:
        pass
    assert code not in said


def test_the_last_percent_sign_does_not_reach_grbl() -> None:
    assert "%" not in cross("fanuc", "grbl", "%\nO1\nG21 G90\nM30\n%\n")


def test_a_feed_is_stated_again_where_the_target_forgets_it() -> None:
    program = "G21 G90 G17 G94\nG0 X0 Y0 Z0\nG1 X1 F100\nG20\nG1 X1\n"
    assert cross("grbl", "fanuc", program).count("F") == 2


def test_a_feed_gets_its_point_on_the_way_to_a_fanuc() -> None:
    assert "F390." in cross("grbl", "fanuc", "G20\nF390\n")


def test_a_full_circle_in_inches_can_be_said_in_millimetres() -> None:
    program = "G20\nX-3\nY-3\nG2 X-2.9208 Y-3.1662 I.1369 J-.0367 F26.1\nX-2.9208 I.4514\n"
    run("metric", "grbl", program)


def test_circles_after_a_change_of_units_stay_circles() -> None:
    program = "G20 G90 G17\nG0 X0.1 Y0.8637 Z0\nG2 I.1281 F10\n"
    circle = run("metric", "linuxcnc", program).splitlines()[2]
    assert circle == "G2 X2.54 Y21.938 I3.2537 J0. F254"


def test_the_feed_of_rotary_axes_is_in_degrees_in_every_unit() -> None:
    text = run("metric", "linuxcnc", "G20 G90\nG1 X2 Y0 Z0 B0 F10\nB90\nX3\n")
    assert text.splitlines()[2:] == ["B90. F10", "X76.2 F254"]


def test_linuxcnc_reads_a_feed_before_the_units_of_its_block() -> None:
    program = "G20 G1 X1.0514 F1177.6\n"
    assert run("absolute", "linuxcnc", program) == program


@pytest.mark.parametrize("block", ["G43.1 Z1", "G92 X1", "G10 L20 P1 X1", "G52 X1"])
def test_a_length_that_a_code_takes_is_not_left_in_inches(block: str) -> None:
    with pytest.raises(gx.InputError, match=r"in another unit|are in inches"):
        run("metric", "linuxcnc", f"G20 G90\nG0 X0 Y0 Z0\n{block}\nG0 X2\n")


def test_a_return_without_a_length_is_the_same_in_every_unit() -> None:
    program = "G20 G90\nG0 X1. Y0. Z0.\nG91 G28 Z0.\nG90 G0 X2.\n"
    assert run("metric", "fanuc", program).splitlines()[2] == "G91 G28 Z0."


def test_a_length_in_diameters_does_not_become_a_radius() -> None:
    with pytest.raises(gx.InputError, match=r"in another unit|are in inches"):
        run("offsets", "linuxcnc", "G21 G90\nG7\nG43.1 X10\nG0 X1\n")


def test_a_control_that_goes_on_after_the_end_is_in_its_first_offset() -> None:
    path = gx.read(b"G21\nG10 L20 P2 X-10\nG55 G0 X1\nM2\nG0 X1\n", "grbl", start={"X": 0.0}).path
    assert path.end[:, 0].tolist() == [11.0, 1.0]


def test_another_unit_under_a_tool_length_is_refused() -> None:
    with pytest.raises(gx.InputError, match="another unit under a tool length"):
        run("absolute", "linuxcnc", "G21 G43.1 Z5\nG20 G0 Z1\n")


def test_two_offsets_of_one_code_are_two() -> None:
    offsets = {"G54": {"X": 0.0}, "G54.1 P1": {"X": 10.0}, "G54.1 P2": {"X": 20.0}}
    program = b"G54 G0 X0. Y0.\nG54.1 P1 X0.\nG54.1 P2 X0.\nG54 X0.\n"
    path = gx.read(program, "fanuc", work_offsets=offsets).path
    assert path.end[:, 0].tolist() == [0.0, 10.0, 20.0, 0.0]

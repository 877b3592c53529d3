"""`gcxform calibrate circles`: tables, foreign ones, models that `volumetric` reads, the loop."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from circle_kit import CENTRE, FEED, ROUGH, both, errors, read_tests, run, written
from cli_kit import call
from picture_kit import drawn

from gcxform.calibrate.circles.causes import SetUp
from gcxform.calibrate.circles.file import circles_csv
from gcxform.calibrate.csv_text import OWN, Layout
from gcxform.diagnostics import InputError
from gcxform.errormodel.model_file import load_model
from gcxform.simulate.drives import Drives

SKEW = """format = 1
kind = "skew"
scale = [4e-5, -2e-5, 1e-5]
[squareness]
C0Y = -5e-5
A0Z = 3e-5
B0Z = 2e-5
"""
BALLBAR = ("simulate", "ballbar", "--model", "true.toml", "--outside", "extrapolate")
PLACE = ("--radius", "100", "--centre", "300,200,100")
DRIVES = (
    *("--lag", "203.3333um,200um,200um", "--backlash", "6um,-3um,2um", "--play", "2um,0,0"),
    *("--cyclic", "1um,0,0", "--pivot", "3um,-2um,0", "--stick", "1.2,0,0"),
)
READ = ("--samples", "360", "--readings", "read.csv")
SAID = {"plane": "XY", "radius": 100.0}
HEAD = "plane,sense,radius [mm],feed [mm/min],angle [deg],reading [um]\n"


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def rows(plane="XY", sense=1, degrees=ROUGH, **machine):
    found = run(plane, sense, degrees, **machine)
    return zip(found.degrees.tolist(), (1e3 * found.readings).tolist(), strict=True)


def table(plane="XY", senses=(1, -1), **machine):
    """Return a plain table; cw runs fall."""
    said = [HEAD]
    for sense in senses:
        degrees = ROUGH[::sense]
        word = "ccw" if sense > 0 else "cw"
        pairs = rows(plane, sense, degrees, **machine)
        said += [f"{plane},{word},100,1000,{angle},{value:.6f}\n" for angle, value in pairs]
    return "".join(said)


def refusal(text, layout=OWN, **given):
    with pytest.raises(InputError) as error:
        read_tests(text, layout, **given)
    return str(error.value)


# --- the loop ---


def test_what_a_machine_has_comes_out_of_what_its_ballbar_reads(here):
    """The model, and all that its drives do: within 3.5 of the stated deviations."""
    written("true.toml", SKEW)
    done = call(*BALLBAR, *PLACE, *DRIVES, "--noise", "0.5um", *READ)
    assert done.exit_code == 0, done.stderr
    words = ("--pitch", "10", "--scale-from", "X", "--noise", "0.5um")
    done = call("calibrate", "circles", *words, "-o", "m.toml", "--report", "r.json", "read.csv")
    assert done.exit_code == 0, done.stderr
    whole = json.loads(Path("r.json").read_text())
    told = {**whole["squareness"], **whole["scales"]}
    for name, value in {"C0Y": -5e-5, "A0Z": 3e-5, "B0Z": 2e-5, "Y": -6e-5, "Z": -3e-5}.items():
        assert told[name]["value"] == pytest.approx(value, abs=3.5 * told[name]["sd"]), name
        assert told[name]["sd"] < 1e-6
    xy = whole["tests"][0]
    wanted = {"servo mismatch": 0.2, "backlash X at +X": 6.0, "backlash Y at -Y": -3.0}
    wanted |= {"lateral play X": 2.0, "centre 1": 3.0, "centre 2": -2.0}
    wanted |= {"scale mismatch": 60.0, "squareness": -50.0, "straightness Y": 0.0}
    for name, value in wanted.items():
        cause = xy["causes"][name]
        assert cause["value"] == pytest.approx(value, abs=3.5 * cause["sd"]), name
    cyclic = [xy["causes"][f"cyclic error X {part}"]["value"] for part in ("cosine", "sine")]
    assert np.hypot(*cyclic) == pytest.approx(1.0, abs=0.15)
    seen = {spike["end"] for spike in xy["spikes"] if spike["seen"]}
    assert seen == {"+X", "-X"}
    model, places = load_model(Path("m.toml")), np.add(CENTRE, [[60, -70, 80], [-90, 20, 5.0]])
    true = {"EXY": 5e-5, "EYZ": -3e-5, "EXZ": 2e-5, "EYY": -6e-5, "EZZ": -3e-5}
    assert model.error(places) == pytest.approx(errors(true, places - CENTRE), abs=5e-4)


def test_a_program_is_compensated_by_the_model(here):
    written("true.toml", SKEW)
    call(*BALLBAR, *PLACE, *READ)
    call("calibrate", "circles", "--scale-from", "Y", "-o", "found.toml", "read.csv")
    text = "G21 G90 G17 G94 F500\nG0 X260. Y160. Z100.\nG1 X340.\nY240.\nX260.\nY160.\nM30\n"
    written("part.nc", text)
    done = call(
        *("run", "-f", "fanuc", "part.nc", "-o", "out.nc"),
        *("-x", "absolute | volumetric model=found.toml part-origin=0,0,0 tolerance=1um"),
    )
    assert done.exit_code == 0, done.stderr
    # 60 ppm of X, and 50 urad, are 2.4 and 2 um 40 mm from the middle, where both have one sign.
    lines = Path("out.nc").read_text().splitlines()
    assert lines[2:5] == ["G0 X260.004 Y160. Z100.", "G1 X340.", "X339.996 Y240."]


def test_limits_are_those_of_the_circles_unless_there_are_to_be_none(here):
    written("r.csv", table(slopes={"EXY": 5e-5}))
    words = ("calibrate", "circles", "--centre", "300,200,100", "r.csv", "-o")
    assert call(*words, "ends.toml").exit_code == 0
    assert load_model(Path("ends.toml")).range_of(1) == (100.0, 300.0)
    assert load_model(Path("ends.toml")).range_of(2) == (-np.inf, np.inf)
    assert call(*words, "endless.toml", "--limits", "none").exit_code == 0
    assert 'kind = "skew"' in Path("endless.toml").read_text()
    assert load_model(Path("endless.toml")).range_of(1) == (-np.inf, np.inf)


# --- tables ---


def test_what_is_written_reads_back(here):
    runs = both("YZ", ROUGH, slopes={"EYZ": 3e-5})
    (setup, found), *others = read_tests(circles_csv([(SetUp("YZ", 100.0, FEED, CENTRE), runs)]),
                                       cw_angles="position")  # fmt: skip
    assert others == []
    assert (setup.plane, setup.radius, setup.centre) == ("YZ", 100.0, CENTRE)
    assert setup.feed == pytest.approx(FEED)
    for one, other in zip(runs, found, strict=True):
        assert other.sense == one.sense
        assert other.readings.tolist() == one.readings.tolist()


def test_a_row_may_have_both_senses():
    slopes = {"EXY": 5e-5}
    pairs = zip(rows(slopes=slopes), rows(sense=-1, slopes=slopes), strict=True)
    wide = "angle [deg],ccw [um],cw [um]\n"
    wide += "".join(f"{angle},{one},{other}\n" for (angle, one), (_, other) in pairs)
    said = {"plane": "XY", "radius": 100.0, "feed": FEED}
    ((setup, found),) = read_tests(wide, cw_angles="position", **said)
    ((_, plain),) = read_tests(table(slopes=slopes))
    assert setup == SetUp("XY", 100.0, FEED)
    for one, other in zip(plain, found, strict=True):
        order = np.argsort(one.degrees)
        assert one.readings[order] == pytest.approx(other.readings, abs=1e-8)
    assert "GX477" in refusal(wide, **said)
    assert "GX470" in refusal(wide.replace("ccw", "sense"), **said)


def test_angles_of_the_way_travelled_are_turned_around():
    """A clockwise run that counts its own way: 10 degrees of it are at the place 350."""
    ((_, (_, plain)),) = read_tests(table())
    own = HEAD + "".join(f"XY,cw,100,1000,{angle},{angle}\n" for angle in ROUGH)
    ((_, (found,)),) = read_tests(own, cw_angles="travelled")
    assert found.degrees.tolist() == (-ROUGH).tolist()
    ((_, (found,)),) = read_tests(own, cw_angles="position")
    assert found.degrees.tolist() == ROUGH.tolist()
    assert plain.degrees[0] == ROUGH[-1]
    assert "--cw-angles travelled" in refusal(own)
    falling = HEAD + "".join(f"XY,ccw,100,1000,{angle},{angle}\n" for angle in ROUGH[::-1])
    assert "angles of the counter-clockwise run fall" in refusal(falling)


def test_points_of_an_instrument_and_of_a_probe_are_off_to_opposite_sides():
    """A tool that is 1 um too far in X meets a ring where the display says 1 um too little."""
    slopes, angle = {"EXY": 5e-5}, np.radians(ROUGH)
    flat = 40.0 * np.column_stack([np.cos(angle), np.sin(angle)])
    flat += CENTRE[:2]
    off = errors(slopes, np.column_stack([flat, np.zeros(len(flat))]) - [*CENTRE[:2], 0.0])[:, :2]
    for word, places in (("ccw", flat + off), ("probed", flat - off)):
        text = "plane,sense,X [mm],Y [mm],Z [mm]\n"
        text += "".join(f"XY,{word},{x!r},{y!r},77\n" for x, y in places.tolist())
        ((setup, (found,)),) = read_tests(text)
        assert setup.radius == pytest.approx(40.0, abs=1e-4)
        assert setup.centre == pytest.approx((*CENTRE[:2], 77.0), abs=1e-4)
        exact = 40.0 * 5e-5 * np.sin(2.0 * np.radians(found.degrees)) / 2.0
        assert found.readings == pytest.approx(exact, abs=2e-6), word
        ((setup, _),) = read_tests(text, radius=40.01, centre=CENTRE)
        assert (setup.radius, setup.centre) == (40.01, CENTRE)


def test_a_probed_ring_gives_the_squareness_alone(here):
    angle = np.radians(np.arange(0.0, 360.0, 10.0))
    y = 200.0 + 40.0 * np.sin(angle)
    x = 300.0 + 40.0 * np.cos(angle) - 5e-5 * (y - 200.0)
    text = "sense,X [mm],Y [mm]\n" + "".join(
        f"probed,{a!r},{b!r}\n" for a, b in zip(x.tolist(), y.tolist(), strict=True)
    )
    written("ring.csv", text)
    done = call("calibrate", "circles", "--plane", "XY", "-o", "m.toml", "ring.csv")
    assert done.exit_code == 0, done.stderr
    assert "C0Y: -50.00" in done.stdout
    assert "turn the ring by 90 degrees" in done.stdout
    place = np.array([[300.0, 240.0, 0.0]])
    assert load_model(Path("m.toml")).error(place)[0] == pytest.approx([2e-3, 0, 0], abs=1e-6)


def test_a_foreign_table_is_read_by_its_columns():
    """Lines above, decimals with commas, semicolons: as a program may export it."""
    foreign = "Ballbar\nRun 1;Run 2\n" + "".join(
        f"{angle};{value:.4f}\n".replace(".", ",") for angle, value in rows(slopes={"EXX": 5e-5})
    )
    layout = Layout("angle [deg], ccw [um]", 2, True)
    exact = run("XY", 1, ROUGH, slopes={"EXX": 5e-5}).readings
    ((_, (found,)),) = read_tests(foreign, layout, **SAID)
    assert found.readings == pytest.approx(exact, abs=1e-7)
    bare = Layout("angle [deg], ccw [um]", 2)
    assert "GX471" in refusal(foreign, bare, **SAID)
    assert "GX471" in refusal(foreign.replace(";", "\t"), bare, **SAID)
    mixed = foreign.replace("0,5;", "0.5;", 1)
    assert "GX471" in refusal(mixed, layout, **SAID)
    assert "<text>:3:1" in refusal(mixed, layout, **SAID)
    assert "--columns" in refusal(foreign, Layout("angle, ccw [um]", 2, True))


@pytest.mark.parametrize("name", ["a.b5r", "A.B20"])
def test_result_files_that_nobody_describes_are_refused(here, name):
    written(name, "<xml/>")
    done = call("calibrate", "circles", name)
    assert done.exit_code != 0
    assert "GX470" in done.stderr
    assert "--columns" in done.stderr


def test_the_way_in_and_out_is_cut_off_where_that_is_said():
    long = HEAD + "".join(f"XY,ccw,100,1000,{a},{a}\n" for a in range(-180, 541, 5))
    assert "from -180 to 540 degrees" in refusal(long)
    ((_, (found,)),) = read_tests(long, arc=(0.0, 360.0))
    assert (found.degrees.min(), found.degrees.max(), len(found.degrees)) == (0.0, 360.0, 73)
    assert found.where(0).line == 38


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [
        (("XY,ccw", "XZ,ccw"), "GX471", "ZX has its angles from Z to X"),
        (("XY,ccw", "UV,ccw"), "GX471", "'UV' is not one of"),
        (("ccw,100", "left,100"), "GX471", "'left' is not one of ccw"),
        (("ccw,100", "ccw,0"), "GX471", "a radius is above 0"),
        (("ccw,100", "ccw,1e-300"), "GX471", "a radius of 1e-300 mm is none"),
        (("ccw,100", "ccw,1e300"), "GX471", "a radius of 1e+300 mm is none"),
        (("[mm/min]", "[rpm]"), "GX470", "'rpm' is not a unit of a feed"),
        (("reading [um]", "reading"), "GX470", "has no unit"),
        (("feed [", "fed ["), "GX470", "the column 'fed' means nothing"),
        (("100,1000", "100,0"), "GX471", "a feed is above 0"),
        (("plane,", "test,"), "GX470", "no column 'plane'"),
        (("radius [mm]", "temperature [mm]"), "GX470", "no column 'radius'"),
    ],
)
def test_what_is_wrong_with_a_table_has_its_place(change, code, words):
    said = refusal(table().replace(*change, 1))
    assert (code in said, words in said) == (True, True), said
    assert "<text>:" in said


def test_what_is_said_twice_is_refused():
    for said in ({"plane": "XY"}, {"radius": 100.0}, {"feed": FEED}):
        assert "leave out --" in refusal(table(), **said)


def test_a_model_needs_the_place_of_its_circle_and_a_report_does_not(here):
    written("r.csv", table())
    done = call("calibrate", "circles", "r.csv")
    assert (done.exit_code, "G(b)" in done.stdout) == (0, True)
    done = call("calibrate", "circles", "-o", "m.toml", "r.csv")
    assert done.exit_code != 0
    assert "GX478" in done.stderr
    assert not Path("m.toml").exists()
    done = call("calibrate", "circles", "--centre", "0,0,0", "-o", "m.toml", "r.csv")
    assert done.exit_code == 0, done.stderr
    assert call("calibrate", "circles", "--arc", "360,0", "r.csv").exit_code == 2


def test_what_holds_by_direction_or_feed_is_reported_and_in_no_model(here):
    drives = Drives(backlash=(0.01, 0.01, 0.0), lag=(0.005, 0.0, 0.0))
    written("r.csv", table(drives=drives))
    done = call("calibrate", "circles", "--centre", "300,200,100", "-o", "m.toml", "r.csv")
    assert done.exit_code == 0, done.stderr
    model = load_model(Path("m.toml"))
    assert np.abs(model.error(np.add(CENTRE, [[70.0, 70, 0]]))).max() < 2e-5
    assert "depends on direction or feed" in Path("m.toml").read_text()
    assert "backlash X        +X +10.00" in done.stdout


def test_the_sheet_shows_both_senses_the_causes_and_what_is_left(here):
    pytest.importorskip("matplotlib")
    written("r.csv", table(slopes={"EXY": 5e-5}, pivot=(0.05, 0.0)))
    done = call("calibrate", "circles", "--plot", "one.svg", "r.csv")
    assert done.exit_code == 0, done.stderr
    groups, text = drawn("one.svg")
    names = [f"test 1 {part}" for part in ("ccw", "cw", "least", "most", "share squareness")]
    assert [name for name in names if name not in groups] == []
    assert {"+X", "-Y", "CCW", "CW", "G(b)", "squareness", "100 %"} <= set(text.splitlines())
    assert "C0Y: -50.00 +- " in text
    assert "2 um/div" in text  # 2.5 um about the circle, where the pivot is off by 50 um


def test_arc_without_readings_and_two_points_are_refused_in_words(here):
    (here / "c.csv").write_text(table())
    done = call("calibrate", "circles", "--arc", "400,410", "c.csv")
    assert "no reading of this run is between 400" in done.stderr
    (here / "p.csv").write_text("plane,sense,X [mm],Y [mm]\nXY,probed,1,1\n")
    assert "3 points at least, and not 1" in call("calibrate", "circles", "p.csv").stderr


def test_few_readings_that_do_not_tell_the_radius_have_a_sheet(here):
    few = [k + 0.25 for k in range(0, 360, 45)]
    lines = [f"XY,ccw,100,1000,{a},1\n" for a in few]
    lines += [f"XY,cw,100,1000,{a},1\n" for a in few[::-1]]
    (here / "c.csv").write_text(HEAD + "".join(lines))
    assert call("calibrate", "circles", "--pitch", "10mm", "c.csv").exit_code == 0

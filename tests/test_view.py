"""`gcxform view`: the page is opened in a real browser, looked at, clicked and played."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_kit import PLACE, Sight, started
from cli_kit import call

import gcxform as gx
from gcxform.cli.common.programs import opened
from gcxform.errormodel.model_file import load_model
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source
from gcxform.view.reading import read, read_for
from gcxform.view.tips import tips

pytestmark = pytest.mark.xdist_group("browser")  # it is started once

EXAMPLES = Path(__file__).parents[1] / "examples"
BRACKET = EXAMPLES / "bracket"
DOME = EXAMPLES / "rtcp-loop"
PART = rb"""%
(</script><img src=x onerror="document.title='bad'"> & <!-- {{data}} \u003c)
G90 G21 G17 G94
T1 M6
G0 X0 Y0 Z5
G1 Z-1. F100
X+20. F500. ; .5 1.2.3 --4 X007.50 Y-.25 Z-0.0 W00
G2 X30 Y10 I0 J10
G3 X40 Y20 I10
N70G1Y0.000
X.5Y3
G0 Z5
M30
%"""


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with started() as found:
        yield found


def page_of(folder: Path, *words: str) -> Path:
    page = folder / "page.html"
    found = call("view", "-o", str(page), *words)
    assert found.exit_code == 0, found.output
    return page


@pytest.fixture(scope="module")
def part(browser, tmp_path_factory) -> Iterator[Sight]:
    folder = tmp_path_factory.mktemp("view")
    (folder / "part.nc").write_bytes(PART)
    page = page_of(folder, "-f", "linuxcnc", str(folder / "part.nc"))
    sight = Sight.of(browser, page, has_touch=True)
    yield sight
    sight.close()


@pytest.fixture(scope="module")
def bracket(browser, tmp_path_factory) -> Iterator[Sight]:
    """A program and what a pipeline makes of it."""
    folder = tmp_path_factory.mktemp("view")
    page = page_of(folder, "-p", str(BRACKET / "bracket.toml"), str(BRACKET / "bracket.nc"))
    sight = Sight.of(browser, page)
    yield sight
    sight.close()


def coloured(pixels: np.ndarray) -> int:
    """Return how many pixels are not of the ground."""
    return int((np.abs(pixels[:, :, :3].astype(int) - pixels[0, 0, :3]).sum(axis=2) > 40).sum())


def texts(sight: Sight, nth: int = 0) -> list[str]:
    """Return the lines of a program as the page has them."""
    script = "return Promise.all([...Array(view.programs[value].text.count).keys()]"
    found: list[str] = sight.run(f"{script}.map((line) => view.programs[value].lineAt(line)))", nth)
    return found


def chosen(sight: Sight, nth: int) -> tuple[int, list[int]]:
    """Return the line of a program that is chosen, and those that are linked to the choice."""
    script = "const { list } = view.programs[value]; return [list.chosen, [...list.linked]]"
    line, linked = sight.run(script, nth)
    return line, linked


def test_the_page_loads_nothing_and_complains_of_nothing(part, bracket) -> None:
    for sight in (part, bracket):
        assert len(sight.requests) == 1
        assert sight.requests[0].endswith("page.html")
        assert sight.complaints == []


def test_what_a_program_says_is_text_and_never_markup(part) -> None:
    assert texts(part) == PART.decode("latin-1").split("\n")
    assert part.page.title() == "part.nc"
    assert part.page.query_selector("#lists img") is None
    assert "</script><img" in part.text("#lists")


def test_the_path_is_drawn_and_follows_the_time(part) -> None:
    whole = part.pixels()
    assert coloured(whole) > 500
    part.run("view.goTo(0.3 * view.player.total)")
    early = part.pixels()
    part.run("view.goTo(0.8 * view.player.total)")
    late = part.pixels()
    part.run("view.goTo(view.player.total)")
    assert (early != late).any()
    assert (whole == part.pixels()).all()


def test_it_plays(part) -> None:
    part.run("view.goTo(0)")
    part.page.select_option("#speed", "4")
    part.page.click("#play")
    part.page.wait_for_selector("#clock:not(:text('0:00:00 of'))")
    part.page.click("#play")
    assert 0 < part.run("return view.player.at") < part.run("return view.player.total")
    part.run("view.goTo(view.player.total)")


def test_a_line_leads_to_its_move(part) -> None:
    before = part.pixels()
    part.page.click(".line[data-line='7']")
    part.page.wait_for_selector("#told pre")
    told = part.text("#told")
    assert "word I, number 0" in told
    assert "clockwise arc at 500 mm/min" in told
    assert "from X20 Y0 Z-1" in told
    assert "about X20 Y10, radius 10 mm, in the plane XY" in told
    assert "through 270 degrees" in told
    assert (part.pixels() != before).any()
    assert part.page.url.endswith("#1:8")


FRAMED = b"""G21 G90 G17 G94 G54
G0 X0. Y0. Z5.
G92 X10. Y-3.
G1 X12. Y4. Z-1. F300.
G68 X0. Y0. R30.
G1 X16. Y5.
G3 X20. Y9. R4.
G69
G1 X1.25 Y2.
M30
"""


def test_what_a_line_does_is_told_as_explain_tells_it(browser, tmp_path: Path) -> None:
    """In the coordinates of its frame: shifted by G92 and turned by G68."""
    (tmp_path / "framed.nc").write_bytes(FRAMED)
    place = str(tmp_path / "framed.nc")
    sight = Sight.of(browser, page_of(tmp_path, "-f", "fanuc", place))
    for line in (4, 6, 7, 9):
        told = call("explain", "-f", "fanuc", f"{place}:{line}").stdout.splitlines()
        said = told[told.index("before it") :]
        sight.page.click(f".line[data-line='{line - 1}']")
        sight.page.wait_for_selector(f"#told h2:text-matches(', line {line}$')")
        shown = sight.text("#told").splitlines()
        sizes = [" ".join(each.split()) for each in shown[shown.index("before it") :]]
        assert sizes[: len(said)] == [" ".join(each.split()) for each in said]
    sight.close()


@pytest.mark.parametrize("way", ["click", "tap"])
def test_a_move_leads_to_its_line(part, way: str) -> None:
    rows = part.run("return view.programs[0].path.count")
    for row in range(1, rows - 1):
        line = part.run("return view.programs[0].lineOfRow(value)", row)
        part.page.keyboard.press("Escape")
        place = part.place_of(0, row)
        part.page.mouse.click(*place) if way == "click" else part.page.touchscreen.tap(*place)
        assert chosen(part, 0)[0] == line
    part.page.keyboard.press("Escape")


def test_the_keys(part) -> None:
    part.page.keyboard.press("1")
    whole = part.pixels()
    for key in ("r", "2", "+", "c"):
        before = part.pixels()
        part.page.keyboard.press(key)
        assert (part.pixels() != before).any(), key
    for key in ("r", "c", "c", "1"):
        part.page.keyboard.press(key)
    part.page.select_option("#colour", "kind")
    assert (part.pixels() == whole).all()
    part.page.keyboard.press("ArrowLeft")
    assert chosen(part, 0)[0] >= 0
    part.page.focus("#lists .rows")
    line = chosen(part, 0)[0]
    part.page.keyboard.press("ArrowUp")
    assert chosen(part, 0)[0] == line - 1
    part.page.keyboard.press("Escape")
    part.run("view.goTo(view.player.total)")


def test_dark_and_light(part) -> None:
    light = part.pixels()[0, 0, :3]
    part.page.keyboard.press("d")
    dark = part.pixels()[0, 0, :3]
    assert light.tolist() == [0xFF, 0xFF, 0xFF]
    assert dark.tolist() == [0x12, 0x15, 0x1A]
    part.page.click("#theme")
    assert (part.pixels()[0, 0, :3] == light).all()


def test_a_run_is_shown_with_its_certificate(bracket) -> None:
    source = (BRACKET / "bracket.nc").read_text("latin-1").replace("\r", "").rstrip("\n")
    assert texts(bracket) == source.split("\n")
    assert bracket.page.is_hidden("#certificate")
    bracket.page.click("#tabs button:nth-child(2)")
    told = bracket.text("#certificate")
    assert "PASS: largest deviation 0.000" in told
    assert "rapids: only their ends" in told
    bracket.page.click("#tabs button:nth-child(1)")


def test_lines_of_source_and_output_are_linked(bracket) -> None:
    bracket.page.select_option("#colour", "deviation")
    bracket.page.click("#lists .list:nth-child(1) .line[data-line='17']")
    line, linked = chosen(bracket, 1)
    assert line == -1
    assert texts(bracket, 1)[linked[0]].startswith(texts(bracket)[17].split()[0])
    bracket.page.click(f"#lists .list:nth-child(2) .line[data-line='{linked[0]}']")
    assert chosen(bracket, 0) == (-1, [17])
    bracket.page.wait_for_selector("#told pre:text('deviation')")
    if PLACE:  # the picture of the manual, with the machine
        for name in ("envelope", "errors"):
            bracket.page.click(f".tools button:text-is('{name}')")
        bracket.run("view.goTo(0.6 * view.player.total)")
        bracket.picture("view.png")
        bracket.run("view.goTo(view.player.total)")
        for name in ("envelope", "errors"):
            bracket.page.click(f".tools button:text-is('{name}')")


def test_every_colour_is_another(bracket) -> None:
    names = bracket.run("return [...document.getElementById('colour').options].map((o) => o.value)")
    assert names == ["kind", "feed", "deviation", "error", "tool", "pass"]
    seen = set()
    for name in names:
        bracket.page.select_option("#colour", name)
        seen.add(bracket.pixels().tobytes())
        assert bracket.text("#legend")
    assert len(seen) == len(names)
    assert "volumetric" in bracket.text("#legend")


def test_what_stands_around_the_path_is_seen(bracket) -> None:
    for name in ("grid", "envelope", "errors", "rapids", "before"):
        before = bracket.pixels()
        bracket.page.click(f".tools button:text-is('{name}')")
        assert (bracket.pixels() != before).any(), name
    assert "errors of the machine" in bracket.text("#legend")
    for name in ("grid", "envelope", "errors", "rapids", "both"):
        bracket.page.click(f".tools button:text-is('{name}')")


def test_a_picture_drawn_by_shares_is_the_one_drawn_at_once(bracket) -> None:
    script = """
        const { drawing } = view;
        drawing.share = 1;
        view.turnBy(0.3);
        return new Promise((done) => {
            const lengths = new Set();
            const look = () => {
                if (drawing.rest) lengths.add(drawing.rest.length);
                return lengths.has(0) ? done([...lengths]) : requestAnimationFrame(look);
            };
            look();
        });"""
    assert bracket.run(script) == [1, 0]
    by_shares = bracket.pixels(now=False)
    assert coloured(by_shares) > 500
    assert (by_shares == bracket.pixels()).all()
    bracket.run("view.drawing.share = 50_000; view.turnBy(-0.3)")


def test_time_is_that_of_info(bracket, monkeypatch) -> None:
    monkeypatch.chdir(BRACKET)
    found = call("info", "--json", "-f", "linuxcnc", "-m", "machine.toml", "bracket.nc")
    times = json.loads(found.stdout)["time_s"]
    script = "const { times, path } = view.programs[0]; return [...path.kind]"
    sums = "reduce((sum, kind, k) => sum + (kind ? times[k + 1] - times[k] : 0), 0)"
    assert bracket.run(f"{script}.{sums}") == pytest.approx(times["feed"], rel=1e-3)


def test_two_programs_with_what_lies_beside(browser, tmp_path: Path) -> None:
    source, output = tmp_path / "in.nc", tmp_path / "out.nc"
    source.write_bytes(PART.replace(b"G90 G21", b"G90 (inch) G20"))
    words = ["-f", "linuxcnc", "-x", "absolute | metric", "--no-stamp"]
    beside = ["--map", str(tmp_path / "out.map.json"), "--certificate", str(tmp_path / "out.json")]
    assert call("run", *words, "-o", str(output), *beside, str(source)).exit_code == 0
    shutil.copy(tmp_path / "out.json", tmp_path / "out-old.json")
    text = (tmp_path / "out-old.json").read_text()
    (tmp_path / "out-old.json").write_text(text.replace('"sha256": "', '"sha256": "0'))
    page = page_of(tmp_path, "-f", "linuxcnc", str(source), str(output))
    sight = Sight.of(browser, page, "#1:2", color_scheme="dark")
    assert sight.pixels()[0, 0, 0] == 0x12
    assert chosen(sight, 1)[1] == [1]
    assert "PASS" in sight.text("#certificate")
    assert "out-old.json is about other programs" in sight.text("#note")
    assert sight.complaints == []
    sight.close()


def test_the_tool_axis_is_that_of_the_chain(browser, tmp_path: Path) -> None:
    page = page_of(tmp_path, "-p", str(DOME / "axes.toml"), str(DOME / "dome.nc"))
    sight = Sight.of(browser, page)
    chain = chain_of(load_machine(DOME / "set.toml", default_registry().machines))
    script = "const { path } = view.programs[0]; const at = path.axes;"
    script += "return [view.toolAxis(0, value), path.ends[at.indexOf('A')][value],"
    for row in (10, 40):
        axis, a, c = sight.run(f"{script} path.ends[at.indexOf('C')][value]]", row)
        angles = np.array([{"A": a, "C": c}[letter] for letter in chain.letters])
        assert np.allclose(axis, chain.tool_axis(angles), atol=1e-6)
    cone = "return view.programs.map(({ path }) => [...path.corners].slice(-4, -1).map("
    ends = sight.run(f"{cone}(value, k) => value + path.middle[k]))")
    assert np.allclose(*ends, atol=2e-3)  # axes as written end where the tip does
    assert "as written: X, Y, Z are taken for those of the axes" in sight.text("#note")
    assert sight.page.query_selector("button:text-is('tool axes')") is not None
    sight.run("view.goTo(0.5 * view.player.total)")
    sight.picture("view-five-axes.png")
    assert sight.complaints == []
    sight.close()


TOOLS = """G21 G90 G17 G94 G54
T1 M6
G0 G43 H1 X0. Y0. Z50.
G1 Z0. F100.
X20.
G0 Z50.
T2 M6
G0 G43 H2 X0. Y0. Z50.
G68 X0. Y0. R30.
G18
G1 X5. Y0. Z0. F100.
M30
"""
LENGTHS = """format = 1
[work-offset.G54]
[tool.1]
length = 100.0
[tool.2]
length = 50.0
"""


def test_tools_of_any_length_stand_on_what_they_cut_and_planes_are_seen(browser, tmp_path) -> None:
    (tmp_path / "t.nc").write_text(TOOLS)
    (tmp_path / "m.toml").write_text(LENGTHS)
    words = ["-f", "fanuc", "-m", str(tmp_path / "m.toml"), str(tmp_path / "t.nc")]
    sight = Sight.of(browser, page_of(tmp_path, *words), "#1:5")
    script = "const { path } = view.programs[0]; return [...path.corners].map("
    corners = np.reshape(sight.run(f"{script}(v, k) => v + (path.middle[k % 4] ?? 0))"), (-1, 4))
    assert corners[-1, :3] == pytest.approx([5 * 3**0.5 / 2, 2.5, 0.0], abs=1e-4)
    assert corners[2:4, 2].tolist() == pytest.approx([0.0, 0.0], abs=1e-4)  # and not 100
    pane = "const { both, label } = view.scene.plane;"
    told = f"{pane} return [both.visible, label.element.textContent, both.matrix.elements]"
    seen, code, basis = sight.run(told)
    assert (seen, code, basis[8:11]) == (True, "G17", [0, 0, 1])
    sight.page.click(".line[data-line='10']")
    _, code, basis = sight.run(told)
    assert code == "G18"
    normal = [-0.5, 3**0.5 / 2, 0.0]  # of ZX, turned by G68
    assert basis[8:11] == pytest.approx(normal, abs=1e-9)
    before = sight.pixels()
    sight.page.click(".tools button:text-is('plane')")
    assert (before != sight.pixels()).any()
    assert sight.complaints == []
    sight.close()


def test_axes_are_drawn_where_the_tip_goes(tmp_path: Path) -> None:
    """The tips of a program for axes lie on the program of tips that it was made of."""
    with opened(str(DOME / "dome.nc")) as source:
        plan = gx.Pipeline.load(DOME / "axes.toml")
        parts: list[bytes] = []
        plan.run_stream(source, parts.append)
        before = read_for(plan, source)
    output = read(Source.of_bytes(b"".join(parts), "o"), plan.target, plan.machine_reading)
    found = tips(output.path, plan.machine)
    cut = (found.pieces > 0) & (output.path.kind != gx.Kind.RAPID)
    drawn = found.points[cut.repeat(np.maximum(found.pieces, 1))]
    wanted = before.path.end[:, :3] - (0.0, 0.0, 120.0)
    wanted = wanted[np.isfinite(wanted).all(axis=1)]
    segments = wanted[:-1], np.diff(wanted, axis=0)
    way = drawn[:, None] - segments[0]
    square = np.maximum((segments[1] ** 2).sum(axis=1), 1e-12)
    part = np.clip((way * segments[1]).sum(axis=2) / square, 0.0, 1.0)
    away = np.linalg.norm(way - part[..., None] * segments[1], axis=2).min(axis=1)
    assert away.max() < 3e-3
    assert len(drawn) >= cut.sum() > 1000


def test_a_program_without_moves(browser, tmp_path: Path) -> None:
    (tmp_path / "still.nc").write_bytes(b"(nothing)\r\n")
    sight = Sight.of(browser, page_of(tmp_path, "-f", "linuxcnc", str(tmp_path / "still.nc")))
    sight.page.keyboard.press("ArrowRight")
    sight.page.keyboard.press(" ")
    assert "moves nothing" in sight.text("#note")
    assert sight.complaints == []
    sight.close()


def test_errors_lie_where_the_pipeline_says(tmp_path: Path) -> None:
    """The first place of the tables is the part origin away from the zero of the program."""
    lddm = EXAMPLES / "lddm"
    pipeline = (lddm / "linear.toml").read_text().replace('"model.toml"', f'"{lddm}/model.toml"')
    changed = pipeline.replace("part-origin = [0.0, 0.0, 0.0]", "part-origin = [1.0, 2.0, 3.0]")
    assert changed != pipeline
    (tmp_path / "job.toml").write_text(changed + "\n")
    words = ["--allow-outside", "-p", str(tmp_path / "job.toml"), str(lddm / "linear_in.nc")]
    head = re.search('id="head">(.*?)</script>', page_of(tmp_path, *words).read_text())
    assert head is not None
    lattice = json.loads(head[1])["scene"]["lattice"]
    model = load_model(lddm / "model.toml")
    places = np.reshape(lattice["points"], (-1, 3))
    errors = np.reshape(lattice["errors"], (-1, 3))
    assert np.allclose(model.error(np.add(places, (1.0, 2.0, 3.0))), errors, atol=1e-6)
    assert np.abs(errors).max() > 0.001


COMPENSATED = """G21 G90 G17 G94
G0 X0 Y0 Z5
G1 Z0 F100
G41.1 D10 G1 X20 Y0
X60
Y40
X20
G40 G1 X0
M30
"""


def test_a_path_that_a_pass_makes_on_purpose_is_the_one_compared(tmp_path: Path) -> None:
    (tmp_path / "in.nc").write_text(COMPENSATED)
    words = ["-f", "linuxcnc", "-x", "cutter-comp", str(tmp_path / "in.nc")]
    page = page_of(tmp_path, *words).read_text()
    assert '"notes":[]' in page
    assert '"name":"deviation"' in page


def test_it_is_packed(tmp_path: Path) -> None:
    """What a move takes in the file, text included, where no move is like the one before."""
    here = tmp_path / "many.nc"
    way = np.cumsum(np.random.default_rng(4).integers(-900, 900, (20_000, 3)), axis=0) / 1000
    here.write_text("G90 G21 G94 F900\n" + "\n".join(f"G1X{x}Y{y}Z{z}" for x, y, z in way))
    large = page_of(tmp_path, "-f", "linuxcnc", str(here)).stat().st_size
    here.write_text("G90 G21 G94 F900\nG1 X1 Y1 Z1\n")
    small = page_of(tmp_path, "-f", "linuxcnc", str(here)).stat().st_size
    assert (large - small) / 20_000 < 15


def test_one_of_two_ways_to_name_an_output(tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_bytes(PART)
    found = call("view", "-x", "absolute", "-f", "linuxcnc", *[str(tmp_path / "part.nc")] * 2)
    assert found.exit_code == 2
    assert "GX728" in found.output

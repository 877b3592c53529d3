"""`gcxform view`: the page is opened in a real browser, looked at, clicked and played."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser_kit import Sight, started
from cli_kit import call

pytestmark = pytest.mark.xdist_group("browser")  # it is started once

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


@pytest.fixture(scope="module")
def part(browser, tmp_path_factory) -> Iterator[Sight]:
    folder = tmp_path_factory.mktemp("view")
    (folder / "part.nc").write_bytes(PART)
    page = folder / "part.html"
    assert call("view", "-f", "linuxcnc", "-o", str(page), str(folder / "part.nc")).exit_code == 0
    sight = Sight.of(browser, page)
    yield sight
    sight.close()


def coloured(pixels: np.ndarray) -> int:
    """Return how many pixels are not of the ground."""
    return int((np.abs(pixels[:, :, :3].astype(int) - pixels[0, 0, :3]).sum(axis=2) > 40).sum())


def line_rows(sight: Sight) -> list[str]:
    count = sight.run("return view.programs[0].text.count")
    return [sight.run("return view.programs[0].lineAt(value)", line) for line in range(count)]


def test_the_page_loads_nothing_and_complains_of_nothing(part) -> None:
    assert len(part.requests) == 1
    assert part.requests[0].endswith("part.html")
    assert part.complaints == []


def test_what_a_program_says_is_text_and_never_markup(part) -> None:
    assert line_rows(part) == PART.decode("latin-1").split("\n")
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


def test_a_line_leads_to_its_move(part) -> None:
    before = part.pixels()
    part.page.click(".line[data-line='7']")
    told = part.text("#told")
    assert "word I, number 0" in told
    assert "clockwise arc at 500 mm/min" in told
    assert "from X20 Y0 Z-1" in told
    assert "about X20 Y10, radius 10 mm, in the plane XY" in told
    assert "through 270 degrees" in told
    marked = part.pixels()
    assert (marked != before).any()
    assert part.page.url.endswith("#1:8")


def test_a_move_leads_to_its_line(part) -> None:
    rows = part.run("return view.programs[0].path.count")
    for row in range(1, rows - 1):
        line = part.run("return view.programs[0].lineOfRow(value)", row)
        part.page.mouse.click(*part.place_of(0, row))
        assert part.run("return view.programs[0].list.chosen") == line
    part.page.keyboard.press("Escape")


def test_dark_and_light(part, browser) -> None:
    light = part.pixels()[0, 0, :3].mean()
    part.page.keyboard.press("d")
    assert part.pixels()[0, 0, :3].mean() < light - 100
    part.page.click("#theme")
    assert part.pixels()[0, 0, :3].mean() == light


def test_it_is_packed(tmp_path: Path) -> None:
    """What a move takes in the file, text included, of which most is not the same as before."""
    here = tmp_path / "many.nc"
    way = np.cumsum(np.random.default_rng(4).integers(-900, 900, (20_000, 3)), axis=0) / 1000
    here.write_text("G90 G21 G94 F900\n" + "\n".join(f"G1X{x}Y{y}Z{z}" for x, y, z in way))
    assert call("view", "-f", "linuxcnc", "-o", str(tmp_path / "a"), str(here)).exit_code == 0
    here.write_text("G90 G21 G94 F900\nG1 X1 Y1 Z1\n")
    assert call("view", "-f", "linuxcnc", "-o", str(tmp_path / "b"), str(here)).exit_code == 0
    sizes = [(tmp_path / name).stat().st_size for name in "ab"]
    assert (sizes[0] - sizes[1]) / 20_000 < 15

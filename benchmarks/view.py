"""What the page of a long program takes: bytes, seconds to write and to open, pictures a second.

    python benchmarks/view.py [--lines N] [--seconds S]

The program is that of `surfacing.py`. It is shown alone, and with what `surfacing.toml` makes of
it. The page is opened in headless Chromium (Debian's, driven by Playwright) that draws in software,
on as many processors as there are; a graphics card is many times faster. Pictures a second are
counted while the path is turned about the vertical and the page is drawn as fast as it can be;
`sharp` is one picture with all that a pixel shows, until it is there; `wait` is the longest that
the page stands still while it becomes so by itself, in shares.
"""

from __future__ import annotations

import argparse
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
SIZE = {"width": 1280, "height": 800}
LEFT_TO_SETTLE = 1.0  # s
TURN = """(seconds) => new Promise((done) => {
    const { drawing } = gcxformView;
    const [first, begin] = [drawing.frames, performance.now()];
    const turn = () => {
        const now = performance.now() - begin;
        if (now > 1000 * seconds) return done((1000 * (drawing.frames - first)) / now);
        gcxformView.turnBy(0.02);
        requestAnimationFrame(turn);
    };
    turn();
})"""
WAIT = """() => new Promise((done) => {
    const { drawing } = gcxformView;
    gcxformView.turnBy(0.02);
    let [longest, last] = [0, performance.now()];
    const look = () => {
        const now = performance.now();
        longest = Math.max(longest, now - last);
        last = now;
        if (drawing.rest?.length === 0) return done(longest);
        requestAnimationFrame(look);
    };
    requestAnimationFrame(look);
})"""
MOVES = "() => gcxformView.programs.reduce((sum, each) => sum + each.path.count, 0)"
SHARP = """() => {
    const { renderer } = gcxformView.drawing;
    const gl = renderer.getContext();
    const begin = performance.now();
    gcxformView.drawNow();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    return performance.now() - begin;
}"""


def written(page: Path, *words: str) -> tuple[float, float]:
    """Write a page; return its wall time and its processor time in seconds."""
    command = [sys.executable, "-m", "gcxform.cli", "view", "-o", str(page), *words]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    begin = time.perf_counter()
    subprocess.run(command, check=True)
    wall = time.perf_counter() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def opened(browser: Any, page: Path, seconds: float) -> dict[str, float]:
    """Open a page and turn it; return what was measured."""
    context = browser.new_context(viewport=SIZE, offline=True)
    tab = context.new_page()
    begin = time.perf_counter()
    tab.goto(page.as_uri())
    tab.wait_for_selector("html[data-ready=yes]", state="attached", timeout=300_000)
    found = {"ready": time.perf_counter() - begin}
    tab.wait_for_timeout(1000 * LEFT_TO_SETTLE)
    found["sharp"] = tab.evaluate(SHARP)
    found["rate"] = tab.evaluate(TURN, seconds)
    found["wait"] = tab.evaluate(WAIT)
    found["moves"] = tab.evaluate(MOVES)
    context.close()
    return found


def measured(lines: int, seconds: float, folder: Path) -> None:
    """Print a table of both pages."""
    from playwright.sync_api import sync_playwright

    program = folder / "surfacing.nc"
    maker = [sys.executable, str(HERE / "surfacing.py"), "--lines", str(lines)]
    subprocess.run([*maker, str(program)], check=True)
    pages = {
        "alone": ["-f", "linuxcnc", str(program)],
        "before and after": ["-p", str(HERE / "surfacing.toml"), str(program)],
    }
    print(f"{lines} lines, {program.stat().st_size / 1e6:.1f} MB; {os.cpu_count()} processors\n")
    print(
        "| page | moves | MB | bytes a move | written s (CPU) | ready s | sharp ms | wait ms "
        "| a second |"
    )
    print("|---|---|---|---|---|---|---|---|---|")
    with sync_playwright() as driver:
        place = shutil.which("chromium")
        browser = driver.chromium.launch(executable_path=place, args=SOFTWARE)
        for name, words in pages.items():
            page = folder / "page.html"
            wall, cpu = written(page, *words)
            size, found = page.stat().st_size, opened(browser, page, seconds)
            print(
                f"| {name} | {found['moves']:.0f} | {size / 1e6:.2f} | {size / found['moves']:.2f} "
                f"| {wall:.1f} ({cpu:.1f}) | {found['ready']:.1f} | {found['sharp']:.0f} "
                f"| {found['wait']:.0f} | {found['rate']:.1f} |"
            )
        browser.close()


def main() -> None:
    """Read the command line and measure."""
    parser = argparse.ArgumentParser(description="Measure the page of a long program.")
    parser.add_argument("--lines", type=int, default=1_000_000, help="default: %(default)s")
    parser.add_argument("--seconds", type=float, default=5.0, help="of turning it")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measured(options.lines, options.seconds, Path(folder))


if __name__ == "__main__":
    main()

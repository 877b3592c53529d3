"""A real browser for the tests of the page: Debian's Chromium, driven by Playwright.

It is started once for all of them and draws in software. Where it is missing they are skipped,
visibly. With `PICTURES=docs/pictures` the tests of `test_view.py` draw the pictures of the manual.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SOFTWARE = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
SMALL = {"width": 900, "height": 800}  # what is read of it takes the time
COLOURS = 256  # of a picture that is kept
PLACE = os.environ.get("PICTURES", "")


@contextmanager
def started() -> Iterator[Any]:
    """Give a browser; skip where there is none."""
    program = shutil.which("chromium")
    if program is None:
        pytest.skip("chromium is not installed: the page is not looked at")
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=SOFTWARE)
        yield browser
        browser.close()


@dataclass
class Sight:
    """A page that is open, and what it asked for and complained of."""

    page: Any
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, browser: Any, file: Path, name: str = "", **manner: Any) -> Sight:
        """Open a file without a network, and wait until the page is ready."""
        manner = {"viewport": SMALL} | manner
        if PLACE:
            manner |= {"viewport": {"width": 1280, "height": 800}, "device_scale_factor": 2}
        context = browser.new_context(offline=True, **manner)
        sight = cls(context.new_page())
        sight.page.set_default_timeout(20_000)
        sight.page.on("request", lambda request: sight.requests.append(request.url))
        sight.page.on("console", lambda message: sight.complaints.append(message.text))
        sight.page.on("pageerror", lambda error: sight.complaints.append(str(error)))
        sight.page.goto(f"{file.resolve().as_uri()}{name}")
        try:
            sight.page.wait_for_selector("html[data-ready=yes]", state="attached")
        except Exception as error:
            raise AssertionError(f"the page says {sight.complaints}") from error
        return sight

    def close(self) -> None:
        """Close the page."""
        self.page.context.close()

    def run(self, script: str, value: Any = None) -> Any:
        """Return what a function of JavaScript returns; `view` is what the page knows."""
        return self.page.evaluate(f"(value) => {{ const view = gcxformView; {script} }}", value)

    def pixels(self, now: bool = True) -> np.ndarray:
        """Return the picture of the path (high, wide, 4), drawn sharp, or else as it stands."""
        script = """
            const { renderer } = view.drawing;
            if (value) view.drawNow();
            const gl = renderer.getContext();
            const [w, h] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
            const octets = new Uint8Array(4 * w * h);
            gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, octets);
            let text = "";
            for (let at = 0; at < octets.length; at += 8192) {
                text += String.fromCharCode(...octets.subarray(at, at + 8192));
            }
            return [w, h, text];"""
        wide, high, text = self.run(script, now)
        octets = np.frombuffer(text.encode("latin-1"), np.uint8)
        return octets.reshape(high, wide, 4)[::-1]

    def place_of(self, nth: int, row: int) -> tuple[float, float]:
        """Return where on the page (pixels) the middle of a move is."""
        script = """
            const { drawing } = view;
            const point = view.middleOf(value[0], value[1]);
            const seen = drawing.camera.projectionMatrix.clone();
            seen.multiply(drawing.camera.matrixWorldInverse);
            const at = drawing.controls.target.clone().set(...point).applyMatrix4(seen);
            const box = drawing.canvas.getBoundingClientRect();
            const [x, y] = [box.left + (at.x + 1) / 2 * box.width, box.top];
            return [x, y + (1 - at.y) / 2 * box.height];"""
        x, y = self.run(script, [nth, row])
        return x, y

    def text(self, where: str) -> str:
        """Return the text of what a selector finds."""
        return str(self.page.text_content(where))

    def picture(self, name: str) -> None:
        """Keep a picture of the page, where pictures are wanted."""
        if PLACE:
            from PIL import Image

            self.pixels()
            shot = Image.open(BytesIO(self.page.screenshot()))
            few = shot.convert("RGB").quantize(COLOURS, Image.Quantize.FASTOCTREE)
            few.save(Path(PLACE) / name, optimize=True)

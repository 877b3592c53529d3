"""AXIS itself, on a screen that nobody sees: LinuxCNC's simulator, started once.

LinuxCNC refuses to run as root, so root starts it as the user `nobody`, in a copy of the sample
configuration of the package; gcxform may be installed where only root reads, so `nobody` reads
all. A program is opened as an operator does, and its picture taken.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

SAMPLE = Path("/usr/share/doc/linuxcnc/examples/sample-configs/sim")
INI = "axis/axis_mm.ini"
NOBODY = 65534
PATIENCE = 120.0  # s; nothing takes so long, but other work on the same processors may
DRAWN, WIDE = 700, 738  # pixels of the window
DRAWN_PART = 0.4  # of the window that is not black when all of it is there
PACE = 0.5  # s between two looks
STILL = 4  # looks that show the same: then it is drawn


@dataclass
class Axis:
    """An AXIS that runs."""

    screen: str
    environment: dict[str, str]

    def open(self, program: Path, like: Any = None) -> Any:
        """Open a program that looks otherwise than what is shown; return the picture of the window.

        It is (height, width, 3), 0 to 255, and taken when it is another one and stays; with `like`
        when it is like that, or when it took too long.
        """
        before = self._shown()
        _as_nobody(["axis-remote", str(program)], self.environment).wait(PATIENCE)
        if like is None:
            return self.still(lambda shown: (shown != before).any())
        return self.still(lambda shown: (shown == like).all())

    def still(self, wanted: Callable[[Any], Any]) -> Any:
        """Return the picture when it is as wanted and stays, the last one if it took too long."""
        end, last, same = time.monotonic() + PATIENCE, self._shown(), 0
        while time.monotonic() < end:
            time.sleep(PACE)
            shown = self._shown()
            same = same + 1 if (shown == last).all() else 0
            last = shown
            if same >= STILL and wanted(shown):
                break
        return last

    def _shown(self) -> Any:
        """Return the picture, down to where AXIS shows messages."""
        from PIL import ImageGrab

        return np.asarray(ImageGrab.grab(xdisplay=self.screen).convert("RGB"))[:DRAWN, :WIDE]


@contextmanager
def started(folder: Path, settings: str) -> Iterator[Axis]:
    """Start AXIS with a section [FILTER]; skip where it is not installed."""
    for program in ("linuxcnc", "axis-remote", "Xvfb", "setpriv"):
        if shutil.which(program) is None:
            pytest.skip(f"{program} is not installed: AXIS is not looked at")
    home = folder / "home"
    shutil.copytree(SAMPLE, home / "sim", ignore_dangling_symlinks=True)
    ini = home / "sim" / INI
    text = ini.read_text("latin-1").replace("[FILTER]\n", settings).replace("INTRO_TIME = 5", "")
    ini.write_text(text.replace("INTRO_GRAPHIC = linuxcnc.gif", ""), "latin-1")
    (ini.parent / "sim_mm.tbl").touch()
    _give_away(folder)
    with _screen() as screen:
        said = {"HOME": str(home), "PATH": "/usr/bin:/bin", "LANG": "C.UTF-8", "DISPLAY": screen}
        running = _as_nobody(["linuxcnc", str(ini)], said)
        try:
            _wait_for(said)
            axis = Axis(screen, said)
            axis.still(lambda shown: shown.any(axis=2).mean() > DRAWN_PART)  # black before
            yield axis
        finally:
            _as_nobody(["axis-remote", "--quit"], said).wait(PATIENCE)
            running.wait(PATIENCE)


@contextmanager
def _screen() -> Iterator[str]:
    """Give the name of a screen that nobody sees."""
    read, write = os.pipe()
    words = ["Xvfb", "-displayfd", str(write), "-screen", "0", "1024x768x24"]
    server = subprocess.Popen(words, pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    try:
        with os.fdopen(read) as stream:
            yield f":{stream.readline().strip()}"
    finally:
        server.terminate()
        server.wait(PATIENCE)


def _wait_for(said: dict[str, str]) -> None:
    """Wait until AXIS answers."""
    end = time.monotonic() + PATIENCE
    while _as_nobody(["axis-remote", "--ping"], said).wait(PATIENCE):
        assert time.monotonic() < end, "AXIS does not start"
        time.sleep(0.3)


def _as_nobody(words: list[str], said: dict[str, str]) -> subprocess.Popen[bytes]:
    if os.getuid() == 0:
        ids = [f"--re{kind}id={NOBODY}" for kind in "ug"]
        reads = [f"--{kind}-caps=+dac_read_search" for kind in ("inh", "ambient")]
        words = ["setpriv", *ids, "--clear-groups", *reads, *words]
    silent = subprocess.DEVNULL
    return subprocess.Popen(words, env=said, stdin=silent, stdout=silent, stderr=silent)


def _give_away(folder: Path) -> None:
    """Let `nobody` have a folder, and reach it."""
    if os.getuid():
        return
    for path in (folder, *folder.rglob("*")):
        os.chown(path, NOBODY, NOBODY)

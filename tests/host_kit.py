"""How hosts call gcxform, by their own code where they are installed.

What a host does with a program is a function of its own: it is taken out of the file that is
installed, by name, and run with stand-ins for the window around it. Nothing of it is kept here.
"""

from __future__ import annotations

import ast
import gc
import os
import re
import select
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

BIN = Path(sys.executable).parent
AXIS = Path("/usr/bin/axis")
QTVCP = Path("/usr/lib/python3/dist-packages/qtvcp/qt_action.py")
GMOCCAPY = Path("/usr/lib/python3/dist-packages/gladevcp/gtk_action.py")


@dataclass
class Bar:
    """The progress bar of a host, as far as it is told of it."""

    seen: list[int] = field(default_factory=list)

    def __call__(self, *_: Any) -> Bar:
        return self

    def update(self, count: int, *_: Any) -> None:
        self.seen.append(count)

    def set_text(self, _: str) -> None:
        pass

    def done(self) -> None:
        pass


@dataclass
class Polled:
    """What calls a host's poll every 100 ms, here without the wait."""

    poll: Callable[[Any], bool] | None = None
    said: list[dict[str, str]] = field(default_factory=list)

    def connect(self, _: str, poll: Callable[[Any], bool]) -> int:
        self.poll = poll
        return 0

    def disconnect(self, _: int) -> None:
        self.poll = None

    def emit(self, _: str, what: dict[str, str]) -> None:
        self.said.append(what)


class Window:
    """A part of a window that takes anything."""

    def __getattr__(self, _: str) -> Any:
        return lambda *words, **named: self.__class__()


@dataclass(frozen=True)
class Filtered:
    """What a host has of a filter: its exit code, the text it shows, the bar, the program."""

    code: int
    shown: str
    bar: list[int]
    text: bytes


def taken(file: Path, *names: str) -> dict[str, Any]:
    """Return functions, classes and values of a host's file, by name; skip where it is not."""
    if not file.is_file():
        pytest.skip(f"{file} is not installed: this host is not driven")
    tree = ast.parse(file.read_text("utf-8"))
    wanted = [node for node in tree.body if _name(node) in names]
    assert {_name(node) for node in wanted} == {*names}, "the host's file is not what it was"
    space: dict[str, Any] = {"os": os, "select": select, "subprocess": subprocess, "re": re}
    space |= {"sys": sys, "_": lambda text: text, "LOG": Window(), "gtk": Window()}
    exec(compile(ast.Module(wanted, []), str(file), "exec"), space)
    return space


def _name(node: ast.stmt) -> str:
    if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
        return node.targets[0].id
    return getattr(node, "name", "")


def by_axis(command: str, program: Path, out: Path) -> Filtered:
    """Filter a program as AXIS does."""
    space = taken(AXIS, "progress_re", "filter_program")
    bar = Bar()
    space |= {"Progress": bar, "t": Window()}
    code, shown = space["filter_program"](command, str(program), str(out))
    gc.collect()
    return Filtered(code, shown, bar.seen, out.read_bytes())


def by_vcp(file: Path, command: str, program: Path, out: Path) -> Filtered:
    """Filter a program as the class of QtVCP and that of GladeVCP do."""
    space = taken(file, "progress_re", "FilterProgram")
    bar, status, codes, shown = Bar(), Polled(), list[int](), list[str]()
    space |= {"Progress": bar, "STATUS": status}
    kind = space["FilterProgram"]
    kind.error = lambda self, code, text: shown.append(text)
    filtering = kind(command, str(program), str(out), codes.append)
    while status.poll is not None:
        status.poll(None)
    filtering.p.stderr.close()
    del filtering, kind, space
    gc.collect()
    return Filtered(*codes, "".join(shown), bar.seen, out.read_bytes())

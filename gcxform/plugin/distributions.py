"""The plugins that are installed: entry points of a group, as the folders of `sys.path` have them.

`importlib.metadata` would tell the same, and needs the modules of e-mail and archives for it, which
take a quarter of what numpy takes: more than all else that a start does to find its plugins. What
is read here is specified by packaging.python.org: "Entry points specification" and "Recording
installed projects". Distributions in archives are not looked for, since numpy runs in none.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from contextlib import suppress
from functools import reduce
from importlib import import_module
from pathlib import Path
from typing import NamedTuple

HEADS = {".dist-info": "METADATA", ".egg-info": "PKG-INFO"}
"""The folders of distributions, each with the file that begins with name and version."""


class Point(NamedTuple):
    """An entry point: its name, `module` or `module:object`, and its distribution and version."""

    name: str
    value: str
    origin: str

    def load(self) -> object:
        """Return what it names; raises whatever the module raises, and AttributeError."""
        module, _, path = self.value.partition("[")[0].partition(":")
        return reduce(getattr, filter(None, path.strip().split(".")), import_module(module.strip()))


def entry_points(group: str) -> list[Point]:
    """Return the entry points of a group; of two distributions of one name the first one's."""
    found: dict[str, list[Point]] = {}
    for folder in sys.path:
        for info, head in _distributions(folder):
            name = re.sub(r"[-_.]+", "-", info.stem.partition("-")[0]).lower()
            if name not in found:
                found[name] = list(_points(info, head, group))
    return [point for points in found.values() for point in points]


def _distributions(folder: str) -> Iterator[tuple[Path, str]]:
    """Yield the folders that describe distributions, by name, each with the name of its head."""
    names: list[str] = []
    with suppress(OSError):  # no folder: an archive, or what is no longer there
        names = sorted(os.listdir(folder or "."))
    for name in names:
        if head := HEADS.get(os.path.splitext(name)[1]):
            yield Path(folder, name), head


def _points(info: Path, head: str, group: str) -> Iterator[Point]:
    """Yield the entry points of a distribution."""
    text, section = _text(info / "entry_points.txt"), ""
    if f"[{group}]" not in text:
        return
    origin = _origin(_text(info / head), info.stem)
    for line in map(str.strip, text.splitlines()):
        if line.startswith("["):
            section = line.strip("[]")
        elif section == group and "=" in line and not line.startswith("#"):
            name, _, value = line.partition("=")
            yield Point(name.strip(), value.strip(), origin)


def _origin(head: str, stem: str) -> str:
    """Return the name and the version of a distribution; its folder's where it does not say."""
    said = dict(re.findall(r"^(Name|Version): *(\S+)", head.partition("\n\n")[0], re.M))
    name, _, version = stem.partition("-")
    return f"{said.get('Name', name)} {said.get('Version', version)}"


def _text(path: Path) -> str:
    """Return a file as text, nothing for one that cannot be read."""
    with suppress(OSError):
        return path.read_text("utf-8", errors="replace")
    return ""

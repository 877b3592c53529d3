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
        for stem, info, head in _distributions(folder):
            name = re.sub("[-_.]+", "-", stem.partition("-")[0]).lower()
            if name not in found:
                found[name] = list(_points(stem, info, head, group))
    return [point for points in found.values() for point in points]


def _distributions(folder: str) -> Iterator[tuple[str, str, str]]:
    """Yield the folders that describe distributions: name without its end, path, name of the head.

    They are sorted, and paths are texts: there are hundreds.
    """
    names: list[str] = []
    with suppress(OSError):  # no folder: an archive, or what is no longer there
        names = sorted(os.listdir(folder or "."))
    for name in names:
        if name.endswith("-info"):
            stem, end = os.path.splitext(name)
            if end in HEADS:
                yield stem, os.path.join(folder, name), HEADS[end]


def _points(stem: str, info: str, head: str, group: str) -> Iterator[Point]:
    """Yield the entry points of a distribution."""
    text, section = _text(info, "entry_points.txt"), ""
    if f"[{group}]" not in text:
        return
    origin = _origin(_text(info, head), stem)
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


def _text(folder: str, name: str) -> str:
    """Return a file as text, nothing for one that cannot be read."""
    try:
        with open(os.path.join(folder, name), encoding="utf-8", errors="replace") as file:
            return file.read()
    except OSError:
        return ""

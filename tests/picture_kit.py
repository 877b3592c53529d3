"""What the tests of pictures share: what an SVG holds, and the figures of a table."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree

SVG = "{http://www.w3.org/2000/svg}"


def drawn(file: str) -> tuple[dict[str, ElementTree.Element], str]:
    """Return the groups of an SVG by their names, and all that is written in it."""
    root = ElementTree.parse(file).getroot()
    groups = {group.get("id", ""): group for group in root.iter(f"{SVG}g")}
    return groups, "\n".join(t.text or "" for t in root.iter(f"{SVG}text"))


def corners(group: ElementTree.Element) -> int:
    """Return how many points a curve has."""
    return len(re.findall("[ML]", "".join(path.get("d", "") for path in group.iter(f"{SVG}path"))))


def figures(stdout: str) -> dict[str, tuple[float, float]]:
    """Return the table by the names in it: before and after, um."""
    rows = re.findall(r"^(\S+ +\S.*?) +(-?[\d.]+|-) +(-?[\d.]+|-)$", stdout, re.MULTILINE)
    return {" ".join(name.split()): (before, after) for name, before, after in rows}


def assert_png(file: Path) -> None:
    """Assert that a picture opens and that there is something on it."""
    from matplotlib.image import imread

    picture = imread(file)
    assert picture.shape[0] > 400
    assert 0.5 < (picture[:, :, :3] == 1.0).all(axis=2).mean() < 0.995

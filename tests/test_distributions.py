"""The entry points of what is installed are those that `importlib.metadata` finds."""

from __future__ import annotations

import importlib.metadata
from pathlib import Path

import pytest

from gcxform.plugin.distributions import entry_points

FILES = {
    "acme_gx-1.0.dist-info": "[other]\nx = y\n[gcxform.plugins]\n# no\n acme = acme:a.b [extra]\n",
    "Acme.GX-2.0.dist-info": "[gcxform.plugins]\nhidden = behind\n",  # the same distribution
    "old.egg-info": "[gcxform.plugins]\nold=old_plugin\nsecond = old_plugin : name\n",
    "none-3.dist-info": "[console_scripts]\nnone = none:main\n",
}


def found(group: str) -> list[tuple[str, str, str]]:
    """Return entry points as the standard library finds them."""
    points = importlib.metadata.entry_points(group=group)
    said = [(p.name, p.value, f"{p.dist.name} {p.dist.version}") for p in points if p.dist]
    return sorted(said)


@pytest.mark.parametrize("group", ["gcxform.plugins", "console_scripts", "pytest11", "nothing"])
def test_what_is_installed_here(group: str) -> None:
    assert sorted(entry_points(group)) == found(group)


def test_folders_of_every_kind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder, text in FILES.items():
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "entry_points.txt").write_text(text)
        name, _, version = folder.rpartition(".")[0].partition("-")
        head = "PKG-INFO" if folder.endswith("egg-info") else "METADATA"
        said = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version or '0.5'}\n\nName: not this"
        (tmp_path / folder / head).write_text(said)
    (tmp_path / "archive.zip").write_bytes(b"PK")
    for path in (tmp_path / "missing", tmp_path / "archive.zip", tmp_path):
        monkeypatch.syspath_prepend(str(path))
    points = [point for point in entry_points("gcxform.plugins") if point.name != "builtin"]
    assert [tuple(point) for point in points] == [
        ("hidden", "behind", "Acme.GX 2.0"),
        ("old", "old_plugin", "old 0.5"),
        ("second", "old_plugin : name", "old 0.5"),
    ]


def test_a_point_names_a_module_or_what_is_in_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "pointed_at.py").write_text("class A:\n    b = 5\n")
    info = tmp_path / "pointing-1.dist-info"
    info.mkdir()
    text = "[g]\nin = pointed_at : A.b [x]\nwhole = pointed_at\nlost = pointed_at:C\n"
    (info / "entry_points.txt").write_text(text)
    monkeypatch.syspath_prepend(str(tmp_path))
    inside, whole, lost = entry_points("g")
    assert inside.load() == 5
    assert getattr(whole.load(), "A").b == 5  # noqa: B009
    assert inside.origin == "pointing 1"
    with pytest.raises(AttributeError):
        lost.load()

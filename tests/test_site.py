"""The manual as a site: built without a warning, its links followed, its commands pasted.

The guides are gone through as a newcomer does, from a copy of the repository and `pip install` to
the first program that is proved. With HYPOTHESIS_PROFILE=long that happens in an environment in
which nothing is, and to the last command of each guide; otherwise what gcxform needs is borrowed
from the environment of the tests.
"""

from __future__ import annotations

import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest
from cli_kit import call
from matplotlib import image

import gcxform as gx
from gcxform.catalogue import CATALOGUE
from gcxform.cli import VERBS
from gcxform.contract.options import describe
from gcxform.plugin.registry import default_registry

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
SAME_PICTURE = 0.002  # mean difference of what is drawn, of 1: fonts differ, not lines
MOST_STEPS = 5  # from nothing to the first proved program
CLONE = ("pyproject.toml", "README.md", "LICENSE", "gcxform", "plugins", "grammars", "examples")
PROVED = re.compile(r'PASS$|verified"?: [Tt]rue', re.MULTILINE)
GUIDES = ("hobby", "job-shop", "measuring", "five-axes", "cam", "python", "dialect", "pass")
LONG = os.environ.get("HYPOTHESIS_PROFILE") == "long"
WHOLE = GUIDES if LONG else ("dialect",)  # which installs a plugin

pytestmark = pytest.mark.xdist_group("site")


@dataclass(frozen=True)
class Copied:
    """What the button of a block of code copies: a console's commands, or a file's text."""

    language: str
    title: str
    text: str


@dataclass
class Page(HTMLParser):
    """What a built page has: anchors, links, what it loads, and what can be copied from it."""

    text: str
    ids: set[str] = field(default_factory=set)
    links: list[str] = field(default_factory=list)
    loads: list[str] = field(default_factory=list)
    copied: list[Copied] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__()
        self._code, self._spans, self._title, self._language = "", list[str](), "", ""
        self._inside = self._titled = False
        self.feed(self.text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        said = {key: value or "" for key, value in attrs}
        self.ids.update(filter(None, [said.get("id", ""), said.get("name", "")]))
        if tag == "a" and "href" in said:
            self.links.append(said["href"])
        elif tag == "link":
            self.loads.append(said["href"])
        elif "src" in said:
            self.loads.append(said["src"])
        if found := re.match(r"(?:language-(\w+) )?highlight", said.get("class", "")):
            self._language = found[1] or ""
        if tag == "code":
            self._inside, self._code = True, ""
        if tag == "span":
            self._spans.append(said.get("class", ""))
            self._titled = said.get("class") == "filename"

    def handle_endtag(self, tag: str) -> None:
        if tag == "span" and self._spans:
            self._spans.pop()
        if tag == "code":
            self._inside = False
        if tag == "pre":
            self.copied.append(Copied(self._language, self._title, self._code))
            self._title = ""

    def handle_data(self, data: str) -> None:
        if self._titled:
            self._title, self._titled = data, False
        elif self._inside and not {"gp", "go"} & set(self._spans):  # as assets/manual.css
            self._code += data


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    return folder


@cache
def page(path: Path) -> Page:
    return Page(path.read_text("utf-8"))


def pages(site: Path) -> dict[Path, Page]:
    return {path: page(path) for path in sorted(site.rglob("*.html"))}


# --- links ---


def test_links_inside_lead_to_pages_and_anchors(site: Path) -> None:
    lost = []
    for path, found in pages(site).items():
        base = site if path.name == "404.html" else path.parent  # which is shown anywhere
        for link in [*found.links, *found.loads]:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (base / unquote(parts.path).lstrip("/")).resolve() if parts.path else path
            if not target.is_file() or (parts.fragment and not _has(target, parts.fragment)):
                lost.append(f"{path.relative_to(site)}: {link}")
    assert not lost


def _has(target: Path, fragment: str) -> bool:
    return target.suffix != ".html" or fragment in page(target).ids


def test_links_out_are_well_formed(site: Path) -> None:
    for path, found in pages(site).items():
        for link in found.links:
            parts = urlsplit(link)
            if parts.scheme:
                assert parts.scheme == "https", (path, link)
                assert re.fullmatch(r"[\w-]+(\.[\w-]+)+", parts.netloc), (path, link)


def test_nothing_is_loaded_from_elsewhere(site: Path) -> None:
    for path, found in pages(site).items():
        assert not [link for link in found.loads if urlsplit(link).netloc], path


# --- the reference ---


def test_the_reference_has_all_there_is(site: Path) -> None:
    registry = default_registry()
    names = ("passes", "dialects", "diagnostics", "verbs", "api", "models", "machine")
    reference = {name: page(site / "reference" / f"{name}.html") for name in names}
    for name, step in registry.passes.items():
        assert name in reference["passes"].ids
        assert all(f">{o.name}</code>" in reference["passes"].text for o in describe(step))
    for name, dialect in registry.dialects.items():
        assert name in reference["dialects"].ids
        if dialect.translator is None:
            text = reference["dialects"].text
            assert all(re.search(rf"\b{code}\b", text) for code in dialect.codes)
    assert {code.lower() for code in CATALOGUE} <= reference["diagnostics"].ids
    assert {f"gcxform-{verb}" for verb in VERBS} <= reference["verbs"].ids
    assert "gcxform-machine-jog" in reference["verbs"].ids
    headings = set(re.findall(r'<h3 id="[^"]*">(\w+)<', reference["api"].text))
    assert headings == set(gx.__all__)
    for kind, where in (("formats", "models"), ("kinematics", "machine"), ("presets", "machine")):
        assert all(f"<code>{n}</code>" in reference[where].text for n in getattr(registry, kind))


# --- pictures ---


def test_the_picture_of_the_door_is_what_its_command_draws(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As it looks, not its bytes; UPDATE_DOCS=1 draws it anew."""
    shown = (DOCS / "start.md").read_text("utf-8")
    (command,) = re.findall(r"^\$ gcxform (show .*bracket.png .*)$", shown, re.MULTILINE)
    monkeypatch.chdir(tmp_path)
    shutil.copytree(ROOT / "examples", "examples")
    assert call(*shlex.split(command)).exit_code == 0
    kept = DOCS / "pictures" / "bracket.png"
    if os.environ.get("UPDATE_DOCS"):
        shutil.copy("bracket.png", kept)
    drawn, wanted = image.imread("bracket.png"), image.imread(kept)
    assert drawn.shape == wanted.shape
    assert np.abs(drawn - wanted).mean() < SAME_PICTURE


# --- what is pasted ---


@dataclass(frozen=True)
class Step:
    """One thing that a reader does: save a file of a name, or run a command."""

    save: str
    text: str


def steps(found: Page) -> Iterator[Step]:
    """Yield what a page tells to do, in its order."""
    for block in found.copied:
        if block.title:
            yield Step(block.title, block.text)
        elif block.language == "console":
            yield from (Step("", line) for line in block.text.splitlines() if line)


@pytest.mark.parametrize("guide", sorted(path.stem for path in (DOCS / "guides").glob("*.md")))
def test_what_is_copied_is_what_is_tested(guide: str, site: Path) -> None:
    """The commands of a built page are those of its source, which test_docs.py runs."""
    source = (DOCS / "guides" / f"{guide}.md").read_text("utf-8")
    shown = re.findall(r"^```console\n(.*?)^```$", source, re.MULTILINE | re.DOTALL)
    wanted = re.findall(r"^\$ (.*)$", "".join(shown), re.MULTILINE)
    found = steps(page(site / "guides" / f"{guide}.html"))
    assert [step.text for step in found if not step.save] == wanted


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the repository, as far as a newcomer needs it."""
    folder = tmp_path_factory.mktemp("clone")
    junk = shutil.ignore_patterns("__pycache__", "out")
    for name in CLONE:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=junk)
        else:
            shutil.copy(source, folder / name)
    return folder


@pytest.fixture(scope="module")
def shell(clone: Path, site: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Return the variables of a shell in whose environment gcxform was installed, as shown."""
    place = tmp_path_factory.mktemp("environment") / "venv"
    variables = {**os.environ, "PATH": f"{place / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    if LONG:
        subprocess.run([sys.executable, "-m", "venv", str(place)], check=True)
    else:
        _borrow(place)
        variables |= {"PIP_NO_DEPS": "1", "PIP_NO_INDEX": "1", "PIP_NO_BUILD_ISOLATION": "0"}
    variables["PIP_DISABLE_PIP_VERSION_CHECK"] = "1"
    install = next(b.text for b in page(site / "start.html").copied if "pip install" in b.text)
    done = subprocess.run(install, shell=True, cwd=clone, env=variables, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()
    return variables


def _borrow(place: Path) -> None:
    """Make an environment that finds the libraries of this one, and no gcxform."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", str(place)], check=True)
    paths = {"base": str(place), "platbase": str(place)}
    theirs = Path(sysconfig.get_path("purelib", vars=paths))
    (theirs / "borrowed.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    pip = place / "bin" / "pip"
    pip.write_text(f'#!/bin/sh\nexec {place / "bin" / "python"} -m pip "$@"\n')
    pip.chmod(0o755)


@pytest.mark.parametrize("guide", GUIDES)
def test_a_newcomer_comes_to_a_proved_program(
    guide: str, site: Path, shell: dict[str, str], tmp_path: Path
) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("out"))
    proved = 0
    for number, step in enumerate(steps(page(site / "guides" / f"{guide}.html")), start=3):
        if step.save:
            (tmp_path / step.save).write_text(step.text, "utf-8")
            continue
        done = subprocess.run(
            ["bash", "-c", step.text], cwd=tmp_path, env=shell, capture_output=True, text=True
        )
        assert done.returncode == 0, (step.text, done.stderr)
        if not proved and PROVED.search(done.stdout + done.stderr):
            proved = number  # the first steps were the clone and its installation
            if guide not in WHOLE:
                break
    assert 0 < proved <= MOST_STEPS

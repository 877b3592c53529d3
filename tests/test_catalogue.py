"""Every code that is raised is explained, and every explanation is of a code that is raised."""

from __future__ import annotations

import re
from pathlib import Path

import gcxform_plugins
import pytest

import gcxform
from gcxform.catalogue import CATALOGUE, PARTS

PACKAGES = (gcxform, gcxform_plugins)
CODE = re.compile(r"\bGX[0-9]{3}\b")


def used() -> set[str]:
    found: set[str] = set()
    for package in PACKAGES:
        root = Path(str(package.__file__)).parent
        for path in root.rglob("*.py"):
            if path.parent.name != "catalogue":
                found.update(CODE.findall(path.read_text("utf-8")))
    return found


def test_every_code_in_the_sources_is_explained() -> None:
    assert used() - set(CATALOGUE) == set()


def test_every_explanation_is_of_a_code_in_the_sources() -> None:
    assert set(CATALOGUE) - used() == set()


def test_codes_are_in_order() -> None:
    assert list(CATALOGUE) == sorted(CATALOGUE)


def test_no_code_stands_in_two_files() -> None:
    parts = [module.CODES for module in PARTS]
    assert sum(len(codes) for codes in parts) == len(CATALOGUE)


@pytest.mark.parametrize("code", CATALOGUE)
def test_an_entry_has_a_short_title_and_a_few_sentences(code: str) -> None:
    title, text = CATALOGUE[code]
    assert CODE.fullmatch(code)
    assert 0 < len(title) <= 72
    assert not title.endswith(".")
    sentences = re.findall(r"[.?](?=\s|$)", text)
    assert 1 <= len(sentences) <= 6, text
    assert text.endswith((".", "?"))
    assert "  " not in text
    assert "- " not in text


def test_titles_tell_codes_apart() -> None:
    shared = {"GX402", "GX403", "GX710", "GX701"}  # the same in two kinds of files
    titles = [title for code, (title, _) in CATALOGUE.items() if code not in shared]
    assert len(titles) == len(set(titles))

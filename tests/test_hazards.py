"""The table of hazards: each hazard is in it, each case it names is there and does what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from test_corpus import all_cases, name

TABLE = Path(__file__).with_name("hazards.md")
ROW = re.compile(r"\| (H-\d+a?) \| ([^|]+) \| (H|R|C|open|-) \| ([^|]+) \|")
RANGES = [(1, 11), (20, 42), (50, 78), (80, 110), (120, 150)]
BY_NAME = {name(case.path): case for case in all_cases()}


def rows():
    """Return id, hazard, what gcxform does, and cases or reason."""
    lines = [line for line in TABLE.read_text("utf-8").splitlines() if line.startswith("| H-")]
    matches = [ROW.fullmatch(line) for line in lines]
    assert None not in matches
    return [match.groups() for match in matches]


def cases(cell):
    return re.findall(r"`([^`]+)`", cell)


def test_every_hazard_is_in_the_table_once():
    expected = [f"H-{n:02}" for low, high in RANGES for n in range(low, high + 1)]
    expected += ["H-12a", "H-13a", "H-14a", "H-15a"]
    assert sorted(row[0] for row in rows()) == sorted(expected)


def test_the_catalogue_has_no_other_hazards(shared):
    text = (shared / "reference" / "dialects.md").read_text("utf-8")
    known = set(re.findall(r"^\| (H-\d+a?) \|", text, re.MULTILINE))
    assert known == {row[0] for row in rows()}


@pytest.mark.parametrize("row", rows(), ids=lambda row: row[0])
def test_a_hazard_has_a_case_or_a_reason(row):
    _, _, does, cell = row
    named = cases(cell)
    if does in ("open", "-"):
        assert not named
        assert cell.strip()
        return
    assert named
    assert not set(named) - set(BY_NAME), "no such case"
    refused = [bool(BY_NAME[one].diagnostics) for one in named]
    assert any(refused) if does == "R" else not all(refused)

"""`./run-tests --since REV` leaves out no test file that can notice a change."""

from __future__ import annotations

import pytest
import since
from faults import MUTATIONS

FORWARD = "plugins/gcxform_plugins/passes/volumetric/forward/arcs.py"


def left_out(path: str) -> set[str]:
    return set(since.test_files()) - since.depending(path)


def test_what_notices_a_fault_is_chosen_for_its_file() -> None:
    paths = since.names()
    noticing = {(fault.file, fault.tests.split("::")[0]) for fault in MUTATIONS}
    assert [(file, test) for file, test in noticing if paths[test] in left_out(file)] == []


@pytest.mark.parametrize(
    ("path", "run", "left"),
    [
        (FORWARD, {"test_volumetric", "test_corpus", "test_kit", "test_docs"}, {"test_rigid"}),
        ("plugins/gcxform_plugins/dialects/fagor/blocks.py", {"test_fagor"}, {"test_bundle"}),
        ("gcxform/syntax/scan.py", {"properties.test_reading", "test_cli"}, {"test_distinct"}),
        ("gcxform/cli/resume.py", {"test_resume"}, {"test_rigid", "test_arcs"}),
        ("gcxform/comparison.py", {"properties.test_twins"}, {"test_rigid", "test_guess"}),
        ("tests/rtcp_kit.py", {"test_rtcp"}, {"test_guess", "test_corpus"}),
        ("tests/test_guess.py", {"test_guess"}, {"test_corpus"}),
        ("corpus/absolute/none.case", {"test_corpus", "properties.test_chains"}, {"test_bundle"}),
        ("README.md", {"test_docs"}, {"test_bundle"}),
        ("docs/guides/cam.md", {"test_docs", "test_site"}, {"test_bundle"}),
    ],
)
def test_what_is_run_and_what_is_left_out(path: str, run: set[str], left: set[str]) -> None:
    assert not run & left_out(path)
    assert left <= left_out(path)


@pytest.mark.parametrize(
    "path",
    [
        "tests/conftest.py",
        "pyproject.toml",
        "gcxform/__init__.py",
        "grammars/x.lark",
        "page.md",
    ],
)
def test_what_is_not_understood_chooses_everything(path: str) -> None:
    assert not left_out(path)


def test_nothing_is_chosen_where_nothing_has_changed() -> None:
    assert since.chosen([]) == set()


def test_files_that_git_does_not_know_have_changed(monkeypatch, tmp_path) -> None:
    monkeypatch.setattr(since, "ROOT", tmp_path)
    since.subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    setting = ["-c", "user.name=n", "-c", "user.email=e"]
    words = ["git", *setting, "commit", "-q", "--allow-empty", "-m", "first"]
    since.subprocess.run(words, cwd=tmp_path, check=True)
    (tmp_path / "a file.py").touch()
    assert since.changed_since("HEAD") == ["a file.py"]

"""The mutations still fit the source; `./run-tests --mutations` runs them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import mutations
import pytest
import swapping

TWO = """
import sys, mutations
from faults.mutation import Mutation
def heap(*words): return Mutation(*words, "tests/test_heap.py")
mutations.MUTATIONS = (
    heap("harmless", "gcxform/system/heap.py", "what it does not use", "what is not used"),
    heap("harmful", "gcxform/system/heap.py", "self._trim(0)", "self._trim(1)"),
    heap("syntax", "gcxform/system/heap.py", "self._trim(0)", "self._trim(0"),
)
mutations.IMPORTED = ()
noticed = "tests/test_heap.py::test_what_a_process_has_is_known"  # it is no more so
mutations.remembered = lambda: {"harmful": noticed, "harmless": "tests/test_heap.py::test_gone"}
sys.exit(mutations.main(["--jobs", "2"]))
"""


def test_every_mutation_fits_the_source() -> None:
    assert mutations.problems() == []
    assert len({m.name for m in mutations.MUTATIONS}) == len(mutations.MUTATIONS) >= 20
    assert all(m.old != m.new for m in mutations.MUTATIONS)


def test_a_mutation_is_caught_by_a_test_that_fails_and_by_nothing_else() -> None:
    folder = Path(mutations.__file__).parent
    command = [sys.executable, "-c", TWO]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    words = {line.split()[0]: line.split()[1:] for line in done.stdout.splitlines() if line}
    assert done.returncode == 1, done.stdout + done.stderr
    assert words["harmless"][0] == "SURVIVED"
    assert words["harmful"][0] == "caught"
    assert words["harmful"][-1].startswith("tests/test_heap.py::test_more_than_at_first")
    assert words["syntax"][0] == "BROKEN"
    assert "1 of 3 mutations are caught" in done.stdout


SOURCE = """
TABLE = {"a": 1, "b": lambda x: x + 1}
def plain(x, y=1):
    return x + y
class Kind:
    size: int = 2
    def grown(self):
        return [self.size + k for k in range(3)]
"""


@pytest.mark.parametrize(
    ("old", "new", "functions"),
    [
        ("x + y", "x - y", {"plain"}),
        ("range(3)", "range(4)", {"Kind.grown"}),
        ("self.size + k", "self.size - k", {"Kind.grown"}),
        ("x + 1", "x + 1.0", {"<lambda>"}),
        ("x + y", "y + x\n", {"plain"}),
        ("y=1", "y=2", None),
        ("size: int = 2", "size: int = 3", None),
        ('"a": 1', '"a": True', None),
        ("def plain", "@print\ndef plain", None),
        ("plain", "plane", None),
    ],
)
def test_only_what_differs_within_functions_is_swapped(old, new, functions) -> None:
    file = Path("a.py")
    pairs = list(
        swapping.changed(
            swapping.compiled(file, SOURCE), swapping.compiled(file, SOURCE.replace(old, new))
        )
    )
    if functions is None:
        assert (None, None) in pairs
    else:
        assert {before.co_qualname for before, _ in pairs if before} == functions


def test_what_ran_or_is_not_known_is_not_swapped() -> None:
    file = Path("a.py")
    space: dict[str, object] = {}
    code = swapping.compiled(file, SOURCE)
    exec(code, space)
    plain = space["plain"]
    loaded = swapping.Loaded({plain.__code__: [plain]})  # type: ignore[attr-defined]
    assert not loaded.swapped(file, SOURCE, SOURCE.replace("range(3)", "range(4)"))
    assert not loaded.swapped(file, SOURCE, SOURCE.replace("x + y", "x +"))
    ran = swapping.Loaded(loaded.functions, {plain.__code__})  # type: ignore[attr-defined]
    assert not ran.swapped(file, SOURCE, SOURCE.replace("x + y", "x - y"))
    assert plain(5) == 6  # type: ignore[operator]
    assert loaded.swapped(file, SOURCE, SOURCE.replace("x + y", "x - y"))
    assert plain(5) == 4  # type: ignore[operator]

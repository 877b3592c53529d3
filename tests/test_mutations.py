"""The mutations still fit the source; `./run-tests --mutations` runs them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import mutations

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

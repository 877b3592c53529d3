"""What a mutation is, and the names that their tables share."""

from __future__ import annotations

import re
from dataclasses import dataclass

PASSES = "plugins/gcxform_plugins/passes"
VERIFY = "tests/test_verify.py"
CUTTING = "tests/test_cutting.py"
FIGURES = "tests/test_volumetric.py"
MIN_LENGTH = "tests/test_min_length.py"
INVERSE = "tests/test_inverse.py"
FOUND = "tests/properties/test_found.py"
CORPUS = "tests/test_corpus.py::test_case"
OFFSETS = "tests/test_corpus.py"
SHIFTS = "tests/properties/test_shifts.py::test_gcxform_reads_shifts_as_linuxcnc_does"
CUTTER = "tests/test_cutter_comp.py"
RIGID = "tests/test_rigid.py"
RIGID_PASS = "tests/test_rigid_pass.py"
KIT = "tests/test_kit.py::test_registered_passes"
LAWS = "tests/properties/test_laws.py"
ARCS = "tests/test_arcs.py"
CYCLES = "tests/test_cycles.py"
LIMITS = "gcxform/modal/control_limits.py"
FACTS = "tests/test_dialect_facts.py::test_our_facts"
READING = "tests/test_verify.py::test_the_proof_reads_as_the_control_does"

CASE = re.compile(r"test_corpus\.py::\w+\[(\S+)\]")


@dataclass(frozen=True)
class Mutation:
    """A fault: `old`, which stands once in `file`, becomes `new`; a test of `tests` must fail."""

    name: str
    file: str
    old: str
    new: str
    tests: str

    @property
    def files(self) -> set[str]:
        """The files of the fault, of the tests that notice it, and of the cases that these name.

        Not the one that runs all cases: they notice what they did before, if it is changed.
        """
        tests = {test.partition("::")[0] for test in self.tests.split()} - {OFFSETS}
        return {self.file, *tests, *(f"corpus/{case}.txt" for case in CASE.findall(self.tests))}

"""A control as a table in a distribution of its own: the guide is enough.

It imports what plugins may, keeps the contract of dialects, and reads what the control would do.
"""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path

import pytest

import gcxform as gx
from gcxform.testing import check_dialect

SOURCE = Path(__file__).parent / "controls_dist" / "src"
MAY = {"gcxform", "gcxform_plugins", "gcxform_controls", "collections", "dataclasses", "typing"}


@pytest.fixture(scope="module")
def controls():
    sys.path.insert(0, str(SOURCE))
    try:
        yield importlib.import_module("gcxform_controls")
    finally:
        sys.path.remove(str(SOURCE))


def test_it_keeps_the_contract(controls):
    (dialect,) = controls.gcxform_dialects()
    check_dialect(dialect)


def test_it_imports_what_plugins_may():
    for path in (SOURCE / "gcxform_controls").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert str(node.module).split(".")[0] in MAY


def test_what_its_host_ignores_is_refused(controls):
    with pytest.raises(gx.GcxformError, match="does nothing"):
        _ = gx.read(b"G21 G90\nG43 Z1.\nG0 X1.\nM30\n", controls.Carbide).path

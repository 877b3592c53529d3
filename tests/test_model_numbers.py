"""Numbers and names in model files that nobody writes on purpose: each is refused at its place."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest
from test_modelfile import HEAD, X, Z, refused
from test_rigid import lattice as grid_of_errors
from test_rigid import rigid as rigid_body

from gcxform.errormodel.lattice import Lattice
from gcxform.errormodel.model_file import load_model
from gcxform.errormodel.model_text import fingerprint, to_toml
from gcxform.errormodel.rigid import RigidBody

Y = X.replace("[X]", "[Y]").replace("X =", "Y =")
TURNS = "ECX = [0, 1e-6, 0]\n"


def rigid(tool: str = "[0, 0, 0]", at: str = "[0, 0, 0]") -> str:
    return f"{HEAD}tool = {tool}\n{X}at = {at}\n{TURNS}{Y}{Z}"


def lattice(x: str = "[0, 9]", ex: str = "[[[0]], [[0]]]", more: str = "") -> str:
    zeros = "[[[0]], [[0]]]"
    grid = f"X = {x}\nY = [0]\nZ = [0]\nEX = {ex}\nEY = {zeros}\nEZ = {zeros}\n"
    return f'format = 1\nkind = "lattice"\nvalues = "error"\n{grid}{more}'


def turns(tool: str) -> str:
    return f"tool = {tool}\n" + "".join(f"{n} = [[[0]], [[0]]]\n" for n in ("EA", "EB", "EC"))


def height_map(y: str) -> str:
    return f'format = 1\nkind = "height-map"\nX = [0, 1]\nY = {y}\nheight = [[0, 0], [0, 0]]\n'


NUMBERS = {
    "a tool of the functions": (rigid(tool="[0, nan, 0]"), "GX412", 5),
    "a tool that is endless": (rigid(tool="[-inf, 0, 0]"), "GX412", 5),
    "where the axes stood": (rigid(at="[0, nan, 0]"), "GX412", 11),
    "a tool of a lattice": (lattice(more=turns("[0, 0, inf]")), "GX412", 10),
    "a grid without an end": (lattice(x="[0, inf]"), "GX412", 4),
    "the one position of an axis": (lattice().replace("Y = [0]", "Y = [nan]"), "GX412", 5),
    "a height map": (height_map("[-inf, 0]"), "GX412", 4),
    "nested too little": (lattice(ex="[[0], [0]]"), "GX405", 7),
    "no list at all": (lattice(ex="0.0"), "GX405", 7),
    "a truth value": (lattice(ex="[[[true]], [[0]]]"), "GX405", 7),
    "a word": (lattice(ex='[[["0"]], [[0]]]'), "GX405", 7),
    "an empty list": (lattice(ex="[[], [[0]]]"), "GX410", 7),
    "too many rows": (lattice(ex="[[[0]], [[0]], [[0]]]"), "GX410", 7),
    "a whole number of 500 digits": (lattice(ex=f"[[[{'9' * 500}]], [[0]]]"), "GX405", 7),
    "numbers as large as there are": (lattice(ex="[[[1e308]], [[-1e308]]]"), "GX415", None),
    "nodes a hair apart": (lattice(x="[0, 5e-324]", ex="[[[0]], [[1e-3]]]"), "GX415", None),
    "a name no file can have": (
        'format = 1\nkind = "sum"\nmodels = ["a\\u0000b.toml"]\n', "GX401", 3
    ),
    "a file that is not there": ('format = 1\nkind = "sum"\nmodels = ["b.toml"]\n', "GX401", None),
}  # fmt: skip


@pytest.mark.parametrize(("text", "code", "line"), NUMBERS.values(), ids=NUMBERS)
def test_what_is_no_number_is_refused_at_its_place(tmp_path, text, code, line):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = refused(tmp_path, text)[0]
    assert found.code == code
    assert found.where is not None
    assert line is None or found.where.line == line


def test_numbers_of_numpy_are_written_as_numbers(tmp_path):
    tool = tuple(np.array([1.0, 2.0, -90.0]))
    for model in (rigid_body(3, tool=tool, at=(tool, tool, tool)), grid_of_errors(2)):
        path = tmp_path / "model.toml"
        path.write_text(to_toml(replace(model, measured=tool)))
        assert load_model(path).tool.tolist() == [1.0, 2.0, -90.0]


def test_an_axis_without_limits_after_one_that_turns_has_no_bound():
    """Its travel is a lever: files are refused (GX414), models of plugins by their bound."""
    x, *_ = rigid_body(1).axes
    with np.errstate(invalid="ignore"):
        assert RigidBody((x, None, None)).lipschitz() == math.inf


def test_models_of_other_shapes_have_other_fingerprints():
    values = np.zeros((2, 3, 1, 3))
    nodes = np.arange(5.0)
    wide = Lattice((nodes[:2], nodes[2:], np.zeros(1)), values)
    high = Lattice((nodes[:2], nodes[2:], np.zeros(1)), values.reshape(3, 2, 1, 3))
    assert fingerprint(wide) != fingerprint(high)

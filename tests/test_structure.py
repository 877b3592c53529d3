"""The shape of the packages: who may import whom, and no circles."""

from __future__ import annotations

from configparser import ConfigParser
from functools import cache
from pathlib import Path

import grimp
import pytest
from importlinter import Contract
from importlinter.contracts.layers import LayersContract

import gcxform as gx

ROOT = Path(__file__).parents[1]
ROOTS = ("gcxform", "gcxform_plugins")
MOST_ROWS = 25


def contract_file() -> ConfigParser:
    parser = ConfigParser()
    parser.read(ROOT / ".importlinter")
    return parser


def rows() -> list[list[str]]:
    """Return the layers of the core, the highest first; those of a row do not know one another."""
    text = contract_file()["importlinter:contract:layers"]["layers"]
    return [[name.strip() for name in row.split("|")] for row in text.split("\n") if row.strip()]


@cache
def graph(types: bool) -> grimp.ImportGraph:
    """Return all imports; `types`: those that only annotations need as well."""
    return grimp.build_graph(
        *ROOTS, "gcxform_grammars", exclude_type_checking_imports=not types, cache_dir=None
    )


# --- layers ---


def layers_contract() -> Contract:
    options = dict(contract_file()["importlinter:contract:layers"])
    several = {
        key: [line.strip() for line in options[key].split("\n") if line.strip()]
        for key in ("layers", "containers")
    }
    roots = [*ROOTS, "gcxform_grammars"]
    roots_and_types = {"root_packages": roots, "exclude_type_checking_imports": "True"}
    return LayersContract(
        options["name"], roots_and_types, {**several, "exhaustive": options["exhaustive"]}
    )


def keeps(contract: Contract, imports: grimp.ImportGraph) -> bool:
    return bool(contract.check(imports, verbose=False).kept)


def test_the_contract_is_short_and_names_every_package() -> None:
    assert len(rows()) <= MOST_ROWS
    assert contract_file()["importlinter:contract:layers"]["exhaustive"] == "true"
    assert keeps(layers_contract(), graph(False))


PAIRS = [(low, high[0]) for high, row in zip(rows(), rows()[1:], strict=False) for low in row]


@pytest.mark.parametrize(("low", "high"), PAIRS)
def test_a_new_file_falls_under_the_contract_by_where_it_lies(low: str, high: str) -> None:
    """One that imports what is above it breaks the lint, in each package."""
    planted = graph(False).__deepcopy__({})
    new = f"gcxform.{low}.planted" if (ROOT / "gcxform" / low).is_dir() else f"gcxform.{low}"
    planted.add_module(new)
    above = f"gcxform.{high}"
    planted.add_import(importer=new, imported=above, line_number=1, line_contents="planted")
    assert not keeps(layers_contract(), planted)


def test_a_new_package_must_be_given_its_place() -> None:
    planted = graph(False).__deepcopy__({})
    planted.add_module("gcxform.planted")
    assert not keeps(layers_contract(), planted)


# --- circles ---


def circles(imports: dict[str, set[str]]) -> list[list[str]]:
    """Return the groups of modules that import one another, by Tarjan's algorithm (1972)."""
    number: dict[str, int] = {}
    lowest: dict[str, int] = {}
    stack: list[str] = []
    found = []

    def visit(name: str) -> None:
        number[name] = lowest[name] = len(number)
        stack.append(name)
        for other in sorted(imports[name]):
            if other not in number:
                visit(other)
                lowest[name] = min(lowest[name], lowest[other])
            elif other in stack:
                lowest[name] = min(lowest[name], number[other])
        if lowest[name] == number[name]:
            at = stack.index(name)
            if len(stack) > at + 1:
                found.append(sorted(stack[at:]))
            del stack[at:]

    for name in sorted(imports):
        if name not in number:
            visit(name)
    return found


def test_circles_are_found() -> None:
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"d"}}) == [["b", "c"]]


LEFT = (
    "gcxform.flow",
    "gcxform.pipeline",
    "gcxform_plugins.passes.rtcp",
    "gcxform_plugins.passes.volumetric",
)
"""Packages inside of which modules still import one another, for types or late."""


def test_no_package_is_part_of_a_circle() -> None:
    imports = graph(True)
    every = {name: imports.find_modules_directly_imported_by(name) for name in imports.modules}
    for found in circles(every):
        inside = [at for at in LEFT if all(name.startswith(f"{at}.") for name in found)]
        assert inside, found


def test_no_module_hides_a_public_name() -> None:
    """`import gcxform.deviation` would set `gx.deviation`, and what it is would depend on order."""
    modules = {name.split(".")[1] for name in graph(False).modules if name.startswith("gcxform.")}
    assert not modules & set(gx.__all__)

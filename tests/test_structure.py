"""The shape of the packages: who may import whom, no circles, and no half-made objects."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from configparser import ConfigParser
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import grimp
import numpy as np
import pytest
from importlinter import Contract
from importlinter.contracts.layers import LayersContract
from trees_kit import statements, walk

import gcxform as gx

ROOT = Path(__file__).parents[1]
ROOTS = ("gcxform", "gcxform_plugins")
ORDERED = ("importlinter:contract:layers", "importlinter:contract:modal")
MOST_ROWS = 25


def contract_file() -> ConfigParser:
    parser = ConfigParser()
    parser.read(ROOT / ".importlinter")
    return parser


def rows(contract: str) -> list[list[str]]:
    """Return the layers of a contract, the highest first; those of a row do not know one another.

    Names are whole: with the package that contains the layers.
    """
    options = contract_file()[contract]
    inside = options["containers"].strip()
    rows = [row.split("|") for row in options["layers"].split("\n") if row.strip()]
    return [[f"{inside}.{name.strip()}" for name in row] for row in rows]


@cache
def graph(types: bool) -> grimp.ImportGraph:
    """Return all imports; `types`: those that only annotations need as well."""
    return grimp.build_graph(
        *ROOTS, "gcxform_grammars", exclude_type_checking_imports=not types, cache_dir=None
    )


# --- layers ---


def layers_contract(name: str) -> Contract:
    options = dict(contract_file()[name])
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


@pytest.mark.parametrize("contract", ORDERED)
def test_a_contract_of_layers_is_short_and_names_every_package(contract: str) -> None:
    assert len(rows(contract)) <= MOST_ROWS
    assert contract_file()[contract]["exhaustive"] == "true"
    assert keeps(layers_contract(contract), graph(False))


PAIRS = [
    (contract, low, high[0])
    for contract in ORDERED
    for high, row in zip(rows(contract), rows(contract)[1:], strict=False)
    for low in row
]


@pytest.mark.parametrize(("contract", "low", "high"), PAIRS)
def test_a_new_file_falls_under_its_contract_by_where_it_lies(
    contract: str, low: str, high: str
) -> None:
    """One that imports what is above it breaks the lint, in each package."""
    planted = graph(False).__deepcopy__({})
    new = f"{low}.planted" if (ROOT / low.replace(".", "/")).is_dir() else low
    planted.add_module(new)
    planted.add_import(importer=new, imported=high, line_number=1, line_contents="planted")
    assert not keeps(layers_contract(contract), planted)


@pytest.mark.parametrize("contract", ORDERED)
def test_a_new_package_must_be_given_its_place(contract: str) -> None:
    planted = graph(False).__deepcopy__({})
    planted.add_module(f"{rows(contract)[0][0].rpartition('.')[0]}.planted")
    assert not keeps(layers_contract(contract), planted)


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


def test_no_package_is_part_of_a_circle() -> None:
    imports = graph(True)
    every = {name: imports.find_modules_directly_imported_by(name) for name in imports.modules}
    assert not circles(every)


# --- contracts ---

MOST_MEMBERS = 12


def test_the_contract_of_a_pass_is_small() -> None:
    members = {name for name in vars(gx.Pass) if not name.startswith("_")}
    assert len(members) <= MOST_MEMBERS, sorted(members)


@dataclass(frozen=True)
class InAbsoluteWords(gx.Pass):
    name = "in-absolute-words"

    def apply(self, path: gx.Toolpath, context: gx.PassContext) -> gx.Toolpath:
        incremental = np.zeros_like(path.blocks.incremental)
        return path.replace(blocks=replace(path.blocks, incremental=incremental))


def test_a_pass_of_two_members_runs() -> None:
    """What a newcomer has to write is a name and `apply`; the run is proved like any other."""
    pipeline = gx.Pipeline("linuxcnc", "linuxcnc", [InAbsoluteWords()])
    result = pipeline.run(b"G21 G90 G94\nG1 X1 Y2 Z3 F100\nG91\nX1\nX1\nM2\n")
    assert result.certificate.verified
    assert [line for line in result.text.splitlines() if line.startswith(b"X")] == [b"X2.", b"X3."]


def test_no_module_hides_a_public_name() -> None:
    """`import gcxform.deviation` would set `gx.deviation`, and what it is would depend on order."""
    modules = {name.split(".")[1] for name in graph(False).modules if name.startswith("gcxform.")}
    assert not modules & set(gx.__all__)


# --- files ---

LONGEST = 400  # lines


def test_no_file_is_longer_than_it_can_be_read() -> None:
    files = {
        file.relative_to(ROOT).as_posix(): len(file.read_text("utf-8").splitlines())
        for part in ("gcxform", "plugins", "grammars")
        for kind in ("*.py", "page/*.js")
        for file in (ROOT / part).rglob(kind)
    }
    assert len(files) > 350
    assert "gcxform/view/page/main.js" in files
    assert [name for name, lines in files.items() if lines > LONGEST] == []


# --- array types ---


def test_array_types_have_one_home() -> None:
    alias = re.compile(r"NDArray\[np\.(float64|int64|int8|uint8|bool_)\]")
    parts = [ROOT / "gcxform", ROOT / "plugins", ROOT / "tests"]
    files = [file for part in parts for file in part.rglob("*.py")]
    assert [file.name for file in files if alias.search(file.read_text())] == ["arrays.py"]


# --- objects are whole when they are made ---

MAKING = ("__init__", "__post_init__", "__new__")
FIELDS = ("dataclass", "NamedTuple", "Protocol")
"""Decorators and bases under which a bare annotation is a field that the maker must give."""
PLANTED = """
class Base:
    def __init__(self):
        self.known = self.counted = 0

@dataclass
class Planted(Base):
    given: int
    late: int = field(init=False)

    def good(self):
        self.known, self.given, self.counted = 1, 2, 3
        other.elsewhere = 4

    def bad(self):
        self.plain = self.chained = 1
        self.left, (self.right, *self.rest) = pair
        self.annotated: int = 1
        self.summed += 1
        self.late = 1
        for self.looped in (): pass
        with place as self.opened: pass
        [0 for self.drawn in ()]
        object.__setattr__(self, "forced", 1)
        setattr(self, "set", 1)
        self.__dict__["smuggled"] = 1
        def inner():
            self.nested = 1

class Bare:
    promised: int
    def begin(self):
        self.promised = 1
"""


def last_name(node: ast.expr) -> str:
    """Return the last name of an expression such as `gx.Pass[T]` or `dataclass(frozen=True)`."""
    while isinstance(node, ast.Subscript | ast.Call):
        node = node.value if isinstance(node, ast.Subscript) else node.func
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def assigned(method: ast.FunctionDef) -> Iterator[str]:
    """Yield the attributes that a method gives its first argument."""
    own = [each.arg for each in (*method.args.posonlyargs, *method.args.args)][:1]
    for node in walk(method):
        on = node.value if isinstance(node, ast.Attribute | ast.Subscript) else None
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store):
            yield from (node.attr for _ in own if getattr(on, "id", "") == own[0])
        elif isinstance(node, ast.Subscript) and getattr(on, "attr", "") == "__dict__":
            yield ast.unparse(node.slice).strip("'")
        elif isinstance(node, ast.Call) and last_name(node) in ("__setattr__", "setattr"):
            taken = ast.unparse(node.args[0]) if node.args else ""
            yield from (ast.unparse(node.args[1]).strip("'") for name in own if name == taken)


def methods(node: ast.ClassDef, making: bool) -> Iterator[str]:
    """Yield what the methods that make an object assign, or what the others do."""
    for each in node.body:
        if isinstance(each, ast.FunctionDef) and (each.name in MAKING) == making:
            yield from assigned(each)


def is_given(node: ast.ClassDef, field: ast.AnnAssign) -> bool:
    """Return whether an annotation of a class body gives the attribute to every object."""
    if isinstance(field.value, ast.Call) and last_name(field.value) == "field":
        options = {each.arg: ast.unparse(each.value) for each in field.value.keywords}
        return options.get("init") != "False" or bool({"default", "default_factory"} & set(options))
    makers = [last_name(each) for each in (*node.decorator_list, *node.bases)]
    return field.value is not None or any(each in FIELDS for each in makers)


def declared(node: ast.ClassDef) -> Iterator[str]:
    """Yield the attributes that every object of a class has, those of its bases apart."""
    yield from methods(node, making=True)
    for each in node.body:
        if isinstance(each, ast.FunctionDef):
            yield each.name
        elif isinstance(each, ast.AnnAssign) and is_given(node, each):
            yield last_name(each.target)
        elif isinstance(each, ast.Assign):
            yield from (name.id for name in walk(each) if isinstance(name, ast.Name))


def born_late(texts: dict[str, str]) -> dict[str, set[str]]:
    """Return, per class, the attributes that are assigned only after it was made.

    `texts`: the source of modules. A base is the class of its name that its module defines or
    imports, and any class of its name where it is reached in another way (`gx.Pass`).
    """
    nodes = [(name, node) for name, text in texts.items() for node in statements(ast.parse(text))]
    classes = {(name, node.name): node for name, node in nodes if isinstance(node, ast.ClassDef)}
    origin = {
        (module, name.asname or name.name): (node.module or "", name.name)
        for module, node in nodes
        if isinstance(node, ast.ImportFrom)
        for name in node.names
    }

    @cache
    def whole(at: tuple[str, str]) -> set[str]:
        found = set(declared(classes[at]))
        for base in map(last_name, classes[at].bases):
            exact = [(at[0], base), origin.get((at[0], base), ("", ""))]
            known = [each for each in exact if each in classes and each != at]
            for each in known[:1] or [key for key in classes if key[1] == base and key != at]:
                found |= whole(each)
        return found

    late = {f"{at[0]}.{at[1]}": set(methods(classes[at], False)) - whole(at) for at in classes}
    return {name: attributes for name, attributes in late.items() if attributes}


def test_late_births_are_found() -> None:
    bad = "plain chained left right rest annotated summed late looped opened drawn forced set"
    expected = {*bad.split(), "smuggled", "nested"}
    assert born_late({"m": PLANTED}) == {"m.Planted": expected, "m.Bare": {"promised"}}


def test_objects_are_whole_when_they_are_made() -> None:
    """What comes later belongs into what a function returns."""
    texts = {
        ".".join(file.relative_to(ROOT / root).with_suffix("").parts): file.read_text("utf-8")
        for root in (".", "plugins")
        for file in (ROOT / root).glob("gcxform*/**/*.py")
    }
    assert len(texts) > 350
    assert born_late(texts) == {}

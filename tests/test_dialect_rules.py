"""A dialect is few facts: rules, each with few fields that say what they mean and that are read."""

from __future__ import annotations

import ast
import re
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

import gcxform as gx
import gcxform.dialect

ROOT = Path(__file__).parents[1]
MOST_FACTS = 25
MOST_FIELDS = 12


def facts() -> set[str]:
    """Return what a dialect can say; methods, which say nothing of a control, are left out."""
    public = {n for n in (*vars(gx.Dialect), *gx.Dialect.__annotations__) if not n.startswith("_")}
    return {name for name in public if not isinstance(vars(gx.Dialect).get(name), classmethod)}


def defined() -> list[type]:
    """Return the dataclasses of which dialects are made."""
    names = [module.name for module in iter_modules(gcxform.dialect.__path__)]
    modules = [import_module(f"gcxform.dialect.{name}") for name in names]
    found = [c for module in modules for c in vars(module).values() if isinstance(c, type)]
    return sorted({c for c in found if is_dataclass(c)}, key=lambda c: c.__name__)


RULES = [kind for kind in defined() if kind.__name__.endswith("Rule") or kind is gx.CutterComp]


def test_a_dialect_is_at_most_25_facts() -> None:
    assert len(facts()) <= MOST_FACTS


@pytest.mark.parametrize("kind", defined(), ids=lambda kind: kind.__name__)
def test_no_rule_is_a_bag(kind: type) -> None:
    assert len(fields(kind)) <= MOST_FIELDS  # type: ignore[arg-type]
    assert kind.__dataclass_params__.frozen  # type: ignore[attr-defined]


@pytest.mark.parametrize("rule", RULES, ids=lambda kind: kind.__name__)
def test_a_rule_says_what_each_of_its_fields_means(rule: type) -> None:
    said = set(re.findall(r"\w+", rule.__doc__ or ""))
    assert {field.name for field in fields(rule)} <= said  # type: ignore[arg-type]


def read_somewhere() -> set[str]:
    """Return the attributes that are read, other than by dialects of others of theirs."""
    names = set()
    for folder in ("gcxform", "plugins/gcxform_plugins"):
        for path in (ROOT / folder).rglob("*.py"):
            if "gcxform_plugins/dialects/" not in path.as_posix():
                nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
                names |= {node.attr for node in nodes if isinstance(node, ast.Attribute)}
    return names


def test_every_fact_is_read_where_it_is_obeyed() -> None:
    told = {field.name for rule in RULES for field in fields(rule)}  # type: ignore[arg-type]
    assert not (facts() | told) - read_somewhere()


def test_the_page_for_authors_names_every_fact() -> None:
    page = (ROOT / "docs" / "guides" / "dialect.md").read_text(encoding="utf-8")
    rows = [line for line in page.splitlines() if line.startswith("| `")]
    assert {n for row in rows for n in re.findall(r"`(\w+)`", row.split("|")[1])} == facts()

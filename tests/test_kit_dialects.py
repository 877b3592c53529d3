"""The kit: every registered dialect keeps its contract, and broken ones are caught."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import ClassVar

import pytest

import gcxform as gx
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_dialect


@pytest.mark.by_turns
@pytest.mark.parametrize("name", sorted(default_registry().dialects))
def test_registered_dialects(name):
    check_dialect(default_registry().dialects[name])


# --- broken dialects ---


class Plain(gx.Dialect):
    """The common part."""

    name = "plain"


class Undocumented(Plain):
    pass


class NoGrammar(Plain):
    """A grammar that is not there."""

    grammar = ("gcxform_grammars", "none")


class NoInitial(Plain):
    """A group without initial code."""

    initial: ClassVar[Mapping[str, str]] = {"motion": "G0"}


class StrangeCode(Plain):
    """A modal code that the core cannot follow."""

    codes: ClassVar[Mapping[str, gx.Code]] = {**gx.Dialect.codes, "G316": gx.Code("polar")}


class StrangeWord(Plain):
    """A code that takes a word the dialect does not have."""

    codes: ClassVar[Mapping[str, gx.Code]] = {
        **gx.Dialect.codes,
        "G59.9": gx.Code("frame"),
    }


class TooFine(Plain):
    """Nine decimals."""

    numbers = gx.NumberFormat(mm=9)


class NoZ(Plain):
    """A lathe that is none."""

    axes = "XZ"


class NoRapid(Plain):
    """A control without G0."""

    codes: ClassVar[Mapping[str, gx.Code]] = {
        name: code for name, code in gx.Dialect.codes.items() if name != "G0"
    }


def test_a_good_dialect():
    check_dialect(Plain)


@pytest.mark.parametrize(
    ("broken", "said"),
    [
        (Undocumented, "no docstring"),
        (NoGrammar, "does not load"),
        (NoInitial, "initial['plane']"),
        (StrangeCode, "the core has no group 'polar'"),
        (StrangeWord, "does not know"),
        (TooFine, "9 decimals"),
        (NoZ, "X, Y and Z come first"),
        (NoRapid, "there is G1 and no G0"),
    ],
    ids=lambda value: value.__name__ if isinstance(value, type) else "",
)
def test_broken_dialects(broken, said):
    with pytest.raises(AssertionError, match=re.escape(said)):
        check_dialect(broken)


def test_what_nothing_reads_is_refused():
    """Such as a fact that has moved into a rule: it would be left out without a word."""
    with pytest.raises(TypeError, match=r"Old\.arc_planes: gcxform\.Dialect has no arc_planes"):
        type("Old", (Plain,), {"arc_planes": frozenset({"XY"})})
    mixed = type("Mixed", (), {"comments": "("})
    with pytest.raises(TypeError, match=r"Mixed\.comments: gcxform\.Dialect has no comments"):
        type("Old", (mixed, Plain), {})


@pytest.mark.parametrize("value", [None, {"planes": {"XY"}}, gx.ArcRule, gx.FeedRule()])
def test_a_rule_of_another_type_is_refused(value):
    with pytest.raises(TypeError, match=r"Odd\.arc_rule is no ArcRule"):
        type("Odd", (Plain,), {"arc_rule": value})

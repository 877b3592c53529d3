"""TextMate grammars split lines as lark does: on every line of the corpus that it accepts."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from cli_kit import call
from lark.exceptions import UnexpectedInput
from seeds_kit import LONG

from gcxform.cli.editing.highlighting import grammar_of, highlighting, patterns_of, scope_of
from gcxform.plugin.registry import default_registry
from gcxform.testing.cases import read_case

ROOT = Path(__file__).parents[1]
DIALECTS = default_registry().dialects
Match = Callable[[str, int], tuple[int, int] | None]
OF_GRAMMARS = {
    dialect.grammar if dialect.translator is None else dialect.translator.grammar: name
    for name, dialect in DIALECTS.items()
}.values()
"""A dialect for each grammar: by it alone lines are split."""


@cache
def corpus() -> dict[str, set[str]]:
    """Return the lines of the corpus by their dialect."""
    found: dict[str, set[str]] = defaultdict(set)
    for path in (ROOT / "corpus").rglob("*.txt"):
        if "bytes" not in path.parts:
            case = read_case(path)
            named = re.search(r'\[input\].*?dialect = "(\w+)"', case.text("pipeline.toml"), re.S)
            if named:
                text = case.sections["input.nc"].decode("latin-1")
                found[named[1]] |= set(text.splitlines())
    return found


def kin_of(name: str) -> str:
    """Return a dialect whose lines one may read as well."""
    return DIALECTS[name].kin or name


def by_re(pattern: str) -> Match:
    compiled = re.compile(pattern)

    def match(line: str, at: int) -> tuple[int, int] | None:
        found = compiled.search(line, at)
        return found.span() if found else None

    return match


def by_oniguruma(pattern: str) -> Match:
    """Return what an editor does; places are bytes there, which is the same in ASCII."""
    engine = pytest.importorskip("onigurumacffi", reason="onigurumacffi is not installed")
    compiled = engine.compile(pattern)

    def match(line: str, at: int) -> tuple[int, int] | None:
        found = compiled.search(line, at)
        return found.span() if found else None

    return match


def coloured(line: str, patterns: list[tuple[str, Match]]) -> list[str]:
    """Return the scope of each character as an editor finds it: what begins first, then the order.

    A pattern is not asked again before the place where it was found last.
    """
    scopes, at = [""] * len(line), 0
    ahead: dict[int, tuple[int, int] | None] = {}
    while at < len(line):
        for k, (_, match) in enumerate(patterns):
            if k not in ahead or ((known := ahead[k]) is not None and known[0] < at):
                ahead[k] = match(line, at)
        spans = [(s[0], k, s[1]) for k, s in ahead.items() if s is not None and s[1] > s[0]]
        if not spans:
            break
        start, k, end = min(spans)
        scopes[start:end] = [patterns[k][0]] * (end - start)
        at = end
    return scopes


@pytest.mark.parametrize("engine", [by_re, by_oniguruma])
@pytest.mark.parametrize("name", OF_GRAMMARS)
def test_lines_are_split_as_lark_does(name: str, engine: Callable[[str], Match]) -> None:
    grammar = grammar_of(DIALECTS[name])
    patterns = [(scope, engine(pattern)) for _, scope, pattern in patterns_of(DIALECTS[name])]
    read = 0
    lines = sorted(each for each in corpus()[name] | corpus()[kin_of(name)] if each.isascii())
    for line in lines[:: 1 if LONG else 4]:
        try:
            tree = grammar.parse(line)
        except UnexpectedInput:
            continue
        found = coloured(line, patterns)
        read += 1
        for token in tree.scan_values(lambda value: hasattr(value, "type")):
            here = {*found[token.start_pos : token.start_pos + len(token)]}
            assert here == {scope_of(token.type)}, (line, token.type, here)
    assert read > 5


@pytest.mark.parametrize("engine", [by_re, by_oniguruma])
@pytest.mark.parametrize(
    ("name", "line", "word", "scope"),
    [
        ("siemens", "LOOP:", "LOOP:", "keyword.control"),
        ("siemens", "N10 HERE:", "HERE:", "entity.name.label"),
        ("heidenhain", "11 L IX-5,5 FQ1 M9", "Q1", "variable.parameter"),
    ],
)
def test_words_that_look_like_others(
    name: str, line: str, word: str, scope: str, engine: Callable[[str], Match]
) -> None:
    patterns = [(each, engine(pattern)) for _, each, pattern in patterns_of(DIALECTS[name])]
    begin = line.index(word)
    assert {*coloured(line, patterns)[begin : begin + len(word)]} == {scope}


@pytest.mark.parametrize("name", DIALECTS)
def test_a_grammar_is_printed_as_editors_read_it(name: str) -> None:
    printed: dict[str, Any] = json.loads(call("lsp", "--highlighting", name).stdout)
    assert printed == highlighting(DIALECTS[name])
    assert printed["scopeName"] == f"source.gcode.{name}"
    assert {"comment.line.gcode", "constant.numeric.gcode"} <= {
        each["name"] for each in printed["patterns"]
    }

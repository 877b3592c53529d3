"""A chain of passes as it is typed on the command line: `absolute | segment chord-error=5um`."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Final, NamedTuple

from gcxform.contract.options import Argument
from gcxform.contract.tolerance_warnings import doubts_of
from gcxform.diagnostics import Diagnostic, Location, UsageError
from gcxform.pipeline.file import Step, built
from gcxform.plugin.registry import Registry

CHAIN: Final = "-x"

_TOKEN = re.compile(r"""(?P<bar>\|)|(?P<word>(?:[^\s|"']|"[^"]*"|'[^']*')+)|(?P<quote>["'])""")
_NAME = re.compile(r"[a-z]+(?:-[a-z]+)*")
_QUOTED = re.compile(r""""([^"]*)"|'([^']*)'""")


class _Words(NamedTuple):
    """One step of a chain: the name of its pass and its options, all with their columns."""

    name: re.Match[str]
    options: list[re.Match[str]]


def parse_chain(text: str, base: Path, registry: Registry) -> list[Step]:
    """Return the passes of a chain, `absolute | segment chord-error=5um`, built.

    Values with blanks stand in quotes. Relative paths are relative to `base`. Raises UsageError
    with columns of the text.
    """
    text = re.sub(r"\s", " ", text)
    steps: list[Step] = []
    found: list[Diagnostic] = []
    for words in _split(text):
        try:
            steps.append(_chain_step(words, text, base, registry))
        except UsageError as error:
            found += error.diagnostics
    if found:
        raise UsageError(tuple(found))
    return steps


def chain_doubts(text: str) -> tuple[Diagnostic, ...]:
    """Return warnings about tolerances in a chain that `parse_chain` takes."""
    found: list[Diagnostic] = []
    text = re.sub(r"\s", " ", text)
    for words in _split(text):
        for token in words.options:
            key, _, value = token[0].partition("=")
            found += doubts_of({key: Argument(value)}, _at(text, token))
    return tuple(found)


def _at(text: str, token: re.Match[str]) -> Callable[[str], Location]:
    """Return what gives the place of a word of a chain, whatever key is asked for."""
    return lambda key: _place(text, token)


def _place(text: str, token: re.Match[str]) -> Location:
    return Location(CHAIN, 1, token.start() + 1, text, len(token[0]))


def _split(text: str) -> list[_Words]:
    """Return the steps of a chain; a chain of blanks has none."""
    steps: list[_Words] = []
    bar: re.Match[str] | None = None
    fresh = True  # whether the next word begins a step
    for token in _TOKEN.finditer(text):
        if token["quote"]:
            raise UsageError.one("GX712", "the quote is not closed", _place(text, token))
        if token["word"] and fresh:
            steps.append(_Words(token, []))
        elif token["word"]:
            steps[-1].options.append(token)
        elif fresh:
            message = "there is no pass before this |"
            raise UsageError.one("GX712", message, _place(text, token))
        bar, fresh = token, bool(token["bar"])
    if bar is not None and fresh:
        raise UsageError.one("GX712", "there is no pass after this |", _place(text, bar))
    return steps


def _chain_step(words: _Words, text: str, base: Path, registry: Registry) -> Step:
    places = {"use": _place(text, words.name)}
    options: dict[str, Argument] = {}
    for token in words.options:
        key, equals, value = token[0].partition("=")
        if not equals or not key:
            message = f"{token[0]!r} is not an option, which is key=value"
            meant = _several(text, registry) or f"{words.name[0].rstrip(',;')} | {token[0]}"
            hint = f"separate passes by |: {meant}"
            raise UsageError.one("GX712", message, _place(text, token), hint)
        if key in options:
            raise UsageError.one("GX712", f"{key!r} is given twice", _place(text, token))
        options[key] = Argument(_QUOTED.sub(lambda quoted: quoted[1] or quoted[2] or "", value))
        places[key] = _place(text, token)
    if words.name[0] not in registry.passes and (meant := _several(words.name[0], registry)):
        message = f"{words.name[0]!r} is not one pass"
        raise UsageError.one("GX712", message, places["use"], f"separate passes by |: {meant}")
    chosen = registry.pass_(words.name[0], places["use"])
    return built(chosen, options, base, registry, lambda key: places.get(key, places["use"]))


def _several(text: str, registry: Registry) -> str:
    """Return the passes that a text names with something else between them, as a chain; or ""."""
    names = [each for each in _NAME.findall(text.lower()) if each in registry.passes]
    return " | ".join(names) if len(names) > 1 else ""

"""Options of the command line that are derived from a dataclass of options, as passes have them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import click

from gcxform.contract.options import Argument, OptionDoc, build, describe
from gcxform.diagnostics import Location, UsageError
from gcxform.plugin.registry import default_registry
from gcxform.system.limits import Limits

Built = TypeVar("Built")
Command = TypeVar("Command", bound=Callable[..., Any])


def options_of(target: type) -> Callable[[Command], Command]:
    """Return a decorator that adds an option for each field of a dataclass."""

    def decorate(command: Command) -> Command:
        for doc in reversed(describe(target)):
            command = click.option(
                f"--{doc.name}", metavar=metavar_of(doc), required=doc.mandatory, help=help_of(doc)
            )(command)
        return command

    return decorate


def metavar_of(doc: OptionDoc) -> str:
    """Return how the value of an option is called."""
    words = {"error model": "FILE", "three lengths": "X,Y,Z", "whole number": "N"}
    return doc.example or words.get(doc.type, "|".join(doc.choices) or doc.type.upper())


def help_of(doc: OptionDoc) -> str:
    """Return the help of an option, with its default."""
    text = f"{doc.help[:1].upper()}{doc.help[1:]}."
    return f"{text}  [default: {doc.default}]" if doc.default else text


def limits_of(given: Sequence[str]) -> Limits:
    """Return the limits of words like `rows=2000000`. Raises UsageError."""
    where = Location("--limit")
    pairs = [text.partition("=") for text in given]
    if wrong := [text for text, (key, equals, _) in zip(given, pairs, strict=True) if not equals]:
        hint = "write --limit rows=2000000"
        raise UsageError.one("GX702", f"{wrong[0]!r} is not a limit and its value", where, hint)
    raw = {key.strip(): Argument(value.strip()) for key, _, value in pairs}
    return build(Limits, raw, Path.cwd(), (), lambda key: where, "--limit")


def built(target: type[Built], given: Mapping[str, Any], owner: str) -> Built:
    """Return the dataclass from what the command line says. Raises UsageError."""
    raw = {
        name.replace("_", "-"): Argument(value)
        for name, value in given.items()
        if value is not None
    }
    formats = default_registry().formats.values()
    return build(target, raw, Path.cwd(), formats, lambda key: Location(f"--{key}"), owner)

"""The page of the Python API, made from what `import gcxform` offers."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator

from reference import described

import gcxform as gx

TOPICS = {
    "Programs and runs": ("api", "pipeline", "comparison", "guess", "system"),
    "Errors": ("diagnostics", "config"),
    "Toolpaths": ("toolpath", "deviations"),
    "Passes": ("contract",),
    "Dialects": ("dialect", "syntax", "flow"),
    "Error models": ("errormodel",),
    "Machines": ("machine",),
    "Plugins": ("plugin",),
}
"""Where names stand: the part of the core that they come from, by topic."""


def api() -> Iterator[str]:
    """Yield a section for each topic, and a heading for each name, which is its anchor."""
    for topic, parts in TOPICS.items():
        yield from (f"## {topic}", "")
        for name in gx.__all__:
            if part_of(name) in parts:
                yield from _entry(name)


def part_of(name: str) -> str:
    """Return the package of the core that a public name comes from."""
    return str(gx._HOMES[name]).split(".")[1]


def _entry(name: str) -> Iterator[str]:
    thing = getattr(gx, name)
    yield from (f"### {name}", "")
    if inspect.isclass(thing) or inspect.isfunction(thing):
        yield from ("```text", signature(name, thing), "```", "")
        yield from described(inspect.getdoc(thing) or "")
        yield from _methods(thing)
    else:
        yield from (_value(name, thing), "")


def signature(name: str, thing: object) -> str:
    """Return how a name is called, an argument a line where one line is too long."""
    try:
        found = inspect.signature(thing)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return name
    words = re.sub(r"'([^',]*)'", r"\1", str(found)).removesuffix(" -> None")
    line = f"{name}{words}"
    if len(line) <= 90 or len(found.parameters) < 2:
        return line
    arguments = [re.sub(r"'([^',]*)'", r"\1", str(p)) for p in found.parameters.values()]
    return f"{name}(\n" + "".join(f"    {a},\n" for a in arguments) + ")"


def _methods(thing: object) -> Iterator[str]:
    """Yield what a class can do: its public methods and properties that say so."""
    rows = []
    for name, member in vars(thing).items() if inspect.isclass(thing) else ():
        inner = getattr(member, "__func__", getattr(member, "fget", member))
        doc = (inspect.getdoc(inner) or "").partition("\n\n")[0]
        if name.startswith("_") or not inspect.isfunction(inner) or not doc:
            continue
        rows.append(f"- `{name}`: {' '.join(next(described(doc)).split())}")
    if rows:
        yield from (*rows, "")


def _value(name: str, thing: object) -> str:
    """Return what is said of a constant or an alias: its value, and the comment beneath it."""
    said = _string_under(name)
    meaning = getattr(thing, "meaning", "")
    return said or (f"A fact: {meaning}." if meaning else f"`{name}` is `{thing!r}`.")


def _string_under(name: str) -> str:
    module = importlib.import_module(gx._HOMES[name])
    found = re.search(rf'^{name}\b[^\n]*=.*?\n"""(.*?)"""', inspect.getsource(module), re.M | re.S)
    return next(described(found[1])) if found and found[0].count("\n\n") == 0 else ""

"""The page of the Python API, made from what `import gcxform` offers."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator
from enum import Enum

from reference import described, prose

import gcxform as gx

TOPICS = {
    "Programs and runs": ("api", "pipeline", "comparison", "guess", "system"),
    "Errors": ("diagnostics", "catalogue", "config"),
    "Toolpaths": ("toolpath", "deviations"),
    "Passes": ("contract",),
    "Dialects": ("dialect", "syntax", "flow"),
    "Error models": ("errormodel",),
    "Machines": ("machine",),
    "Plugins": ("plugin",),
}
"""Where names stand: the part of the core that they come from, by topic."""
REST = "What else there is"
LONGEST = 90  # characters of a signature in one line


def api() -> Iterator[str]:
    """Yield a section for each topic, and a heading for each name, which is its anchor."""
    for topic in (*TOPICS, REST):
        names = [name for name in gx.__all__ if topic_of(name) == topic]
        if names:
            yield from (f"## {topic}", "")
        for name in names:
            yield from _entry(name)


def topic_of(name: str) -> str:
    """Return the topic of a public name."""
    part = str(gx._HOMES[name]).split(".")[1]
    return next((topic for topic, parts in TOPICS.items() if part in parts), REST)


def _entry(name: str) -> Iterator[str]:
    thing = getattr(gx, name)
    yield from (f"### {name}", "")
    if inspect.isclass(thing) and issubclass(thing, Enum):
        yield from described(inspect.getdoc(thing) or "")
        yield from (f"Members: {', '.join(f'`{member}`' for member in thing.__members__)}.", "")
    elif inspect.isclass(thing) or inspect.isfunction(thing):
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
    said = [_argument(parameter) for parameter in found.parameters.values()]
    returned = _type(found.return_annotation)
    arrow = "" if returned in ("", "None") else f" -> {returned}"
    line = f"{name}({', '.join(said)}){arrow}"
    if len(line) <= LONGEST:
        return line
    return f"{name}(\n" + "".join(f"    {a},\n" for a in said) + f"){arrow}"


def _argument(parameter: inspect.Parameter) -> str:
    """Return an argument with its type and default, as one writes it."""
    words, default = str(parameter.replace(annotation=parameter.empty)), parameter.default
    if (annotation := _type(parameter.annotation)) and default is not parameter.empty:
        shown = "..." if repr(default) == "<factory>" else repr(default)
        return f"{parameter.name}: {annotation} = {shown}"
    return f"{words}: {annotation}" if annotation else words


def _type(annotation: object) -> str:
    """Return a type in words; of an option its type alone."""
    if annotation is inspect.Parameter.empty:
        return ""
    words = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "")
    return re.sub(r"^Annotated\[(.+?), Option\(.*", r"\1", words or str(annotation))


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
    """Return what is said of a constant or an alias."""
    if said := _string_under(name):
        return said
    for kind in getattr(thing, "__metadata__", ()):
        return f"The type of an option that takes: {kind.words}."
    return f"A fact: {prose(thing.meaning)}." if isinstance(thing, gx.Fact) else ""


def _string_under(name: str) -> str:
    module = importlib.import_module(gx._HOMES[name])
    found = re.search(rf'^{name}\b[^\n]*=.*?\n"""(.*?)"""', inspect.getsource(module), re.M | re.S)
    return next(described(found[1])) if found and found[0].count("\n\n") == 0 else ""

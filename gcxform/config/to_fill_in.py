"""Values that a file leaves to be filled in: "?" says nothing, as if the key were not there.

A tool or a work offset of which one value is open is not there at all: half of it would be read as
if the rest were 0.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any, Final

from gcxform.catalogue.questions import Question, questions
from gcxform.config.toml_text import TomlText
from gcxform.diagnostics import Diagnostic, Location

TO_FILL_IN: Final = "?"
WHOLE: Final = ("tool", "work-offset")
Keys = tuple[str, ...]
Open = Mapping[Keys, Location]
"""The place of each value that is open, by its keys."""


def split_open(
    document: TomlText, tables: tuple[str, ...]
) -> tuple[TomlText, dict[Keys, Location]]:
    """Return a file without the values in some tables that are open, and where those are."""
    found: dict[Keys, Location] = {}

    def walk(node: Any, keys: Keys) -> Any:
        if not isinstance(node, dict):
            return node
        kept = {}
        for key, value in node.items():
            if value == TO_FILL_IN:
                found[*keys, key] = document.where(*keys, key)
            else:
                kept[key] = walk(value, (*keys, key))
        return kept

    values = {k: walk(v, (k,)) if k in tables else v for k, v in document.values.items()}
    for table, name, *_ in found:
        if table in WHOLE:
            values[table].pop(name, None)
    return replace(document, values=values), found


def told_open(diagnostics: Iterable[Diagnostic], places: Open) -> Iterator[Diagnostic]:
    """Yield diagnostics, of which those that ask for a value say where a file leaves it open."""
    for each in diagnostics if places else ():
        asked = {_place(question) for question, _ in questions(each.hint)}
        still = [where for question, where in places.items() if _place(question) in asked]
        found = f'; still "?" at {", ".join(dict.fromkeys(map(str, still[:3])))}' if still else ""
        yield replace(each, hint=each.hint + found)
    yield from () if places else diagnostics


def _place(question: Question) -> Question:
    """Return the table in which a question is answered, that of one tool for any."""
    return question[:1] if question[0] in ("tool", "work-offset", "home") else question

"""Files that a user fills in, with more to be filled in: what stands there keeps its bytes.

New keys go to the end of their table, new tables to the end of the file. Only the notes of keys
that are still open, `# needed by 3 of 40 programs`, are written anew.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any

from gcxform.catalogue.questions import Question
from gcxform.cli.program.settings_block import Notes, block, header, sections
from gcxform.config.to_fill_in import TO_FILL_IN
from gcxform.config.toml_text import locate_key
from gcxform.diagnostics import Location, UsageError
from gcxform.machine.control import offset_in_blocks

BYTE_ORDER_MARK = "\ufeff"
_NOTE = re.compile(r"# (needed|used)(:| by) ")


def with_questions(
    text: str, questions: Iterable[Question], notes: Notes, dialect: str, file: str
) -> str:
    """Return the text of a file in which questions are to be filled in; raises UsageError.

    Those that it answers are left as they are.
    """
    plain = text.removeprefix(BYTE_ORDER_MARK).replace("\r\n", "\n")
    before = _loaded(plain)
    lines = plain.rstrip("\n").split("\n")
    for name, group in sections(questions).items():
        new = [question for question in group if not _there(before, question)]
        _renew_notes(lines, [q for q in group if _open(before, q)], notes)
        at = _header(lines, name)
        if at is None and new:
            lines += ["", *block(new, notes, dialect)]
        elif at is not None:
            _insert(lines, at, new, notes, dialect)
    written = "\n".join(lines).lstrip("\n") + "\n"
    if not _keeps(before, _loaded(written)):
        message = "a table is spelled in a way in which no keys can be added to it"
        raise UsageError.one("GX435", message, Location(file), "give it a header of its own")
    mark = BYTE_ORDER_MARK if text.startswith(BYTE_ORDER_MARK) else ""
    return mark + (written.replace("\n", "\r\n") if "\r\n" in text else written)


def _loaded(text: str) -> dict[str, Any]:
    with suppress(tomllib.TOMLDecodeError):
        found = tomllib.loads(text)
        if isinstance(offsets := found.get("work-offset"), dict):
            found["work-offset"] = {offset_in_blocks(name): one for name, one in offsets.items()}
        return found
    return {}


def _at(values: Any, question: Question) -> Any:
    for key in question:
        values = values.get(key) if isinstance(values, dict) else None
    return values


def _there(values: dict[str, Any], question: Question) -> bool:
    return _at(values, question) is not None


def _open(values: dict[str, Any], question: Question) -> bool:
    return bool(_at(values, question) == TO_FILL_IN)


def _keeps(before: Any, after: Any) -> bool:
    """Whether all that was said is still said, and nothing else but what is to be filled in."""
    if isinstance(before, dict) and isinstance(after, dict):
        added = (_all_open(after[key]) for key in after.keys() - before.keys())
        return all(added) and all(_keeps(value, after.get(key)) for key, value in before.items())
    return bool(before == after)


def _all_open(value: Any) -> bool:
    return all(map(_all_open, value.values())) if isinstance(value, dict) else value == TO_FILL_IN


def _header(lines: Sequence[str], name: str) -> int | None:
    """Return the index of the line that opens a table, None if there is none."""
    wanted = _loaded(f"[{name}]")
    for index, line in enumerate(lines):
        if line.lstrip().startswith("[") and _loaded(line) == wanted:
            return index
    return None


def _insert(
    lines: list[str], at: int, questions: Sequence[Question], notes: Notes, dialect: str
) -> None:
    """Put keys at the end of a table that has a header, in place."""
    inline = [question for question in questions if _extended(lines, at, question)]
    rest = [question for question in questions if question not in inline]
    if rest:
        end = _end(lines, at)
        lines[end:end] = block(rest, notes, dialect)[1:]


def _end(lines: Sequence[str], at: int) -> int:
    """Return the index behind the last key of a table; comments above the next one are its own."""
    end = at + 1
    while end < len(lines) and not lines[end].lstrip().startswith("["):
        end += 1
    while end < len(lines) and end > at + 1 and re.fullmatch(r"\s*(#.*)?", lines[end - 1]):
        end -= 1
    return end


def _extended(lines: list[str], at: int, question: Question) -> bool:
    """Put a name into an inline table that stands on one line; whether there is one."""
    if len(question) < 3 or "." in header(question):
        return False
    for index in range(at + 1, _end(lines, at)):
        found = re.fullmatch(
            rf"(\s*{re.escape(question[1])}\s*=\s*\{{.*\S)(\s*\}}.*)", lines[index]
        )
        if found:
            key = question[2] if question[2].isalnum() else f'"{question[2]}"'
            lines[index] = f'{found[1]}, {key} = "{TO_FILL_IN}"{found[2]}'
            return True
    return False


def _renew_notes(lines: list[str], still_open: Iterable[Question], notes: Notes) -> None:
    """Write the notes above open keys anew, in place."""
    text = "\n".join(lines)
    for question in still_open:
        above = locate_key(text, question)[0] - 2
        if question in notes and above >= 0 and _NOTE.match(lines[above]):
            lines[above] = f"# {notes[question]}"

"""Questions as the text of files: a block of TOML to paste and fill in, and the same as options.

Each key has a comment: what it means, where the control shows it, and who asks. What is not known
stands there as "?", which a file may keep: it says nothing, and is refused where it is needed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence

from gcxform.catalogue.questions import PIPELINE, Question, meaning_of, shown_by
from gcxform.catalogue.settings import ON_COMMAND_LINE
from gcxform.config.to_fill_in import TO_FILL_IN as OPEN
from gcxform.machine.control import answers

DEEP = 2
"""Keys of a setting of the control by itself; one more table is what is said of a call."""
Notes = Mapping[Question, str]
"""Who asks a question, in words that follow "asked by"."""


def sections(asked: Iterable[Question]) -> dict[str, list[Question]]:
    """Return questions by the header of the table of a file in which their keys stand."""
    found: dict[str, list[Question]] = {}
    for question in asked:
        found.setdefault(header(question), []).append(question)
    return found


def header(question: Question) -> str:
    """Return the table of a question, as its header names it."""
    table, *name = question
    if table == "control" and len(question) > DEEP:
        return f"{table}.{name[0]}.{_quoted(name[1])}"
    return table if table in (PIPELINE, "control") else f"{table}.{_quoted(name[0])}"


def _quoted(name: str) -> str:
    return name if name.replace("-", "").replace("_", "").isalnum() else f'"{name}"'


def block(questions: Sequence[Question], notes: Notes, dialect: str) -> list[str]:
    """Return the lines of one table of a file: its header, and its keys with their comments."""
    lines, before = [f"[{header(questions[0])}]"], [""]
    for key, group in _keys(questions).items():
        said = list(comments(group, notes, dialect))
        lines += [] if said == before else said
        lines.append(f"{key} = {placeholder(group)}")
        before = said
    return lines


def _keys(questions: Iterable[Question]) -> dict[str, list[Question]]:
    """Return questions by their key; those of one inline table are together."""
    found: dict[str, list[Question]] = {}
    for question in questions:
        flat = question[0] == PIPELINE or (question[0] == "control" and len(question) <= DEEP)
        key = question[1] if flat else question[-1]
        found.setdefault(key, []).append(question)
    return found


def placeholder(group: Sequence[Question]) -> str:
    """Return the value of a key that is to be filled in."""
    if group[0][0] == PIPELINE and len(group[0]) == 3:
        return f"{{ {', '.join(f'{_quoted(q[2])} = {chr(34)}{OPEN}{chr(34)}' for q in group)} }}"
    return f'"{OPEN}"'


def comments(group: Sequence[Question], notes: Notes, dialect: str) -> Iterator[str]:
    """Yield the comments of a key: what it means, where it is shown, who asks."""
    first = group[0]
    yield f"# {meaning_of(first) or answers(first[1])}"
    if where := shown_by(first, dialect):
        yield f"# {dialect}: {where}"
    if note := notes.get(first):
        yield f"# {note}"


def options(questions: Iterable[Question]) -> str:
    """Return what of the questions the command line takes as options, "?" for the values."""
    words = []
    for key, group in _keys(q for q in questions if q[0] == PIPELINE).items():
        pairs = ",".join(f"{q[2]}={OPEN}" for q in group if len(q) == 3)
        words.append(f"{ON_COMMAND_LINE[PIPELINE, key]} '{pairs or OPEN}'")
    return " ".join(words)

"""TextMate grammars for highlighting, made from the grammars by which programs are read.

A terminal of the grammar becomes a pattern, in the order in which lark would try them. lark knows
besides which terminals may stand at a place; an editor does not, so the patterns are those that
need no more than the text: what stands for itself comes before what begins like it.
"""

from __future__ import annotations

from typing import Any, Final

from lark import Lark

from gcxform.dialect.dialect import Dialect
from gcxform.syntax import grammar_cache as kept

SCOPES: Final = {
    "comment.line": "COMMENT LONE MESSAGE",
    "constant.numeric": "NUMBER HEX",
    "string.quoted.double": "STRING",
    "keyword.other.address": "ADDRESS AXIS FEED SPEED PER RADIUS DELTA DR COMP TOOL_AXIS WORD",
    "keyword.other.code": "CODE M PATH CENTRE FAST AUTO STOP TOOL_CALL CALL COMMAND",
    "keyword.control": "IF THEN GOTO WHILE DO END FLOW KEYWORD M99_P OLD REPEAT",
    "keyword.operator": "SIGN POWER FACTOR LOGIC RELATION EQUAL PLUS MINUS INCREMENTAL AMBIGUOUS",
    "support.function": "FUNCTION ATAN",
    "variable.parameter": "PARAMETER SYSTEM ARRAY EXPRESSION ASSIGNMENT HASH",
    "entity.name.function": "OWORD PROGRAM_NAME HEADER STRUCTURE",
    "entity.name.label": "LABEL SEQUENCE",
    "entity.name": "NAME",
    "support.other": "STATEMENT BRACKETS OUTPUT REST TEXT",
    "punctuation": "BLOCK_DELETE PERCENT BLOCK_END FILLER COLON COMMA LSQB RSQB LPAR RPAR SLASH",
}
"""Scopes by the terminals, of whatever grammar, that have them; others are punctuation."""
_OF: Final = {name: scope for scope, names in SCOPES.items() for name in names.split()}
_AHEAD: Final = "|".join((r"(?:^[ \t]*", *(rf"(?<=^N[0-9]{{{n}}} )" for n in range(1, 6)))) + ")"
PLACES: Final = {
    "BLOCK_DELETE": r"^[ \t]*",
    **dict.fromkeys(("FLOW", "LABEL"), _AHEAD),
    "M99_P": r"(?:(?<=\])|(?<=\][ \t]))",
    "FUNCTION": r"(?<==)",
    "STRING": r"(?<=\b[A-Z]=)",
    "PARAMETER": r"(?<=[A-Z])",
}
"""Where a terminal stands that is another one elsewhere: there it is tried before all others."""
ONLY_THERE: Final = ("M99_P",)


def highlighting(dialect: type[Dialect]) -> dict[str, Any]:
    """Return the TextMate grammar of a dialect."""
    patterns = [
        {"match": pattern, "name": f"{scope}.gcode", "comment": name}
        for name, scope, pattern in patterns_of(dialect)
    ]
    return {
        "scopeName": f"source.gcode.{dialect.name}",
        "name": f"G-code ({dialect.name})",
        "fileTypes": [],
        "patterns": patterns,
    }


def grammar_of(dialect: type[Dialect]) -> Lark:
    """Return the grammar of the lines of a dialect's programs."""
    own = dialect.grammar if dialect.translator is None else dialect.translator.grammar
    return kept.grammar(*own)


def scope_of(terminal: str) -> str:
    """Return the scope of a terminal."""
    return _OF.get(_own(terminal), "punctuation")


def patterns_of(dialect: type[Dialect]) -> list[tuple[str, str, str]]:
    """Return names, scopes and patterns of a dialect's terminals, in the order to be tried in."""
    terminals = [each for each in grammar_of(dialect).terminals if "IGNORE" not in each.name]
    terminals.sort(
        key=lambda t: (-t.priority, -t.pattern.max_width, -len(t.pattern.value), str(t.name))
    )
    named = [(str(t.name), _own(str(t.name)), t.pattern.to_regexp()) for t in terminals]
    double = "NUMBER" in {name for name, _, _ in named}
    # a number has no sign where expressions are, for it is an operator there
    named = [each for each in named if not double or each[1] != "NUMBER" or each[0] == "NUMBER"]
    first = [(n, scope_of(n), f"{PLACES[own]}(?:{p})") for n, own, p in named if own in PLACES]
    named.sort(key=lambda each: each[1] == "BLOCK_DELETE")  # which stands elsewhere in few grammars
    return [*first, *((n, scope_of(n), p) for n, own, p in named if own not in ONLY_THERE)]


def _own(terminal: str) -> str:
    """Return a terminal's own name: lark puts the importing grammar's name in front."""
    return terminal.rsplit("__", 1)[-1]

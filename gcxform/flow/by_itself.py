"""Is a program a subprogram by itself? Asked of every program, so quickly.

Few programs have the sign that all of those have; what it takes to know is loaded for them alone.
"""

from __future__ import annotations

import re

from gcxform.dialect.dialect import Dialect
from gcxform.syntax.source import Source, has_sign

SIGNS = {
    "macro-b": re.compile(rb"M[ \t]*0*99(?![0-9])"),
    "o-words": re.compile(rb"ENDSUB\b"),
}
"""What the text of every such file has, by the language of its control."""


def is_subprogram(source: Source, dialect: type[Dialect]) -> bool:
    """Whether the program of a file returns to what has called it, and ends nothing."""
    rule = dialect.flow_rule
    sign = SIGNS.get("macro-b" if rule.m99_returns else rule.language)
    if sign is None or not any(has_sign(sign, each) for each in source.windows()):
        return False
    from gcxform.flow.subprogram_file import only_returns

    return only_returns(source, dialect)

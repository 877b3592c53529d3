"""What a dialect says of a language that is not written in blocks of words."""

from __future__ import annotations

import re
from typing import ClassVar, Protocol


class Language(Protocol):
    """How such a language is recognised; `flow.translation.Translator` is what reads it.

    grammar  package and name of the grammar of a line
    number   what the grammar's terminal NUMBER looks like, without groups
    signs    what programs in this language have, and those of other controls have not
    """

    grammar: ClassVar[tuple[str, str]]
    number: ClassVar[re.Pattern[str]]
    signs: ClassVar[re.Pattern[bytes]]

"""What a block of words looks like to who writes it in a language."""

from __future__ import annotations

import re

COMMENT = re.compile(r"\([^()]*\)")
WORD = re.compile(r"([A-Z])([-+]?[0-9.]+)")

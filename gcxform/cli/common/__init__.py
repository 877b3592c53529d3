"""What verbs share: options, files in and out, failures."""

from __future__ import annotations

from typing import Final

DEBUG: Final = "show_traceback"
"""The parameter of every verb that asks for the traceback of a bug."""

"""Tables by which two things would become one. That a control differs excuses none of it."""

from __future__ import annotations

from collections.abc import Iterator

from gcxform.dialect.codes import Effect
from gcxform.dialect.dialect import Dialect
from gcxform.modal.meaning.tables import GROUPS
from gcxform.testing import canon


def merged(dialect: type[Dialect]) -> Iterator[str]:
    """Yield what is wrong with a table, as sentences."""
    known = {*canon.WORK, *canon.MORE_WORK, *dialect.offset_rule.names}
    for name, code in dialect.codes.items():
        if code.effect is Effect.INERT and code.group in GROUPS:
            yield f"{name} is inert and would replace the codes of the group {code.group!r}"
        if code.act == "work" and not code.takes and name not in known:
            yield (
                f"{name} takes no word that says which work offset it is, and "
                f"offset_rule.names does not say it either"
            )
        numbers = set(code.takes) - set(dialect.axes)
        if code.effect is Effect.INERT and numbers and _is_an_act(name):
            yield (
                f"{name} is an act on other controls; where it is inert, no two values of "
                f"{sorted(numbers)} are told apart: make it an act, or a barrier"
            )


def _is_an_act(name: str) -> bool:
    """Whether a code is an act of frames or of places on all controls on which it is known."""
    return all(one.startswith("act ") for one in canon.MEANINGS.get(name, ("",)))

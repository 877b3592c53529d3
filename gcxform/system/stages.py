"""What long work is at, for whoever wants to show it; nobody listens unless it is asked for.

Work says what it does and, where that is known, which share of it is done. It costs a look at a
variable, so loops of many turns say so only now and then.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar

Listener = Callable[[str, float | None], object]
_LISTENER: ContextVar[Listener | None] = ContextVar("listener", default=None)


def stage(what: str, share: float | None = None) -> None:
    """Say what is being done, and which share of it is, from 0 to 1.

    An empty text says that nothing is being done just now: what is printed next is to stay.
    """
    listener = _LISTENER.get()
    if listener is not None:
        listener(what, share)


@contextmanager
def heard(listener: Listener) -> Iterator[None]:
    """Tell a listener what is being done until the block ends."""
    token = _LISTENER.set(listener)
    try:
        yield
    finally:
        _LISTENER.reset(token)

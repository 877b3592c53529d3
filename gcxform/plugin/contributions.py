"""What plugins offer of one kind, by name: things, or the places from which they are imported.

A plugin of many things names them and their places (`Later`), so that a run imports the dialect
and the passes that it uses. The names alone say what there is, and that no two are the same.
"""

from __future__ import annotations

from collections.abc import Callable, ItemsView, Iterator, Mapping, ValuesView
from contextlib import suppress
from importlib import import_module
from types import MappingProxyType
from typing import Generic, NamedTuple, TypeVar

Offer = TypeVar("Offer")


class Later(NamedTuple):
    """A thing that is imported when it is asked for: its name, and its place, `module:Class`."""

    name: str
    place: str

    def load(self) -> object:
        """Return the thing; raises whatever its module raises, and AttributeError."""
        module, _, name = self.place.partition(":")
        return getattr(import_module(module), name)


class Waiting(NamedTuple, Generic[Offer]):
    """A thing that is not imported yet: the call gives it, or None once it is said why not."""

    load: Callable[[], Offer | None]


class Offered(Mapping[str, Offer]):
    """Things by name; one that cannot be imported is left out as soon as it is asked for."""

    def __init__(self, given: Mapping[str, Offer] = MappingProxyType({})) -> None:
        self._things: dict[str, Offer | Waiting[Offer]] = dict(given)

    def add(self, name: str, thing: Offer | Waiting[Offer]) -> None:
        """Take a thing of a new name."""
        self._things[name] = thing

    def also(self, more: Mapping[str, Offer]) -> Offered[Offer]:
        """Return these things and more of other names."""
        both: Offered[Offer] = Offered()
        both._things = {**self._things, **more}
        return both

    def __getitem__(self, name: str) -> Offer:
        thing = self._things[name]
        if isinstance(thing, Waiting):
            loaded: Offer | None = thing.load()
            if loaded is None:
                del self._things[name]
                raise KeyError(name)
            self._things[name] = thing = loaded
        return thing

    def __iter__(self) -> Iterator[str]:
        return iter(tuple(self._things))

    def __len__(self) -> int:
        return len(self._things)

    def items(self) -> ItemsView[str, Offer]:
        """Return names and things, each imported when it is its turn."""
        return Items(self)

    def values(self) -> ValuesView[Offer]:
        """Return the things, each imported when it is its turn."""
        return Values(self)


class Items(ItemsView[str, Offer]):
    """The names and things of a kind, without those that cannot be imported."""

    def __init__(self, of: Mapping[str, Offer]) -> None:
        super().__init__(of)
        self.of = of

    def __iter__(self) -> Iterator[tuple[str, Offer]]:
        for name in self.of:
            with suppress(KeyError):
                yield name, self.of[name]


class Values(ValuesView[Offer]):
    """The things of a kind, without those that cannot be imported."""

    def __init__(self, of: Mapping[str, Offer]) -> None:
        super().__init__(of)
        self.of = of

    def __iter__(self) -> Iterator[Offer]:
        return (thing for _, thing in Items(self.of))

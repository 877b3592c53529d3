"""Dataclasses whose methods are compiled when they are first called.

`dataclasses.dataclass` writes up to six methods for each class as text and compiles them: half a
millisecond, and a run loads some two hundred classes, of which it makes objects of a third. Here
the fields are worked out at once, by the standard decorator, and the methods, by the same one, at
the first call. Whoever reads or checks the code may take it for the standard one; classes with a
base, or with methods, that need more care are left to that.
"""

from __future__ import annotations

import dataclasses
from dataclasses import MISSING, Field, FrozenInstanceError, fields
from types import FunctionType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from dataclasses import dataclass as dataclass
else:

    def dataclass(made=None, /, *, frozen=False, eq=True, slots=False):
        """Return a class as a dataclass, or, without one, what makes a class that."""
        if made is None:
            return lambda later: _dataclass(later, frozen, eq, slots)
        return _dataclass(made, frozen, eq, slots)


CARE = {"__init__", "__repr__", "__eq__", "__hash__", "__setattr__", "__delattr__", "__getstate__"}


def _dataclass(given: type, frozen: bool, eq: bool, slots: bool) -> Any:
    """Return a dataclass, with methods that are compiled later where that is as good."""
    if CARE & vars(given).keys() or any(map(dataclasses.is_dataclass, given.__mro__[1:])):
        return dataclasses.dataclass(given, frozen=frozen, eq=eq, slots=slots)
    given.__doc__ = given.__doc__ or given.__name__  # or its signature is looked for
    made: Any = dataclasses.dataclass(given, init=False, repr=False, eq=False, slots=slots)
    names = ["__init__", "__repr__", *(("__eq__",) if eq else ())]
    for name in [*names, *(("__hash__",) if eq and frozen else ())]:
        setattr(made, name, _Later(made, name, frozen))
    if eq and not frozen:
        made.__hash__ = None
    if frozen:
        _freeze(made, slots)
    return made


class _Later:
    """A method that is compiled when it is looked for, and then stands in this one's place."""

    def __init__(self, made: type, name: str, frozen: bool) -> None:
        self.made, self.name, self.frozen = made, name, frozen

    def __get__(self, thing: object, kind: type | None = None) -> Any:
        """Return the method, bound to an object if there is one."""
        method = _compiled(self.made, self.name, self.frozen)
        setattr(self.made, self.name, method)
        return method.__get__(thing, kind)


def _compiled(made: type, name: str, frozen: bool) -> FunctionType:
    """Return a method as the standard decorator writes it, for a class on top of the given one.

    That of a frozen class comes with two more methods, so `__init__`, the one that most classes
    need, is written here.
    """
    if name == "__init__":
        return _init(made, frozen)
    told = {key: getattr(made, key) for key in ("__module__", "__qualname__", "__doc__")}
    above = type(made)(made.__name__, (made,), told)
    compared = name in ("__eq__", "__hash__")
    dataclasses.dataclass(above, init=False, repr=not compared, eq=compared, frozen=frozen)
    method: FunctionType = vars(above)[name]
    return method


class Factory:
    """Stands where a value was not given that a factory makes."""

    def __repr__(self) -> str:
        return "<factory>"


FACTORY = Factory()


def _init(made: Any, frozen: bool) -> FunctionType:
    """Return `__init__` of a dataclass."""
    known = {"__name__": made.__module__, "_put": object.__setattr__, "_FACTORY": FACTORY}
    given, by_name, body = ["self"], ["*"], []
    for each in fields(made):
        parameter, value = _given(each, known, "__slots__" in vars(made))
        if each.init:
            (by_name if each.kw_only else given).append(parameter)
        if value:
            name = each.name
            body.append(f"_put(self, {name!r}, {value})" if frozen else f"self.{name} = {value}")
    body += ["self.__post_init__()"] if hasattr(made, "__post_init__") else []
    head = ", ".join(given + (by_name if len(by_name) > 1 else []))
    exec(f"def __init__({head}):\n  " + "\n  ".join(body or ["pass"]), known)
    method: FunctionType = known["__init__"]
    method.__qualname__ = f"{made.__qualname__}.__init__"
    types = {each.name: each.type for each in fields(made) if each.init}
    method.__annotations__ = {**types, "return": None}
    return method


def _given(each: Field[Any], known: dict[str, Any], slots: bool) -> tuple[str, str]:
    """Return the parameter of a field, and what it is set to; names that both use become known.

    A default that cannot be given stays with the class, if that has not slots instead.
    """
    name, default = each.name, f"_default_{each.name}"
    if each.default_factory is not MISSING:
        known[default] = each.default_factory
        made = f"{default}() if {name} is _FACTORY else {name}" if each.init else f"{default}()"
        return f"{name}=_FACTORY", made
    if each.default is MISSING:
        return name, name if each.init else ""
    known[default] = each.default
    return f"{name}={default}", name if each.init else default if slots else ""


def _freeze(made: Any, slots: bool) -> None:
    """Let objects of a class be as they were made; those without a dictionary can be copied."""
    names = frozenset(each.name for each in fields(made))

    def refuse(self: object, name: str, *value: object) -> None:
        if type(self) is made or name in names:
            what = "assign to" if value else "delete"
            raise FrozenInstanceError(f"cannot {what} field {name!r}")
        above: Any = super(made, self)
        (above.__setattr__ if value else above.__delattr__)(name, *value)

    made.__setattr__ = made.__delattr__ = refuse
    made.__dataclass_params__.frozen = True
    if slots:
        made.__getstate__, made.__setstate__ = _state, _take_state


def _state(self: Any) -> list[object]:
    return [getattr(self, each.name) for each in fields(self)]


def _take_state(self: Any, state: list[object]) -> None:
    for each, value in zip(fields(self), state, strict=True):
        object.__setattr__(self, each.name, value)

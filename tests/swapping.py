"""Faults put into functions of gcxform as it is loaded, so that none need load it again.

Most faults lie within functions, and loading gcxform takes longer than most tests of one. So
`mutations.py` has a process that has loaded all of it, and in a copy of that process the code of
the functions in which the sources differ is replaced. That is the same as to load the wrong source
where no more differs than that, and where nothing called these functions while gcxform was loaded.
Wherever this is not certain, `swapped` says no, and the fault is tried on a gcxform that is loaded
anew; so is each that no test notices here.
"""

from __future__ import annotations

import gc
import importlib
import pkgutil
import sys
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from inspect import CO_NEWLOCALS
from pathlib import Path
from types import CodeType, FrameType, FunctionType
from typing import Any

PACKAGES = ("gcxform", "gcxform_plugins", "gcxform_grammars")
SHALLOW = (
    *("co_name", "co_code", "co_names", "co_varnames", "co_freevars", "co_cellvars", "co_flags"),
    *("co_argcount", "co_posonlyargcount", "co_kwonlyargcount", "co_exceptiontable"),
)
Pair = tuple[CodeType, CodeType]


@dataclass
class Loaded:
    """The functions of the packages by their code, and the code that ran while they were loaded."""

    functions: dict[CodeType, list[FunctionType]] = field(default_factory=dict)
    ran: set[CodeType] = field(default_factory=set)

    def swapped(self, file: Path, old: str, new: str) -> bool:
        """Replace the code of the functions in which two sources differ; tell whether it could."""
        try:
            pair = compiled(file, old), compiled(file, new)
        except SyntaxError:
            return False
        pairs = list(changed(*pair))
        if (None, None) in pairs or not all(self._may(*each, pair[0]) for each in pairs):
            return False
        for before, after in pairs:
            for function in self.functions[before]:
                function.__code__ = after
        return True

    def _may(self, before: CodeType, after: CodeType, module: CodeType) -> bool:
        return (
            before in self.functions
            and before not in self.ran
            and before.co_freevars == after.co_freevars
            and sum(each == before for each in nested(module)) == 1
        )


def load() -> Loaded:
    """Load every module, the plugins and their grammars, and see what runs while that is done."""
    found = Loaded()

    def see(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            found.ran.add(frame.f_code)

    assert not [name for name in sys.modules if name.partition(".")[0] in PACKAGES]
    sys.setprofile(see)
    for package in map(importlib.import_module, PACKAGES):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            with suppress(ModuleNotFoundError):  # of what is installed for a host alone
                if not module.name.endswith("__main__"):
                    importlib.import_module(module.name)
    for dialect in importlib.import_module("gcxform").Registry.load().dialects.values():
        dialect.load_grammar()
    sys.setprofile(None)
    gc.collect()
    for thing in gc.get_objects():
        if isinstance(thing, FunctionType):
            found.functions.setdefault(thing.__code__, []).append(thing)
    return found


def compiled(file: Path, source: str) -> CodeType:
    """Compile a source as it is when it is imported."""
    return compile(source, str(file), "exec", dont_inherit=True)


def nested(code: CodeType) -> Iterator[CodeType]:
    """Yield all code within a piece of code."""
    for each in code.co_consts:
        if isinstance(each, CodeType):
            yield each
            yield from nested(each)


def changed(old: CodeType, new: CodeType) -> Iterator[Pair | tuple[None, None]]:
    """Yield the outermost functions that differ in modules or classes; none where more differs."""
    if shallow(old) != shallow(new):
        yield None, None
        return
    for before, after in zip(inside(old), inside(new), strict=True):
        if deep(before) == deep(after):
            continue
        if before.co_flags & after.co_flags & CO_NEWLOCALS:  # neither a module nor a class
            yield before, after
        else:
            yield from changed(before, after)


def inside(code: CodeType) -> list[CodeType]:
    """Return the code that a piece of code makes functions and classes of."""
    return [each for each in code.co_consts if isinstance(each, CodeType)]


def shallow(code: CodeType) -> list[Any]:
    """Return what a piece of code is by itself; where it stands is no part of it."""
    constants = [None if isinstance(c, CodeType) else repr(c) for c in code.co_consts]
    return [*(getattr(code, name) for name in SHALLOW), constants]


def deep(code: CodeType) -> list[Any]:
    """Return what a piece of code is, with all that is in it."""
    return [shallow(code), *map(deep, inside(code))]

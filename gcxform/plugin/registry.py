"""The registry: what the installed plugins offer, by name.

A plugin that cannot be imported, or that offers what it should not, costs itself and nothing else:
`Registry.diagnostics` says which and why. Two things of one name are an error, because the order
of plugins must not matter.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import redirect_stdout, suppress
from dataclasses import field, fields, replace
from functools import cache, partial
from inspect import getattr_static
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar

import pluggy

from gcxform.catalogue.remedies import either
from gcxform.config.toml_text import did_you_mean
from gcxform.contract.demands import Demands
from gcxform.contract.options import describe
from gcxform.contract.passes import Pass, TextPass
from gcxform.diagnostics import Diagnostic, Location, Severity, UsageError
from gcxform.dialect.dialect import Dialect
from gcxform.machine.formats import TAKEN, ControlFiles, Known
from gcxform.machine.kinds import Kinematics
from gcxform.machine.presets import TABLES, MachinePreset
from gcxform.plugin import hookspecs
from gcxform.plugin.contributions import Later, Offered, Waiting
from gcxform.plugin.distributions import Point, entry_points
from gcxform.toolpath.facts import FACTS, Fact
from gcxform.values import dataclass
from gcxform.version import VERSION

if TYPE_CHECKING:
    from gcxform.errormodel.formats import ErrorFormat

CORE = "gcxform"
KINDS: Mapping[str, str] = MappingProxyType(
    {
        "dialect": "gcxform_dialects",
        "pass": "gcxform_passes",
        "kinematics": "gcxform_kinematics",
        "preset": "gcxform_machine_presets",
        "control": "gcxform_control_files",
        "fact": "gcxform_facts",
        "format": "gcxform_error_formats",
    }
)
"""The kinds of things a plugin offers, each with its hook."""
TABLES_OF: Mapping[str, str] = MappingProxyType(
    {
        "dialect": "dialects",
        "pass": "passes",
        "kinematics": "kinematics",
        "preset": "presets",
        "control": "controls",
        "fact": "facts",
        "format": "formats",
    }
)
"""The attribute of a registry in which the things of a kind are."""

Offer = TypeVar("Offer")
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


@dataclass
class Registry:
    """Everything that plugins offer, each kind by name, and what was wrong with the plugins."""

    dialects: Offered[type[Dialect]] = field(default_factory=Offered)
    passes: Offered[type[Pass] | type[TextPass]] = field(default_factory=Offered)
    kinematics: Offered[type[Kinematics]] = field(default_factory=Offered)
    presets: Offered[type[MachinePreset]] = field(default_factory=Offered)
    controls: Offered[type[ControlFiles]] = field(default_factory=Offered)
    facts: Offered[Fact] = field(default_factory=lambda: Offered({f.name: f for f in FACTS}))
    formats: Offered[type[ErrorFormat]] = field(default_factory=Offered)
    diagnostics: list[Diagnostic] = field(default_factory=list)
    points: list[Point] = field(default_factory=list, repr=False)
    _origins: dict[tuple[str, str], Point] = field(default_factory=dict, repr=False)

    @classmethod
    def load(cls) -> Registry:
        """Return the registry of the plugins which are installed.

        Raises UsageError if two of them offer the same name.
        """
        registry = cls()
        manager = pluggy.PluginManager(hookspecs.PROJECT)
        manager.add_hookspecs(hookspecs)
        points = {}
        registry.points = entry_points(hookspecs.GROUP)
        for point in registry.points:
            name = f"{point.name} of {point.origin}"
            if registry._register(manager, name, point):
                points[name] = point
        for kind, hook in KINDS.items():
            for implementation in getattr(manager.hook, hook).get_hookimpls():
                point = points[implementation.plugin_name]
                registry._take(kind, implementation, point)
        return registry

    def with_passes(self, passes: Sequence[type[Pass] | type[TextPass]]) -> Registry:
        """Return the registry with passes that no plugin offers: of a script, or of a notebook.

        Raises UsageError for what is not a pass, and for a name that is taken.
        """
        own: dict[str, type[Pass] | type[TextPass]] = {}
        for each in passes:
            try:
                name = _CHECKS["pass"](each)
            except Exception as error:
                raise UsageError.one("GX702", f"passes: {each!r:.80}: {_reason(error)}") from None
            if name in self.passes or name in own:
                message = f"there is a pass {name!r} already: {self.origin('pass', name)}"
                raise UsageError.one("GX801", message, hint="give the class another name")
            own[name] = each
        return replace(self, passes=self.passes.also(own))

    def origin(self, kind: str, name: str) -> str:
        """Return the distribution, with its version, that a thing came with."""
        point = self._origins.get((kind, name))
        return point.origin if point else f"{CORE} {VERSION}"

    def dialect(self, name: str, where: Location | None = None) -> type[Dialect]:
        """Return a dialect; raises UsageError, at the place, if there is none of that name."""
        return self._find(self.dialects, name, ("GX703", "dialect"), where)

    def pass_(self, name: str, where: Location | None = None) -> type[Pass] | type[TextPass]:
        """Return a pass; raises UsageError, at the place, if there is none of that name."""
        return self._find(self.passes, name, ("GX704", "pass"), where)

    @property
    def machines(self) -> Known:
        """What machine files can name."""
        return Known(self.kinematics, self.controls, self.presets, self.dialects)

    def _find(
        self,
        known: Mapping[str, Offer],
        name: str,
        code_and_kind: tuple[str, str],
        where: Location | None,
    ) -> Offer:
        with suppress(KeyError):
            return known[name]
        code, kind = code_and_kind
        near = did_you_mean(name, known)
        hints = [near if near.endswith("?") else "", f"known: {', '.join(sorted(known))}"]
        hints += [d.message for d in self.diagnostics]
        message = f"there is no {kind} {name!r}"
        raise UsageError.one(code, message, where, either(*filter(None, hints), by="; "))

    def _register(self, manager: pluggy.PluginManager, name: str, point: Point) -> bool:
        """Import a plugin and register its hooks; return whether that went well."""
        try:
            with redirect_stdout(sys.stderr):  # stdout is for programs
                plugin = point.load()
            manager.register(plugin, name)
        except (Exception, SystemExit) as error:
            self._warn(point, f"cannot be loaded: {_reason(error)}")
            if manager.has_plugin(name):
                manager.unregister(name=name)
            return False
        for caller in manager.get_hookcallers(plugin) or []:
            if not caller.has_spec():
                hint = did_you_mean(caller.name, KINDS.values())
                self._warn(point, f"has the hook {caller.name!r}, which does not exist", hint)
        return True

    def _take(self, kind: str, implementation: pluggy.HookImpl, point: Point) -> None:
        """Take what one hook of one plugin returns."""
        try:
            with redirect_stdout(sys.stderr):
                offers = _listed(implementation.function())
        except (Exception, SystemExit) as error:
            self._warn(point, f"fails in {KINDS[kind]}: {_reason(error)}")
            return
        for offer in offers:
            if isinstance(offer, Later):
                load = partial(self._loaded, kind, offer, point)
                self._add(kind, offer.name, Waiting(load), point)
            elif name := self._checked(kind, offer, point):
                self._add(kind, name, offer, point)

    def _checked(self, kind: str, offer: Any, point: Point) -> str:
        """Return the name of what a plugin offers; nothing, and a warning, if it is no such."""
        try:
            return _CHECKS[kind](offer)
        except (Exception, SystemExit) as error:
            message = f"returns in {KINDS[kind]} what is not a {kind}: {_reason(error)}"
            self._warn(point, message)
            return ""

    def _loaded(self, kind: str, offer: Later, point: Point) -> Any:
        """Import what a plugin has named; None, and a warning, if that is not what it said."""
        try:
            with redirect_stdout(sys.stderr):
                thing = offer.load()
        except (Exception, SystemExit) as error:
            self._warn(point, f"cannot load the {kind} {offer.name!r}: {_reason(error)}")
            return None
        name = self._checked(kind, thing, point)
        if name and name != offer.name:
            self._warn(point, f"names the {kind} {offer.name!r}, and {offer.place} is {name!r}")
        return thing if name == offer.name else None

    def _add(self, kind: str, name: str, offer: Any, point: Point) -> None:
        table = getattr(self, TABLES_OF[kind])
        if name in list(table):  # by the names: nothing is imported
            both = f"{self.origin(kind, name)} and {point.origin}"
            message = f"two plugins offer the {kind} {name!r}: {both}"
            hint = "uninstall one of them, or rename it there"
            raise UsageError.one("GX801", message, hint=hint)
        table.add(name, offer)
        self._origins[kind, name] = point

    def _warn(self, point: Point, message: str, hint: str = "") -> None:
        text = f"the plugin {point.name!r} of {point.origin} {message}"
        finding = Diagnostic("GX802", text, hint=hint, severity=Severity.WARNING)
        self.diagnostics.append(finding)


@cache
def default_registry() -> Registry:
    """Return the registry of the installed plugins, loaded at the first call."""
    return Registry.load()


def dialect_of(given: object) -> type[Dialect]:
    """Return a dialect that is given as itself, or by its name. Raises UsageError."""
    if isinstance(given, str):
        return default_registry().dialect(given)
    if not (isinstance(given, type) and issubclass(given, Dialect)):
        message = f"dialect: expected a dialect or its name, got {given!r:.80}"
        raise UsageError.one("GX702", message, hint="`gcxform list dialects`")
    return given


@cache
def versions() -> str:
    """Return which distributions programs are read and written by, with their versions."""
    return ", ".join(sorted({point.origin for point in default_registry().points}))


def _reason(error: BaseException) -> str:
    """Return an exception as one line."""
    first = str(error).partition("\n")[0]
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


def _listed(returned: Any) -> list[Any]:
    if not isinstance(returned, Iterable):
        raise TypeError(f"{returned!r} is not an iterable of classes")
    return list(returned)


def _named(offer: Any, bases: tuple[type, ...]) -> str:
    """Return the name of a class on top of one of the bases; TypeError if it is not one."""
    if not isinstance(offer, type) or not issubclass(offer, bases) or offer in bases:
        raise TypeError(f"{offer!r} is not a subclass of {bases[0].__name__}")
    name = getattr(offer, "name", "")
    if not isinstance(name, str) or not _NAME.fullmatch(name):
        raise TypeError(f"{offer.__name__} has the name {name!r}")
    return name


def _options_name(offer: Any, bases: tuple[type, ...]) -> str:
    """Return the name of a frozen dataclass on top of one of the bases, whose options are ours."""
    name = _named(offer, bases)
    parameters = offer.__dict__.get("__dataclass_params__")
    if parameters is None or not parameters.frozen:
        raise TypeError(f"{offer.__name__} is not a frozen dataclass")
    describe(offer)
    return name


def _pass_name(offer: Any) -> str:
    """Return the name of a pass that says what a run has to know of it in `demands`."""
    name = _options_name(offer, (Pass, TextPass))
    said = getattr_static(offer, "demands", Demands())
    lost = {each.name for each in fields(Demands)} & set(dir(offer))
    lost -= {each.name for each in fields(offer)}
    if lost and said is getattr_static(Pass, "demands"):
        raise TypeError(f"{offer.__name__}.{min(lost)} is read in `demands` alone")
    if not isinstance(said, property | Demands):
        raise TypeError(f"{offer.__name__}.demands is neither a property nor a Demands")
    return name


def _preset_name(offer: Any) -> str:
    """Return the name of a preset that says where its values stand, in tables that it may have."""
    name = _named(offer, (MachinePreset,))
    if not (isinstance(offer.source, str) and offer.source):
        raise TypeError(f"{offer.__name__} has no source")
    if strange := sorted(set(offer.values) - set(TABLES)):
        raise TypeError(f"{offer.__name__}.values: a preset has no table {strange[0]!r}")
    return name


def _control_name(offer: Any) -> str:
    """Return the name of a control whose options can stand beside those of its command."""
    name = _options_name(offer, (ControlFiles,))
    if taken := sorted(TAKEN & {each.name for each in fields(offer)}):
        message = f"`gcxform machine import` has a {taken[0]} of its own"
        raise TypeError(f"{offer.__name__}.{taken[0]}: {message}")
    if not isinstance(getattr_static(offer, "tools"), staticmethod | classmethod):
        raise TypeError(f"{offer.__name__}.tools is not a static method")
    if not callable(offer.kinematics):
        raise TypeError(f"{offer.__name__}.kinematics is not a method")
    return name


def _fact_name(offer: Any) -> str:
    if not isinstance(offer, Fact):
        raise TypeError(f"{offer!r} is not a Fact")
    return offer.name


def _format_name(offer: Any) -> str:
    from gcxform.errormodel.formats import ErrorFormat

    name = _named(offer, (ErrorFormat,))
    if hasattr(offer, "__dataclass_fields__"):
        describe(offer)
    return name


_CHECKS: Mapping[str, Callable[[Any], str]] = MappingProxyType(
    {
        "dialect": lambda offer: _named(offer, (Dialect,)),
        "pass": _pass_name,
        "kinematics": lambda offer: _named(offer, (Kinematics,)),
        "preset": _preset_name,
        "control": _control_name,
        "fact": _fact_name,
        "format": _format_name,
    }
)

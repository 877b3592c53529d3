"""The registry, with distributions made up on disk."""

from __future__ import annotations

import re
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import click
import gcxform_plugins
import pytest

from gcxform.catalogue import CATALOGUE
from gcxform.cli.machine import taken_over
from gcxform.diagnostics import Location, Severity, UsageError
from gcxform.machine.formats import TAKEN
from gcxform.plugin.registry import KINDS, TABLES_OF, Registry, default_registry

PASSES = """
from __future__ import annotations
from dataclasses import dataclass
import gcxform as gx

@dataclass(frozen=True)
class Shift(gx.Pass):
    "Moves everything."
    name = "{name}"
    by: gx.Vector = (0.0, 0.0, 0.0)

@gx.hookimpl
def gcxform_passes():
    return [Shift]
"""
HEAD = "import gcxform as gx\n@gx.hookimpl\n"

Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Install:
    """Return a function which installs a distribution with one module."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def add(name: str, source: str, version: str = "1.0", module: str = "") -> None:
        module = module or name.replace("-", "_")
        folder = tmp_path / f"{name}-{version}.dist-info"
        folder.mkdir()
        metadata = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (folder / "METADATA").write_text(metadata)
        (folder / "entry_points.txt").write_text(f"[gcxform.plugins]\n{name} = {module}\n")
        (tmp_path / f"{module}.py").write_text(source)
        monkeypatch.delitem(sys.modules, module, raising=False)

    return add


def warnings(registry: Registry) -> list[str]:
    """Return the messages about the plugins that the tests have installed."""
    found = [d for d in registry.diagnostics if "'builtin'" not in d.message]
    assert all(d.code == "GX802" and d.code in CATALOGUE for d in found)
    assert all(d.severity is Severity.WARNING for d in found)
    return [d.message for d in found]


def test_the_builtin_dialects_come_through_the_entry_point() -> None:
    registry = Registry.load()
    assert {"fanuc", "grbl", "haas", "linuxcnc"} <= set(registry.dialects)
    assert {"lddm", "linuxcnc-comp", "isg-csv"} <= set(registry.formats)
    assert registry.origin("dialect", "fanuc").startswith("gcxform ")
    assert registry.facts["ABSOLUTE"].name == "ABSOLUTE"
    assert registry.origin("fact", "ABSOLUTE").startswith("gcxform ")


def test_the_builtin_plugin_has_no_fault() -> None:
    registry = Registry.load()
    for table in TABLES_OF.values():
        offered = getattr(registry, table)
        assert len(dict(offered.items())) == len(offered)
    assert registry.diagnostics == []
    names = {
        "absolute",
        "arcs",
        "cutter-comp",
        "cycles",
        "feed",
        "metric",
        "offsets",
        "plane",
        "repost",
        "retarget",
        "rtcp",
        "segment",
        "to-tip",
        "volumetric",
        "renumber",
        "strip",
    }
    assert set(registry.passes) == names


def test_every_builtin_dialect_format_and_control_is_listed() -> None:
    """The lists in the plugin and what is in its folders agree."""
    folder = Path(gcxform_plugins.__file__).parent
    dialects, formats = gcxform_plugins.gcxform_dialects(), gcxform_plugins.gcxform_error_formats()
    listed = [*dialects, *formats, *gcxform_plugins.gcxform_control_files()]
    modules = {tuple(re.split("[.:]", each.place)[1:3]) for each in listed}
    files = [
        f for kind in ("dialects", "formats", "controls") for f in folder.glob(f"{kind}/[!_]*")
    ]
    assert modules == {(f.parent.name, f.stem) for f in files if f.stem != "shared"}


def test_a_plugin_is_found(install: Install) -> None:
    install("acme-gx", PASSES.format(name="shift"), "2.5")
    registry = Registry.load()
    assert warnings(registry) == []
    assert registry.pass_("shift").__doc__ == "Moves everything."
    assert registry.origin("pass", "shift") == "acme-gx 2.5"


def test_the_default_registry_is_loaded_once() -> None:
    assert default_registry() is default_registry()


def test_a_clash_names_both_distributions(install: Install) -> None:
    install("acme", PASSES.format(name="shift"), "1.0")
    install("bolt", PASSES.format(name="shift"), "2.0")
    with pytest.raises(UsageError) as caught:
        Registry.load()
    (found,) = caught.value.diagnostics
    assert found.code == "GX801"
    assert found.code in CATALOGUE
    assert "acme 1.0" in found.message
    assert "bolt 2.0" in found.message
    assert "the pass 'shift'" in found.message


def test_a_clash_with_the_core(install: Install) -> None:
    hook = "def gcxform_facts():\n    return [gx.Fact('METRIC', 'mine', lambda path: True)]\n"
    install("acme", HEAD + hook)
    with pytest.raises(UsageError, match=r"the fact 'METRIC': gcxform .* and acme 1.0"):
        Registry.load()


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("import no_such_module", "cannot be loaded: ModuleNotFoundError: No module named"),
        ("def (", "cannot be loaded: SyntaxError"),
        ("raise SystemExit(3)", "cannot be loaded: SystemExit: 3"),
        (HEAD + "def gcxform_passes(config): return []", "cannot be loaded: PluginValidation"),
        (HEAD + "def gcxform_passes(): return 1/0", "fails in gcxform_passes: ZeroDivisionError"),
        (HEAD + "def gcxform_passes(): return None", "fails in gcxform_passes: TypeError: None"),
        (HEAD + "def gcxform_passes(): return [5]", "not a pass: TypeError: 5 is not a subclass"),
        (HEAD + "def gcxform_passes(): return [gx.Pass]", "is not a subclass of Pass"),
        (
            HEAD + "def gcxform_passes(): return [type('P', (gx.Pass,), {'name': 'p'})]",
            "P is not a frozen dataclass",
        ),
        (
            HEAD + "def gcxform_dialects(): return [type('D', (gx.Dialect,), {})]",
            "not a dialect: TypeError: D has the name ''",
        ),
        (
            HEAD + "def gcxform_dialects(): return [type('D', (gx.Dialect,), {'name': 'a b'})]",
            "D has the name 'a b'",
        ),
        (HEAD + "def gcxform_facts(): return ['FACT']", "'FACT' is not a Fact"),
        (HEAD + "def gcxform_error_formats(): return [int]", "is not a subclass of ErrorFormat"),
        (HEAD + "def gcxform_kinematics(): return [3]", "not a kinematics: TypeError: 3 is not"),
        (HEAD + "def gcxform_control_files(): return [3]", "not a control: TypeError: 3 is not"),
        (
            PASSES.format(name="shift").replace("gx.Vector", "complex"),
            "not a pass: TypeError: the option 'by' has the type <class 'complex'>",
        ),
        (
            PASSES.format(name="shift").replace("gx.Vector", "Nothing"),
            "not a pass: NameError: name 'Nothing' is not defined",
        ),
        (HEAD + "def gcxform_pases(): return []", "has the hook 'gcxform_pases', which does not"),
    ],
)
def test_a_broken_plugin_costs_only_itself(install: Install, source: str, message: str) -> None:
    install("broken", source)
    install("works", PASSES.format(name="move"))
    registry = Registry.load()
    (found,) = warnings(registry)
    assert found.startswith("the plugin 'broken' of broken 1.0 ")
    assert message in found
    assert "move" in registry.passes
    assert "fanuc" in registry.dialects


@pytest.mark.parametrize(
    ("member", "message"),
    [
        ("    joins = True", "Shift.joins is read in `demands` alone"),
        (
            "    def spares(self, path): return path.rapid",
            "Shift.spares is read in `demands` alone",
        ),
        ("    demands = None", "Shift.demands is neither a property nor a Demands"),
        ("    demands: str = ''", "Shift.demands is neither a property nor a Demands"),
    ],
)
def test_a_pass_says_in_demands_what_a_run_has_to_know(
    install: Install, member: str, message: str
) -> None:
    install("acme", PASSES.format(name="shift").replace("    by:", f"{member}\n    by:"))
    assert [message in found for found in warnings(Registry.load())] == [True]


def test_a_pass_may_have_an_option_that_is_called_as_a_demand(install: Install) -> None:
    install(
        "acme", PASSES.format(name="shift").replace("    by:", "    letters: str = ''\n    by:")
    )
    registry = Registry.load()
    assert not warnings(registry)
    assert "shift" in registry.passes


@pytest.mark.parametrize(
    ("member", "message"),
    [
        *(
            (f"{name}: str = ''", f"C.{name}: `gcxform machine import` has")
            for name in sorted(TAKEN)
        ),
        ("def tools(self, path, units): return {}", "C.tools is not a static method"),
        ("tools = None", "C.tools is not a static method"),
        ("kinematics = None", "C.kinematics is not a method"),
    ],
)
def test_a_control_that_no_command_can_be_made_of(
    install: Install, member: str, message: str
) -> None:
    source = f"""
from dataclasses import dataclass
{HEAD}def gcxform_control_files(): return [C]
@dataclass(frozen=True)
class C(gx.ControlFiles):
    name = "acme"
    {member}
"""
    install("acme", source)
    registry = Registry.load()
    assert [message in found for found in warnings(registry)] == [True]
    assert "acme" not in registry.controls


def test_what_every_command_of_a_control_has_is_known() -> None:
    context = click.Context(taken_over)
    for name in taken_over.list_commands(context):
        command = taken_over.get_command(context, name)
        assert command is not None
        own = {each.name for each in fields(default_registry().controls[name])}
        params = command.get_params(context)
        names = {word.lstrip("-").replace("-", "_") for each in params for word in each.opts}
        names |= {each.name or "" for each in params}
        assert {name for name in names - own if len(name) > 1 and name[0] != "_"} == TAKEN


def test_a_misspelt_hook_is_proposed(install: Install) -> None:
    install("acme", HEAD + "def gcxform_pases(): return []")
    hints = [d.hint for d in Registry.load().diagnostics if "pases" in d.message]
    assert hints == ["did you mean 'gcxform_passes'?"]


def test_the_good_offers_of_a_bad_list_are_kept(install: Install) -> None:
    install("acme", PASSES.format(name="shift").replace("[Shift]", "[5, Shift]"))
    registry = Registry.load()
    assert len(warnings(registry)) == 1
    assert "shift" in registry.passes


def test_unknown_names() -> None:
    registry = Registry.load()
    place = Location("p.toml", 3, 11)
    with pytest.raises(UsageError) as caught:
        registry.dialect("fanucc", place)
    (found,) = caught.value.diagnostics
    assert (found.code, found.where) == ("GX703", place)
    assert found.hint.startswith(
        "did you mean 'fanuc'?; known: brother, centroid, edingcnc, fagor, fanuc"
    )
    with pytest.raises(UsageError) as caught:
        registry.pass_("nothing", place)
    (found,) = caught.value.diagnostics
    assert (found.code, found.where) == ("GX704", place)
    assert found.message == "there is no pass 'nothing'"
    assert {"GX703", "GX704"} <= set(CATALOGUE)


def test_a_plugin_that_fails_is_named_where_a_name_is_unknown(install: Install) -> None:
    install("acme", "import no_such_module")
    with pytest.raises(UsageError, match=r"known: .*'acme' of acme 1.0 cannot be loaded"):
        Registry.load().pass_("shift")


def test_loading_is_fast() -> None:
    """A second load of what is imported already takes a few milliseconds."""
    Registry.load()
    times = []
    for _ in range(5):
        start = time.process_time()
        Registry.load()
        times.append(time.process_time() - start)
    assert min(times) < 0.03


def test_importing_the_registry_imports_no_plugin() -> None:
    code = "import gcxform.plugin.registry, sys; print('gcxform_plugins' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "False"


def test_a_thing_is_imported_when_it_is_used() -> None:
    load = "dialects = Registry.load().dialects; dialects['grbl']"
    shown = "print(len(dialects) > 20, *(f'gcxform_plugins.dialects.{n}' in sys.modules for n in"
    code = f"import sys; from gcxform.plugin.registry import Registry; {load}; {shown} NAMES))"
    code = code.replace("NAMES", "['grbl', 'fanuc', 'siemens']")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["True", "True", "False", "False"]


CLASS = PASSES.partition("@gx.hookimpl")[0]
LATER = HEAD + "def gcxform_passes(): return [gx.Later('shift', 'acme_gx:Shift')]\n"


def later(place: str) -> str:
    return LATER.replace("acme_gx:Shift", place)


def test_a_pass_may_be_named_with_its_place(install: Install) -> None:
    install("acme-gx", CLASS.format(name="shift") + LATER)
    registry = Registry.load()
    assert registry.pass_("shift").name == "shift"
    assert registry.origin("pass", "shift") == "acme-gx 1.0"
    assert warnings(registry) == []


@pytest.mark.parametrize(
    ("place", "name", "said"),
    [
        ("acme_none:Shift", "shift", "cannot load the pass 'shift': ModuleNotFoundError"),
        ("acme_gx:Shift", "other", "names the pass 'shift', and acme_gx:Shift is 'other'"),
        ("acme_gx:Lost", "shift", "cannot load the pass 'shift': AttributeError"),
        ("acme_gx:gx", "shift", "what is not a pass"),
        ("acme_gx", "shift", "cannot load the pass 'shift'"),
    ],
)
def test_a_pass_that_is_not_what_was_named(
    install: Install, place: str, name: str, said: str
) -> None:
    """It is left out, and who asks for it is told why."""
    install("acme-gx", CLASS.format(name=name) + later(place))
    registry = Registry.load()
    assert warnings(registry) == []
    with pytest.raises(UsageError) as refused:
        registry.pass_("shift")
    assert said in refused.value.diagnostics[0].hint
    (message,) = warnings(registry)
    assert said in message
    assert "shift" not in registry.passes
    assert "shift" not in dict(registry.passes.items())
    assert len(list(registry.passes.values())) == len(registry.passes)


def test_two_of_a_name_are_noticed_by_their_names(install: Install) -> None:
    install("acme-gx", later("acme_none:Shift"))
    install("rival-gx", later("rival_none:Shift"))
    with pytest.raises(UsageError, match="two plugins offer the pass 'shift'"):
        Registry.load()


def test_every_kind_has_an_origin(install: Install) -> None:
    kind = "type('Hexapod', (gx.Kinematics,), {'name': 'hexapod'})"
    source = HEAD + f"def gcxform_kinematics(): return [{kind}]"
    install("acme", source)
    registry = Registry.load()
    assert registry.origin("kinematics", "hexapod") == "acme 1.0"
    assert registry.origin("format", "lddm") == registry.origin("dialect", "grbl")
    assert set(KINDS) == {"dialect", "pass", "kinematics", "preset", "control", "fact", "format"}


def test_what_a_plugin_prints_is_not_part_of_a_program(
    install: Install, capsys: pytest.CaptureFixture[str]
) -> None:
    """Neither when it is imported, nor when it is asked what it offers."""
    source = PASSES.format(name="chatty").replace("    return", "    print('asked')\n    return")
    install("chatty", f"{source}\nprint('imported')\n")
    assert "chatty" in Registry.load().passes
    said = capsys.readouterr()
    assert (said.out, said.err) == ("", "imported\nasked\n")

"""Controls as tables in a distribution of their own: the guide is enough.

They come in by an entry point, import what plugins may, keep the contract of dialects, and read
what the control would do. Mach3 and Okuma are written there anew, from lists of what posts write:
they say to the letter what the dialects of gcxform say, or refuse it in the same place.
"""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from pathlib import Path

import pytest
import seeds_kit
from shop_kit import Drawn

import gcxform as gx
from gcxform.machine.machine import Tool
from gcxform.modal.state import Reading
from gcxform.testing import check_dialect
from gcxform.testing.cases import read_case

HERE = Path(__file__).parent / "controls_dist"
CORPUS = Path(__file__).parents[1] / "corpus" / "dialects" / "controls"
MAY = {"gcxform", "gcxform_plugins", "gcxform_controls", "collections", "dataclasses", "typing"}
ANEW = {"mach": "mach3", "osp": "okuma"}
ORIGIN = dict.fromkeys("XYZ", 0.0)
READING = Reading(
    ORIGIN,
    control={"arc-centres": "incremental"},
    tools={1: Tool(length=50.0, radius=3.0), 2: Tool(length=60.0, radius=3.0)},
    work_offsets={
        name: {"X": 5.0 * n, "Y": float(n), "Z": 0.0}
        for n in range(6)
        for name in (f"G{54 + n}", f"G15 H{1 + n}")
    },
    homes={"G28": ORIGIN},
)
AS_OKUMA = {"G43": "G56", "G49": "G53", **{f"G{53 + n}": f"G15 H{n}" for n in range(1, 7)}}


@pytest.fixture(scope="module")
def registry(tmp_path_factory):
    """The registry of a start where the distribution is installed."""
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    ((group, points),) = project["entry-points"].items()
    site = tmp_path_factory.mktemp("site")
    info = site / f"gcxform_controls-{project['version']}.dist-info"
    info.mkdir()
    (info / "METADATA").write_text(f"Name: {project['name']}\nVersion: {project['version']}\n\n")
    told = "".join(f"{name} = {module}\n" for name, module in points.items())
    (info / "entry_points.txt").write_text(f"[{group}]\n{told}")
    folders = [str(site), str(HERE / "src")]
    sys.path[:0] = folders
    try:
        found = gx.Registry.load()
        assert {"carbide", *ANEW} <= set(found.dialects)
        _ = [found.dialects[name] for name in found.dialects]  # each is imported
        yield found
    finally:
        sys.path[:] = [folder for folder in sys.path if folder not in folders]


@pytest.mark.parametrize("name", ["carbide", *ANEW])
def test_it_keeps_the_contract(registry, name):
    assert registry.diagnostics == []
    assert registry.origin("dialect", name) == "gcxform-controls 1.0"
    check_dialect(registry.dialects[name])


def test_they_import_what_plugins_may():
    for path in (HERE / "src" / "gcxform_controls").glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert str(node.module).split(".")[0] in MAY
                assert path.stem not in ANEW or "gcxform_plugins" not in str(node.module)


def test_what_its_host_ignores_is_refused(registry):
    with pytest.raises(gx.GcxformError, match="does nothing"):
        _ = gx.read(b"G21 G90\nG43 Z1.\nG0 X1.\nM30\n", registry.dialects["carbide"]).path


def said(registry, source, target, program):
    """Return what a program becomes, or where it is refused and by which codes."""
    dialects = registry.dialects[source], registry.dialects[target]
    steps = (registry.passes["absolute"](),)
    try:
        return gx.Pipeline(*dialects, steps, READING).run(program).text.decode()
    except gx.GcxformError as error:
        return [(str(found.where), found.code) for found in error.diagnostics]


def programs(control):
    """Yield the programs of the corpus for a control, and drawn ones."""
    for path in sorted(CORPUS.glob(f"{control}-*.txt")):
        yield read_case(path).sections["input.nc"]
    for seed in seeds_kit.some(20):
        text = Drawn(seed, "mach3").text()
        if control == "okuma":
            text = re.sub("G[45][0-9]", lambda code: AS_OKUMA.get(code[0], code[0]), text)
            text = re.sub(" P([0-9])", r" F\1", text)
        yield text.encode()


@pytest.mark.parametrize("name", ANEW)
def test_a_table_written_anew_says_the_same(registry, name):
    written = 0
    for program in programs(ANEW[name]):
        for target in ("", "linuxcnc", "fanuc", "okuma", "mach3"):
            if target == ANEW[name]:
                continue
            found = said(registry, name, target or name, program)
            expected = said(registry, ANEW[name], target or ANEW[name], program)
            assert found == expected, f"{target}\n{program.decode()}"
            written += isinstance(found, str)
    assert written > 5, "nearly all is refused"


@pytest.mark.parametrize("name", ANEW)
def test_a_time_of_an_open_unit_stays_in_one_table(registry, name):
    """Two tables may keep G4 as it is, and mean other times."""
    program = b"G21 G90 G94 G17\nG4 P500\nM2\n".replace(b"P", b"F" if name == "osp" else b"P")
    assert said(registry, name, name, program) == program.decode()
    for one, other in ((name, ANEW[name]), (ANEW[name], name)):
        assert said(registry, one, other, program)[0][1] == "GX501"

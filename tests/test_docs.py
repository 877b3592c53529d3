"""What README.md and the manual in `docs/` say is so: names, snippets, figures, links.

`tests/test_site.py` has what needs the built site.
"""

import json
import os
import re
import shutil
import subprocess
import tomllib
from pathlib import Path

import numpy as np
import pytest
from cli_kit import call
from console_kit import check_block
from gcxform_plugins.passes.volumetric.forward import lines

import gcxform as gx
from gcxform.catalogue import CATALOGUE
from gcxform.cli import VERBS
from gcxform.cli.plant.tasks import load_manifest
from gcxform.contract.options import describe
from gcxform.deviations.deviation import deviation
from gcxform.machine.chain import chain_of
from gcxform.machine.file import load_machine
from gcxform.pipeline.file import KEYS, SECTIONS
from gcxform.pipeline.schema import schema
from gcxform.plugin.registry import KINDS as HOOKS
from gcxform.plugin.registry import default_registry
from gcxform.testing import check_dialect, check_pass
from gcxform.version import VERSION

ROOT = Path(__file__).parents[1]
README = ROOT / "README.md"
MANUAL = sorted((ROOT / "docs").rglob("*.md"))
PAGES = sorted([*ROOT.glob("*.md"), ROOT / "benchmarks" / "README.md", *MANUAL])
TEXT = "\n".join(page.read_text("utf-8") for page in MANUAL)
REGISTRY = default_registry()


def named(page):
    return page.relative_to(ROOT).as_posix()


def blocks(language, text=TEXT):
    """Return the fenced blocks of a language in the manual."""
    return re.findall(rf"^```{language}\b[^\n]*\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


# --- names ---


@pytest.mark.parametrize("hook", HOOKS.values())
def test_every_hook_is_explained(hook):
    assert f"`{hook}`" in TEXT


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_is_explained(verb):
    assert f"| `gcxform {verb}` |" in TEXT


@pytest.mark.parametrize("name", ["UsageError", "InputError", "VerificationError", "FileError"])
def test_every_error_stands_with_its_exit_code(name):
    code = getattr(gx, name).exit_code
    assert re.search(rf"^\| {code} \|.*\| `{name}` \|$", TEXT, re.MULTILINE)
    assert f"`gx.{name}`" in TEXT


def test_every_class_of_diagnostics_is_explained():
    for hundreds in {code[:3] for code in CATALOGUE}:
        assert f"| {hundreds}.. |" in TEXT


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_codes_that_are_named_can_be_explained(page):
    assert set(re.findall(r"\bGX\d{3}\b", page.read_text("utf-8"))) <= set(CATALOGUE)


def test_every_key_of_a_pipeline_is_shown():
    shown = tomllib.loads(next(b for b in blocks("toml") if "[budget]" in b))
    assert set(shown) == set(KEYS)
    for name, section in SECTIONS.items():
        assert set(shown[name]) == {option.name for option in describe(section)}


def test_every_key_of_a_certificate_is_explained():
    pipeline = gx.Pipeline.load(ROOT / "examples" / "lddm" / "linear.toml")
    result = pipeline.run((ROOT / "examples" / "lddm" / "linear_in.nc").read_bytes())
    for key in json.loads(result.certificate.to_json()):
        assert key in ("format", "version") or f"`{key}`" in TEXT


def _unsaid(table, where):
    """Yield the keys of a table of a schema, and of those in it, that say nothing."""
    for key, value in table.get("properties", {}).items():
        if not value.get("description"):
            yield f"{where}.{key}"
        for inner in (value, value.get("additionalProperties"), value.get("items")):
            if isinstance(inner, dict):
                yield from _unsaid(inner, f"{where}.{key}")


@pytest.mark.parametrize("kind", ["pipeline", "machine", "model"])
def test_every_key_of_a_file_says_what_it_is(kind):
    whole = schema(kind)
    parts = {kind: whole, **whole.get("$defs", {})}
    assert [key for name, part in parts.items() for key in _unsaid(part, name)] == []


MADE = re.compile(r"^<!-- made: (\w+) -->\n(.*)$", re.MULTILINE)


@pytest.mark.parametrize(("name", "line"), MADE.findall(TEXT))
def test_what_the_site_has_more_is_printed_by_a_command(name, line):
    """Who reads the pages in the repository is told which."""
    command = re.fullmatch(r"\*Made from the code on the site; here `(.+)` prints it\.\*", line)
    assert command, (name, line)
    words = command[1].split()
    if words[0] == "gcxform":
        assert call(*words[1:]).exit_code == 0


def test_the_version_is_one():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    assert project["version"] == VERSION


# --- figures ---

LDDM_WAY = {
    "passes": 'split = "none"\niterations = 1\noutside = "extrapolate"',
    "output": 'words = "programmed"',
    "budget": '[budget]\ndeviation = "20 um"',
}
ROWS = {
    "`tolerance` absent": {},
    '`tolerance = "1e-9 mm"`': {"passes": 'tolerance = "1e-9 mm"'},
    '`tolerance = "1 um"`': {"passes": 'tolerance = "1 um"'},
    '`split = "none"`': {"passes": 'split = "none"', "budget": LDDM_WAY["budget"]},
    "as LDDM": LDDM_WAY,
}


def compensated(tmp_path, passes="", output="", budget=""):
    """Return moves, deviation before rounding (mm) and after it (mm) of the LDDM example."""
    example = ROOT / "examples" / "lddm"
    (tmp_path / "p.toml").write_text(
        f'format = 1\n[input]\ndialect = "fanuc"\n{budget}\n[[pass]]\nuse = "volumetric"\n'
        f"model = '{example / 'model.toml'}'\npart-origin = [0, 0, 0]\n{passes}\n"
        f"[output]\n{output}\n"
    )
    pipeline = gx.Pipeline.load(tmp_path / "p.toml")
    program = (example / "linear_in.nc").read_bytes()
    path = gx.read(program, "fanuc").path
    step = pipeline.path_passes[0]
    command = step.apply(path, pipeline.context)
    actual = step.undo(command, pipeline.context)
    off = deviation(path, actual, np.searchsorted(path.source, actual.source))
    written = pipeline.run(program).certificate.largest["deviation"]
    return len(command) - 1, float(off.distance.max()), written


@pytest.mark.parametrize("row", ROWS)
def test_figures_of_accuracy(row, tmp_path):
    line = next(line for line in TEXT.splitlines() if line.startswith(f"| {row}"))
    moves, exact, written = compensated(tmp_path, **ROWS[row])
    before = f"{exact:.1e} mm" if exact < 1e-5 else f"{exact * 1000:.2f} um"
    if row == "as LDDM":
        before = ""
    wanted = [str(moves), before, f"{written * 1000:.2f} um"]
    assert [cell.strip() for cell in line.split("|")[2:5]] == wanted


def test_the_head_of_cutting_gives_the_same_figures():
    head = " ".join((lines.__doc__ or "").split())
    for row in ("`tolerance` absent", '`tolerance = "1e-9 mm"`'):
        line = next(line for line in TEXT.splitlines() if line.startswith(f"| {row}"))
        moves, before = (cell.strip() for cell in line.split("|")[2:4])
        assert re.search(rf"\b{moves}\b[^.]* {re.escape(before)}", head)


# --- snippets ---


SHOWN = [page for page in (README, *MANUAL) if "```console" in page.read_text("utf-8")]
SAVED = re.compile(r'^```\w+ title="(.+?)"\n(.*?)^```$', re.MULTILINE | re.DOTALL)


@pytest.fixture
def folder(tmp_path):
    """Return a folder with the examples, as a newcomer has it."""
    shutil.copytree(ROOT / "examples", tmp_path / "examples", ignore=shutil.ignore_patterns("out"))
    return tmp_path


@pytest.mark.parametrize("page", SHOWN, ids=named)
def test_console_snippets_print_what_is_shown(page, folder):
    """The commands of a page, one after the other, beside the files that it says to save."""
    text = page.read_text("utf-8")
    for name, content in SAVED.findall(text):
        (folder / name).write_text(content, "utf-8")
    for block in blocks("console", text):
        if "pip install" not in block:  # tests/test_site.py does that
            assert check_block(block, folder)


def test_the_python_api_says_what_the_command_says():
    printed = re.search(r"^\$ python compensate.py\n.*\n(.*)$", TEXT, re.MULTILINE)[1]
    shown = next(b for b in blocks("console") if "lddm/linear.toml" in b and "largest" in b)
    assert f"{printed} of" in shown


def plugin(name, mark):
    """Return a class of the snippet of the manual that has the mark; it is short."""
    snippet = next(b for b in blocks("python") if mark in b)
    body = snippet[snippet.index(f"class {name}") :]
    assert len([line for line in body.splitlines() if line.strip()]) < 20
    names = {"__name__": "manual"}
    exec(compile(snippet, "manual", "exec"), names)
    return names[name]


def test_dialect_and_pass_of_the_manual_work():
    dialect = plugin("Acme", "gcxform_dialects")
    step = plugin("Shift", "gcxform_passes")(by=(1.0, 0.0, -2.0))
    pipeline = gx.Pipeline(dialect, dialect, (REGISTRY.passes["absolute"](), step))
    program = b"G21 G90 G17 G0 X1. Y2. Z5.\nG2 X3. I1. J0. F200.\nG91 G1 Z-1.\nM30\n"
    result = pipeline.run(program)
    assert result.text.decode().splitlines() == [
        "G21 G90 G17 G0 X2.000 Y2.000 Z3.000",
        "G2 X4.000 I1.000 J0.000 F200.",
        "G90 G1 Z2.000",
        "M30",
    ]
    assert result.certificate.verified
    check_dialect(dialect)
    check_pass(type(step), step)


def test_toml_snippets_are_right(folder, tmp_path):
    for page in SHOWN:
        for name, content in SAVED.findall(page.read_text("utf-8")):
            (folder / name).write_text(content, "utf-8")
    for snippet in blocks("toml"):
        tomllib.loads(snippet)
        if "tool-table" in snippet:
            (tmp_path / "tool.tbl").write_text("T1 P1 Z100.0 D10.0 ;end mill\n", "latin-1")
            (tmp_path / "machine.toml").write_text(snippet, "utf-8")
            machine = load_machine(tmp_path / "machine.toml", REGISTRY.machines)
            assert sorted(machine.tools) == [1, 7]
        elif "kinematics" in snippet:
            (tmp_path / "kinds.toml").write_text(f"format = 1\n{snippet}", "utf-8")
            machine = load_machine(tmp_path / "kinds.toml", REGISTRY.machines)
            assert chain_of(machine).letters == ("A", "C")
        elif "[axis." in snippet:
            (tmp_path / "axes.toml").write_text(snippet, "utf-8")
            load_machine(tmp_path / "axes.toml", REGISTRY.machines)
        elif "[[batch]]" in snippet:
            (folder / "plant.toml").write_text(snippet, "utf-8")
            assert load_manifest(folder / "plant.toml")
        elif snippet.startswith("format") and "[X]" not in snippet and "[Y]" not in snippet:
            (folder / "snippet.toml").write_text(snippet, "utf-8")
            gx.Pipeline.load(folder / "snippet.toml")


@pytest.mark.parametrize("file", sorted((ROOT / "examples").glob("*/*.toml")), ids=lambda f: f.name)
def test_pipelines_of_the_examples_run(file):
    text = file.read_text("utf-8")
    if "[[pass]]" not in text or 'use = "to-tip"' in text:  # of axes, which test_rtcp_loop.py has
        return
    pipeline = gx.Pipeline.load(file)
    programs = {"linear": "linear_in.nc", "arc": "arc_in.nc", "axes": "dome.nc"}
    program = file.parent / programs.get(file.stem, f"{file.stem}.nc")
    result = pipeline.run(program.read_bytes(), verify="full")
    assert result.certificate.verified
    assert 0 < result.certificate.largest["deviation"] < 0.002


@pytest.mark.skipif(shutil.which("rs274") is None, reason="rs274 is not installed")
def test_linuxcnc_reads_the_bracket(tmp_path):
    """As many moves as the certificate says, before and after."""
    folder = ROOT / "examples" / "bracket"
    source = (folder / "bracket.nc").read_bytes()
    result = gx.Pipeline.load(folder / "bracket.toml").run(source)
    for text in (source, result.text):
        (tmp_path / "in.nc").write_bytes(text)
        command = ["rs274", "-t", folder / "tool.tbl", "-g", "in.nc", "out.txt"]
        subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, timeout=30)
        moves = re.findall(r"STRAIGHT_|ARC_FEED", (tmp_path / "out.txt").read_text())
        assert len(moves) == len(gx.read(text, "linuxcnc").path)


# --- the page of the packages ---

ARCHITECTURE = (ROOT / "ARCHITECTURE.md").read_text("utf-8")
MOST_LINES = 345
PACKAGES = [
    folder.relative_to(ROOT).as_posix()
    for top in ("gcxform", "plugins/gcxform_plugins")
    for folder in sorted((ROOT / top).iterdir())
    if (folder / "__init__.py").exists()
]


def test_the_architecture_is_a_page_of_an_hour():
    assert len(ARCHITECTURE.splitlines()) < MOST_LINES


@pytest.mark.parametrize("package", PACKAGES)
def test_each_package_has_its_paragraph(package):
    assert f"\n\n**`{package}/`**" in ARCHITECTURE


def modules(package):
    """Return the modules and packages that a paragraph about a package may name."""
    return {path.relative_to(ROOT / package).as_posix() for path in (ROOT / package).rglob("*")}


def missing(text):
    """Return the modules and packages of a page that are not there, by the paragraph they are in.

    A name without a path is that of a module of the package whose paragraph it stands in.
    """
    found = []
    for part in re.split(r"\n\n(?=\*\*`)|\n(?=#)", text):
        package = re.match(r"\*\*`([\w/]+)/`\*\*", part)
        for name in re.findall(r"`([\w/]+(?:\.py|/))`", part):
            inside = package and name.rstrip("/") in modules(package.group(1))
            if not (inside or (ROOT / name).exists()):
                found.append(name)
    return found


def test_the_architecture_names_no_module_that_does_not_exist():
    assert not missing(ARCHITECTURE)
    assert missing("\n\n**`gcxform/emit/`**: text (`copying.py`, `verify.py`)") == ["verify.py"]
    assert missing("`gcxform/emit/verify.py` and `gcxform/emited/`") == [
        "gcxform/emit/verify.py",
        "gcxform/emited/",
    ]


# --- files ---


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_links_lead_somewhere(page):
    for target in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text("utf-8")):
        assert "://" in target or (page.parent / target).exists(), target


@pytest.mark.parametrize("page", PAGES, ids=named)
def test_files_that_are_named_exist(page):
    named = re.findall(r"[ `(]((?:gcxform|plugins|grammars|tests|corpus|benchmarks|examples)/"
                       r"[\w./*-]*)", page.read_text("utf-8"))  # fmt: skip
    made = ("examples/out",)
    for path in named:
        path = path.rstrip(".")
        if "..." not in path and not path.startswith(made):
            assert list(ROOT.glob(path.rstrip("/"))), path


def test_the_readme_is_a_door():
    assert len(README.read_text("utf-8").splitlines()) < 150


def test_the_figures_of_the_door_are_those_of_the_first_program():
    door = README.read_text("utf-8")
    shown = (ROOT / "docs" / "start.md").read_text("utf-8")
    before, after = re.search(r"up to (\S+) um off .*? at most (\S+) um", door, re.DOTALL).groups()
    found = re.findall(r"largest deviation (\S+) mm", shown[shown.index("examples/bracket/") :])
    assert [f"{float(each) * 1000:.2f}" for each in found] == [after, before]


def test_commands_of_the_first_screen_exist():
    first = "\n".join(README.read_text("utf-8").splitlines()[:24])
    scripts = re.findall(r"^(\./\S+)", first, re.MULTILINE)
    assert len(scripts) == 2
    for script in [*scripts, ".ci/run"]:
        assert os.access(ROOT / script, os.X_OK)
    assert scripts[1] in (ROOT / ".ci" / "run").read_text("utf-8")


def tracked():
    """Return the files of the repository, those not yet committed included."""
    if shutil.which("git") is None or not (ROOT / ".git").exists():
        pytest.skip("this is not a git clone")
    listed = subprocess.run(
        ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z"],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    )
    return [ROOT / name for name in listed.stdout.split("\0") if (ROOT / name).is_file()]


FORBIDDEN = ["py" + "pi.", "python" + "hosted", "/wo" + "rk/", "sess" + "ion", "/ro" + "ot/"]
ALLOWED = re.compile(r'scope="\w+"|pytest_\w+finish')  # of pytest's fixtures and hooks


def test_no_file_names_a_registry_or_a_computer():
    for file in tracked():
        if file.name.endswith(".min.js"):  # a library as it is published
            continue
        text = ALLOWED.sub("", file.read_bytes().decode("latin-1")).lower()
        assert not [word for word in FORBIDDEN if word in text], file


def test_pages_are_not_wider_than_a_window():
    for page in PAGES:
        prose = re.sub(r"^```.*?^```$", "", page.read_text("utf-8"), flags=re.M | re.DOTALL)
        wide = [line for line in prose.splitlines() if len(line) > 100 and line[0] not in "|<"]
        assert not wide, page

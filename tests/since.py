"""Which test files depend on what has changed since a commit?

    python tests/since.py REV

prints them, and on stderr how many there are and which are left out. `./run-tests --since REV` runs
no others; without it, and in CI, everything is run.

A test file depends on the modules it imports, on what these import, and so on. A name of
`gcxform` (`gx.compare`) stands for the module it is loaded from. What plugins offer, and verbs,
come by their names: a word of a string that is such a name counts as an import, and the table of a
registry (`.passes`) as an import of all that is in it. Other files count where their folder is
named: `corpus`, `examples`. A file that none of this explains chooses every test. So too many tests
are run rather than too few; one that makes a name out of pieces, or finds a file by a pattern, may
be left out. `tests/test_since.py` holds this against the faults: each says what notices it.
"""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

from trees_kit import walk

import gcxform
from gcxform import cli
from gcxform.plugin.contributions import Offered
from gcxform.plugin.registry import default_registry

ROOT = Path(__file__).parents[1]
TESTS = ROOT / "tests"
FOLDERS = ("corpus", "docs", "examples", "benchmarks", "tests")  # of files that are no modules
PAGES = ("ARCHITECTURE.md", "CONTRIBUTING.md", "README.md", "mkdocs.yml")
PLUGINS, COMMANDS = "gcxform_plugins", "gcxform.cli"
BY_NAME = ("gcxform", PLUGINS)  # what these import is loaded when it is asked for
WHOLE_TREE = {  # these read the text of every file, or build and run the package
    *("test_catalogue", "test_dialect_rules", "test_docs"),
    *("test_mutations", "test_packaging", "test_structure"),
}
WORD = re.compile(r"[A-Za-z][\w-]*")


@dataclass
class Module:
    """What a module refers to: modules by import or by name, and the words of its strings."""

    imports: set[str] = field(default_factory=set)
    attributes: set[str] = field(default_factory=set)
    words: set[str] = field(default_factory=set)


# --- files ---


@cache
def modules() -> dict[str, Path]:
    """Return the files of all modules, by name."""
    found = {}
    for base, folder in ((ROOT, "gcxform"), (ROOT / "plugins", PLUGINS), (TESTS, "")):
        for path in sorted((base / folder).rglob("*.py")):
            parts = path.relative_to(base).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def names() -> dict[str, str]:
    """Return the names of all modules, by the paths of their files from the root."""
    return {str(file.relative_to(ROOT)): name for name, file in modules().items()}


def test_files() -> list[str]:
    """Return the names of the modules with tests."""
    return [name for name in modules() if name.rpartition(".")[2].startswith("test_")]


@cache
def read(name: str) -> Module:
    """Return what a module refers to."""
    found, tree = Module(), ast.parse(modules()[name].read_bytes())
    docstrings = set[ast.expr]()
    for node in walk(tree):  # what holds another comes before it
        if isinstance(node, ast.Expr):
            docstrings.add(node.value)
        elif isinstance(node, ast.Import):
            found.imports.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            found.imports.update(f"{node.module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Attribute):
            found.attributes.add(node.attr)
            if isinstance(node.value, ast.Name) and node.value.id in ("gx", "gcxform"):
                found.imports.add(f"gcxform.{node.attr}")
        elif isinstance(node, ast.Constant) and node not in docstrings:
            found.words.update(WORD.findall(str(node.value)))
    return found


# --- what a module depends on ---


@cache
def offers() -> dict[str, set[str]]:
    """Return the modules that are loaded for a name, and those of a table of a registry."""
    found: dict[str, set[str]] = {}
    for table, entries in vars(default_registry()).items():
        for name, offer in entries.items() if isinstance(entries, Offered) else ():
            if (home := getattr(offer, "__module__", "")).startswith(PLUGINS):
                found.setdefault(str(name), set()).add(home)
                found.setdefault(f".{table}", set()).add(home)
    for verb in cli.VERBS:
        found.setdefault(verb, set()).add(f"{COMMANDS}.{cli.FILES.get(verb, verb)}")
    return found


def known(name: str) -> Iterator[str]:
    """Yield the modules of which an import of a name runs the code."""
    parts = name.split(".")
    for count in range(1, len(parts) + 1):
        if (module := ".".join(parts[:count])) in modules():
            yield module


@cache
def needs(name: str) -> frozenset[str]:
    """Return the modules that a module loads by itself."""
    module, found = read(name), set[str]()
    if name in BY_NAME:
        return frozenset()
    for imported in module.imports:
        first, _, rest = imported.partition(".")
        home = gcxform._HOMES.get(rest) if first == "gcxform" else None
        found.update(known(home or imported))
    beside = name.rpartition(".")[0]
    found |= {f"{beside}.{word}" for word in module.words} & modules().keys()  # read as a text
    if not name.startswith("gcxform") or name.startswith("gcxform.testing"):
        asked = module.words | {f".{attribute}" for attribute in module.attributes}
        for word in asked & offers().keys():
            found.update(offers()[word])
    return frozenset(found - {name})


@cache
def everything(name: str) -> frozenset[str]:
    """Return all modules that a module depends on, and itself."""
    found, waiting = {name}, [name]
    while waiting:
        new = needs(waiting.pop()) - found
        found |= new
        waiting += new
    return frozenset(found)


def named(name: str) -> set[str]:
    """Return the words that a test file and its helpers say."""
    return set().union(*(read(m).words for m in everything(name) if not m.startswith("gcxform")))


# --- what to run ---


def chosen(changed: Iterable[str]) -> set[str]:
    """Return the modules with tests that depend on changed files, paths from the root."""
    return set().union(*map(depending, changed))


def depending(path: str) -> set[str]:
    """Return the modules with tests that depend on a file."""
    tests = set(test_files())
    name = names().get(path)
    if name and name != "conftest" and name not in BY_NAME:
        starts = name.startswith("gcxform")
        found = {test for test in tests if name in everything(test) or (starts and _starts(test))}
        return found | WHOLE_TREE
    first, *rest = Path(path).parts
    if name or (first not in FOLDERS and path not in PAGES):
        return tests
    place = Path(rest[0] if first == "tests" else first).stem
    found = {test for test in tests if place in named(test)}
    return found | WHOLE_TREE if found else tests


def _starts(test: str) -> bool:
    """Tell whether a test file starts commands, or reads pages that show some."""
    return bool({"subprocess", "console_kit"} & {i.split(".")[0] for i in read(test).imports})


def changed_since(revision: str) -> list[str]:
    """Return the paths that differ from a commit, and those that git does not know."""

    def git(*words: str) -> list[str]:
        done = subprocess.run(["git", *words], cwd=ROOT, check=True, stdout=subprocess.PIPE)
        return [path for path in done.stdout.decode().split("\0") if path]

    return [
        *git("diff", "--name-only", "--no-renames", "-z", revision, "--"),
        *git("ls-files", "--others", "--exclude-standard", "-z"),
    ]


def main() -> None:
    """Print what is chosen."""
    run, tests = chosen(changed_since(sys.argv[1])), test_files()
    left = [name for name in tests if name not in run]
    print(f"{len(run)} of {len(tests)} test files; left out:", *left or ["none"], file=sys.stderr)
    print(*sorted(str(modules()[name].relative_to(ROOT)) for name in run), sep="\n")


if __name__ == "__main__":
    main()

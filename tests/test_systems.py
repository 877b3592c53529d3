"""Windows and macOS, as far as they can be had without them: `docs/hosts/systems.md` has the table.

What a system lacks is taken away in a process of its own (`foreign.py`), what it does otherwise is
put in the place of what is done here; file systems that are really so are mounted where they can
be.
"""

from __future__ import annotations

import ast
import contextlib
import errno
import io
import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import foreign
import pytest
from cli_kit import ABSOLUTE, COMPENSATED, MODEL, PART, call, process, workplace
from click.testing import Result

import gcxform as gx
from gcxform.cli import main
from gcxform.cli.common.programs import files_of
from gcxform.cli.common.signals import Ended
from gcxform.cli.watching.folders import moved
from gcxform.diagnostics import FileError
from gcxform.flow.lookup import Folders
from gcxform.system import files
from gcxform.system.files import write_atomically
from gcxform.system.places import lies_in, why_no_name

HERE = Path(__file__).parent
PACKAGES = [HERE.parent / "gcxform", HERE.parent / "plugins" / "gcxform_plugins"]
SYSTEM = HERE.parent / "gcxform" / "system"
LONG = b"G21 G90 G17 G54\nG0 X0 Y0 Z0\nF500\nG91 X1\nG90\n" + b"".join(
    b"G1 X%d.125 Y%d.375 (A COMMENT THAT MAKES A WINDOW)\n" % (k % 300, k % 70)
    for k in range(25_000)
)
EXAMPLE = HERE.parent / "examples" / "step-diagonal"
READINGS = EXAMPLE / "diagonals.csv"
LINEAR = [word for axis in "xy" for word in ("--linear", str(EXAMPLE / f"linear-{axis}.csv"))]
WORK = [
    ["run", "-q", "-f", "linuxcnc", "-x", "absolute", "long.nc", "-o", "out/"],
    ["run", "-q", "-x", COMPENSATED, "-f", "linuxcnc", "part.nc", "--certificate", "proof.json"],
    ["info", "-f", "linuxcnc", "part.nc"],
    ["watch", "--once", "--rest", "0", "-p", "job.toml", "hot"],
    ["compare", "-f", "linuxcnc", "part.nc", "hot/out/part.nc"],
    ["run", "-p", "none.toml", "part.nc"],
    ["post", "-p", "job.toml", "hot/out/part.nc"],
    ["calibrate", "diagonal", *LINEAR, "-", "-o", "found.toml"],
]


def shop(folder: Path) -> Path:
    """Return a folder to work in, with a long program, a hot folder, and readings for stdin."""
    with pytest.MonkeyPatch.context() as patch:
        folder.mkdir()
        workplace(folder, patch)
    (folder / "long.nc").write_bytes(LONG)
    (folder / "hot").mkdir()
    (folder / "hot" / "part.nc").write_bytes(PART)
    return folder


def told(folder: Path) -> dict[str, bytes]:
    """Return all files of a folder, without what a run says of its time."""
    found = {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}
    for name in [name for name in found if name.endswith(".json")]:
        proof = json.loads(found[name])
        found[name] = json.dumps({k: proof[k] for k in sorted(proof) if k != "seconds"}).encode()
    return found


def steady(said: list[object]) -> list[object]:
    """Return what a command has said, without times."""
    return [re.sub(r"\d+\.\d\d s", "", each) if isinstance(each, str) else each for each in said]


@pytest.fixture(scope="module")
def here(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[list[object]]]:
    """Return a folder in which all was done on this system, and what was said."""
    folder, said = shop(tmp_path_factory.mktemp("here") / "shop"), []
    with contextlib.chdir(folder):
        for words in WORK:
            if "-" in words:
                done = process(*words, input=READINGS.read_bytes())
                said.append([done.returncode, done.stdout.decode(), done.stderr.decode()])
            else:
                ours = call(*words)
                said.append([ours.exit_code, ours.stdout, ours.stderr])
    return folder, said


@pytest.mark.parametrize("system", foreign.LACKS)
def test_the_same_bytes_come_out(
    system: str, here: tuple[Path, list[list[object]]], tmp_path: Path
) -> None:
    """Without copied processes, shared memory, POSIX modules, owners, and a locale of UTF-8."""
    there = shop(tmp_path / "shop")
    words = ["-X", "warn_default_encoding", "-W", "error::EncodingWarning"]
    command = [sys.executable, *words, str(HERE / "foreign.py"), system, str(READINGS)]
    plain = {**os.environ, "LC_ALL": "C", "PYTHONCOERCECLOCALE": "0", "PYTHONUTF8": "0"}
    plain.pop("GCXFORM_PIPELINE", None)
    text = json.dumps(WORK).encode()
    done = subprocess.run(
        command, input=text, capture_output=True, env=plain, cwd=there, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
    folder, ours = here
    for words, one, other in zip(WORK, json.loads(done.stdout), ours, strict=True):
        assert steady(one) == steady(other), words
    assert told(there) == told(folder)
    assert set(told(there)) >= {"out/long.nc", "hot/out/part.nc", "proof.json", "found.toml"}


def lacking(tree: ast.AST, lacks: dict[str, set[str]]) -> Iterator[str]:
    """Yield what a module imports or asks for that another system lacks."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (a.name for a in node.names if a.name in foreign.POSIX_MODULES)
        elif isinstance(node, ast.ImportFrom) and node.module in foreign.POSIX_MODULES:
            yield node.module
        elif isinstance(node, ast.Attribute):
            module = node.value.id if isinstance(node.value, ast.Name) else ""
            if node.attr in lacks.get(module, ()):
                yield f"{module}.{node.attr}"


def test_only_one_package_asks_for_what_systems_lack() -> None:
    """What is not everywhere is asked for in `gcxform/system/`, which has a way without it."""
    lacks = {module.__name__: {*names} for module, names in foreign.LACKS["windows"].items()}
    modules = [path for folder in PACKAGES for path in folder.rglob("*.py")]
    outside = [path for path in modules if SYSTEM not in path.parents]
    assert len(outside) > 400
    words = re.compile("|".join([*foreign.POSIX_MODULES, *set().union(*lacks.values())]))
    for path in outside:
        text = path.read_text("utf-8")
        assert not words.search(text) or [*lacking(ast.parse(text), lacks)] == [], path
    assert [*lacking(ast.parse("import fcntl\nos.fork()"), lacks)] == ["fcntl", "os.fork"]


# --- places ---


@pytest.fixture
def any_case(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let names be found however they are spelt, and keep the spelling: as macOS does."""
    asked = os.stat

    def stat(path: object, **more: object) -> os.stat_result:
        try:
            return asked(path, **more)  # type: ignore[arg-type]
        except FileNotFoundError:
            found = Path("/")
            for part in Path(str(path)).absolute().parts[1:]:
                same = [n for n in os.listdir(found) if n.casefold() == part.casefold()]
                found /= same[0] if same else part
            return asked(found)

    monkeypatch.setattr(os, "stat", stat)


@pytest.mark.usefixtures("any_case")
def test_a_folder_is_the_same_however_it_is_spelt(tmp_path: Path) -> None:
    (tmp_path / "Shop" / "Subs").mkdir(parents=True)
    (tmp_path / "Shop" / "Subs" / "O7.NC").write_bytes(b"O7\nM99\n")
    shop = Path(str(tmp_path / "Shop").upper())
    assert lies_in(tmp_path / "Shop" / "Subs" / "O7.NC", shop)
    assert not lies_in(tmp_path, shop)
    rule = gx.LookupRule(numbers=("O{n}",), names=("{name}",), endings=(".nc",))
    for folder in (tmp_path / "Shop" / "Subs", tmp_path / "shop" / "SUBS"):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(os, "listdir", lambda _: ["O7.NC"])
            listed = Folders([folder], rule)._listed(folder)
        assert listed == ("O7.NC",)


@pytest.mark.usefixtures("any_case")
def test_a_share_that_numbers_files_by_their_spelling(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The program is not replaced by a result that has its name in other letters."""
    folder = workplace(tmp_path, monkeypatch)
    monkeypatch.setattr(os.path, "samefile", lambda one, other: one == other)
    monkeypatch.setattr(os.path, "isfile", lambda path: True)
    monkeypatch.setattr(os.path, "exists", lambda path: True)
    for name in ("PART.nc", str(folder / "Part.NC")):
        done = call("run", "-q", "-x", "absolute", "-f", "linuxcnc", "part.nc", "-o", name)
        assert (done.exit_code, "would overwrite part.nc" in done.stderr) == (2, True)
    (folder / "PART.nc").write_bytes(b"another")
    done = call("run", "-q", "-x", "absolute", "-f", "linuxcnc", "part.nc", "-o", "PART.nc")
    assert (folder / "PART.nc").read_bytes() == ABSOLUTE
    assert (folder / "part.nc").read_bytes() == PART


def test_a_folder_may_be_on_another_drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Paths of two drives have nothing in common, which `os.path` says by an error."""

    def nothing(_: object) -> str:
        raise ValueError("Paths don't have the same drive")

    monkeypatch.setattr(os.path, "commonpath", nothing)
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "a.nc").write_bytes(PART)
    assert files_of([str(tmp_path)]) == [tmp_path / "a" / "a.nc"]
    assert not lies_in(tmp_path / "a", tmp_path / "b")


@pytest.mark.parametrize(
    ("name", "why"),
    [
        *[(name, "device") for name in ("CON", "nul", "aux.nc", "COM1.tap", "LPT9", "PRN .nc")],
        *[(name, "no files with") for name in ("a:b.nc", "a?.nc", "<a>", "a|b", "tab\t.nc")],
        *[(name, "would drop") for name in ("O1234.", "a.nc ")],
        *[
            (name, "")
            for name in ("CONE.nc", "null.nc", "COM10.nc", "a b.nc", "O1", ".nc", "größe")
        ],
    ],
)
def test_names_that_windows_keeps_for_itself(
    name: str, why: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing goes to a device, behind another file, or under another name, and is called done."""
    assert why_no_name(tmp_path / name) == ""
    monkeypatch.setattr(sys, "platform", "win32")
    assert why in why_no_name(tmp_path / name)
    assert bool(why_no_name(tmp_path / name)) == bool(why)
    if why:
        with pytest.raises(FileError, match="GX902"), write_atomically(tmp_path / name):
            pass
        assert os.listdir(tmp_path) == []


@pytest.mark.parametrize("path", [r"C:\shop\m.toml", r"\\server\the shop\m.toml", r"C:m 1.toml"])
def test_drives_and_shares_stand_in_settings(
    path: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Here they are names like any others, which shows that each letter of them arrives."""
    folder = workplace(tmp_path, monkeypatch)
    (folder / path).write_text(MODEL)
    chain = f'volumetric model="{path}" part-origin=10,10,10 outside=extrapolate'
    done = call("run", "-q", "-f", "linuxcnc", "-x", chain, "part.nc")
    assert done.exit_code == 0, done.stderr
    step = f"[[pass]]\nuse = 'volumetric'\nmodel = '{path}'\npart-origin = [10, 10, 10]\n"
    head = "format = 1\n[input]\ndialect = 'linuxcnc'\n"
    (folder / "job.toml").write_text(f"{head}{step}outside = 'extrapolate'\n")
    assert call("run", "-q", "-p", "job.toml", "part.nc").stdout_bytes == done.stdout_bytes
    (folder / "bad.toml").write_text((folder / "job.toml").read_text().replace("'", '"'))
    bad = call("run", "-q", "-p", "bad.toml", "part.nc")
    wrong = "\\" in path  # which begins an escape in double quotes
    assert (bad.exit_code, "single quotes" in bad.stderr) == ((2, True) if wrong else (0, False))


# --- texts ---


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_what_powershell_has_written_is_named(
    encoding: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """`>` of its older versions makes UTF-16 of a program; no control would read it."""
    folder = workplace(tmp_path, monkeypatch)
    mark = "" if encoding == "utf-16" else "\ufeff"
    (folder / "wide.nc").write_bytes((mark + PART.decode()).encode(encoding))
    (folder / "wide.toml").write_bytes((mark + "format = 1\n").encode(encoding))
    for words in (["-x", "absolute", "-f", "linuxcnc", "wide.nc"], ["-p", "wide.toml", "part.nc"]):
        done = call("run", *words)
        assert (done.exit_code in (2, 5), "it is UTF-16" in done.stderr) == (True, True)
        assert done.stdout == ""


@pytest.mark.parametrize("encoding", ["utf-16-le", "utf-16-be"])
def test_utf16_without_its_mark_is_named(
    encoding: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Zeros before the program alone are the leader of a paper tape."""
    folder = workplace(tmp_path, monkeypatch)
    (folder / "wide.nc").write_bytes(PART.decode().encode(encoding))
    done = call("run", "-x", "absolute", "-f", "linuxcnc", "wide.nc")
    assert (done.exit_code, "it is UTF-16" in done.stderr) == (5, True)
    for count in (7, 63):
        (folder / "tape.nc").write_bytes(bytes(count) + PART)
        done = call("run", "-x", "absolute", "-f", "linuxcnc", "tape.nc")
        assert "UTF-16" not in done.stderr


def test_files_of_notepad_are_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With a byte order mark, and lines that end in CR LF."""
    folder = workplace(tmp_path, monkeypatch)
    wanted = call("run", "-q", "-x", COMPENSATED, "-f", "linuxcnc", "part.nc").stdout_bytes
    for name in ("job.toml", "model.toml"):
        text = (folder / name).read_bytes().replace(b"\n", b"\r\n")
        (folder / name).write_bytes(b"\xef\xbb\xbf" + text)
    assert call("run", "-q", "-p", "job.toml", "part.nc").stdout_bytes == ABSOLUTE
    assert lasting(call("run", "-q", "-x", COMPENSATED, "-f", "linuxcnc", "part.nc")) == [
        line for line in wanted.splitlines() if b"GCXFORM" not in line
    ]


def lasting(done: Result) -> list[bytes]:
    """Return the lines of a result but its stamp, in which there is a digest of the model."""
    assert done.exit_code == 0, done.stderr
    return [line for line in done.stdout_bytes.splitlines() if b"GCXFORM" not in line]


@pytest.mark.parametrize("page", ["cp1252", "cp437", "cp932", "ascii"])
def test_a_console_that_has_few_letters(
    page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it has not is shown by its number; the program goes out byte for byte."""
    folder = workplace(tmp_path, monkeypatch)
    odd = "größe µ \u2192 \u4e2d.nc"
    (folder / odd).write_bytes(PART.replace(b"PART", b"\xe4\xff"))
    wide = f"{odd}\u0416.toml"
    for words, code in (
        (["run", "-q", "-p", "job.toml", odd], 0),
        (["info", "-f", "linuxcnc", odd], 0),
        (["run", "-p", wide, odd], 2),
        (["--help"], 0),
    ):
        kept = io.BytesIO(), io.BytesIO()
        for name, stream in zip(("stdout", "stderr"), kept, strict=True):
            monkeypatch.setattr(sys, name, io.TextIOWrapper(stream, encoding=page))
        monkeypatch.setattr(sys, "argv", ["gcxform", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        assert ended.value.code == code
        sys.stdout.flush()
        sys.stderr.flush()
        if code == 0 and words[0] == "run":
            assert kept[0].getvalue() == ABSOLUTE.replace(b"PART", b"\xe4\xff")
        assert "internal error" not in kept[1].getvalue().decode(page)


# --- files that are open, and what ends a run ---


def test_a_file_that_somebody_has_open_is_not_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What looks at new files lets go of them soon; who does not is named, and keeps his file."""
    (tmp_path / "a.nc").write_bytes(b"old")
    real, waited, refusals = os.replace, [0.0], [2]

    def replace(source: Path, target: Path) -> None:
        if refusals[0]:
            refusals[0] -= 1
            raise PermissionError(errno.EACCES, "Access is denied")
        real(source, target)

    monkeypatch.setattr(os, "replace", replace)
    monkeypatch.setattr(files.time, "sleep", lambda s: waited.append(s))
    monkeypatch.setattr(sys, "platform", "win32")
    with write_atomically(tmp_path / "a.nc") as put:
        put(b"new")
    assert ((tmp_path / "a.nc").read_bytes(), len(waited)) == (b"new", 3)
    refusals[0] = 99
    with (
        pytest.raises(FileError, match=r"GX902.*Access is denied"),
        write_atomically(tmp_path / "a.nc") as put,
    ):
        put(b"newer")
    assert (sum(waited) < 2, os.listdir(tmp_path)) == (True, ["a.nc"])
    assert (tmp_path / "a.nc").read_bytes() == b"new"


@pytest.mark.parametrize("number", ["EINVAL", "ENOTSUP", "EXDEV", "EPERM", "EMLINK", "EACCES"])
def test_files_are_moved_where_they_have_one_name_only(
    number: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What stands for `no links` differs: EINVAL on Windows, ENOTSUP on macOS, EXDEV on AFS."""

    def link(_: Path, target: Path) -> None:
        raise OSError(getattr(errno, number), "no")

    monkeypatch.setattr(os, "link", link)
    (tmp_path / "a.nc").write_bytes(b"mine")
    (tmp_path / "b.nc").write_bytes(b"another")
    assert not moved(tmp_path / "a.nc", tmp_path / "b.nc")
    assert (tmp_path / "b.nc").read_bytes() == b"another"
    assert moved(tmp_path / "a.nc", tmp_path / "c.nc")
    assert (tmp_path / "c.nc").read_bytes() == b"mine"


def test_a_signal_that_only_windows_has_is_an_interrupt(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-Break is the one of those that a service or another console can send."""

    class Signals:
        name = "SIGBREAK"

    monkeypatch.setattr(signal, "Signals", lambda number: Signals)
    assert (str(Ended(21)), Ended(21).exit_code) == ("interrupted", 149)

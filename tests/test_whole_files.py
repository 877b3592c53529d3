"""What is written is a whole file for its target: `check` finds nothing that the source has not."""

from __future__ import annotations

import subprocess
from dataclasses import replace
from pathlib import Path

import pytest
from check_kit import new_in_output
from oracles import rs274

import gcxform as gx
from gcxform.pipeline.pipeline import Pipeline
from gcxform.plugin.registry import default_registry

BODIES = (
    b"G21 G90 G94 G17\nG0 X1 Y0\nG1 Y2 F100\n",
    b"G21 G90 G94 G17\r\nG0 X1\r\n",
    b"G21 G90 G94 G17\nG0 X1\nM5",
    b"(only a comment)\n",
    b"",
)
ENDS = (b"", b"M2\n", b"/M30\n")
TARGETS = ("fanuc", "grbl", "haas", "linuxcnc")


def reader(source: str, target: str) -> Pipeline:
    pipeline = Pipeline.parse("absolute", source)
    told = replace(pipeline.reading, block_delete="execute", increment="IS-B")
    return replace(pipeline, reading=told, target=default_registry().dialect(target))


def written(text: bytes, source: str, target: str) -> bytes | None:
    try:
        return reader(source, target).run(text).text
    except gx.InputError:
        return None


@pytest.mark.parametrize("source", TARGETS)
@pytest.mark.parametrize("target", TARGETS)
def test_check_finds_nothing_new_in_what_is_written(source: str, target: str) -> None:
    passed = 0
    for body in BODIES:
        for end in ENDS:
            text = body if not end else body.rstrip(b"\r\n") + b"\n" + end
            framed = () if source == "grbl" else (b"%\n" + text, b"%\n" + text + b"\n%\n")
            for program in (text, *framed):
                found = written(program, source, target)
                if found is not None:
                    passed += 1
                    assert not new_in_output(program, found, reader(source, target)), program
    assert passed >= 10


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
@pytest.mark.parametrize("body", BODIES[:3])
def test_linuxcnc_takes_what_had_no_end(body: bytes, tmp_path: Path) -> None:
    found = written(body, "grbl", "linuxcnc")
    assert found is not None
    (tmp_path / "part.ngc").write_bytes(found)
    assert "STRAIGHT_TRAVERSE" in said(tmp_path, "part.ngc")


MESSAGES = b"""G21 G90
#<depth>=1.5
#7=2
o1 repeat [2]
#<depth>=[#<depth>*-3.7]
(DEBUG, #<none> #<depth> %d#<depth> %f#<depth> %.2f#7)
(PRINT, #7 and #<depth>) #7=[#7/100000]
(LOG, %.9f#7)
(MSG, #7 #<depth>)
G0 X#7 (DEBUG, before #7) #7=[#7+5]
o1 endrepeat
M2
"""


@pytest.mark.skipif(not rs274.available(), reason="rs274 (LinuxCNC) is not installed")
def test_messages_print_what_they_printed(tmp_path: Path) -> None:
    pipeline = gx.Pipeline.parse("absolute", "linuxcnc")
    written_text = replace(pipeline, structure="written-out").run(MESSAGES).text
    assert b"repeat" not in written_text
    (tmp_path / "in.ngc").write_bytes(MESSAGES)
    (tmp_path / "out.ngc").write_bytes(written_text)
    told = [messages(said(tmp_path, name)) for name in ("in.ngc", "out.ngc")]
    assert len(told[0]) == 10
    assert told[0] == told[1]


def messages(text: str) -> list[str]:
    kinds = ("MESSAGE", "LOG(")
    lines = [line.split("N..... ")[-1] for line in text.splitlines()]
    return [line for line in lines if line.startswith(kinds) or " and " in line]


def said(folder: Path, name: str) -> str:
    """Return what LinuxCNC's interpreter says of a file, which it must take to its end."""
    command = ["rs274", "-g", name]
    done = subprocess.run(
        command, cwd=folder, env={"HOME": str(folder), "PATH": "/usr/bin:/bin"}, capture_output=True
    )
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()

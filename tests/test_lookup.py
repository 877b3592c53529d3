"""Subprograms in files of their own: which are taken, and that nothing else is ever opened."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from cli_kit import call

import gcxform as gx
from gcxform.flow.lookup import Folders, Found, LookupFailedError, only
from gcxform.system import inputs

MAIN = b"O1\nG21 G90 G94\nG0 X0. Y0. Z0.\nM98 P7\nM30\n"
SUB = b"O7\nG91 X1.\nM99\n"
OUT = b"O1\nG21 G90 G94\nG0 X0. Y0. Z0.\nG90 X1.\nM30\n"
RULE = gx.LookupRule(numbers=("O{n:04}", "{n}"), names=("{name}",), endings=("", ".nc"))


def run(folder: Path, *more: Path) -> bytes:
    """Return what `absolute` makes of the program in a folder."""
    (folder / "main.nc").write_bytes(MAIN)
    pipeline = gx.Pipeline.parse("absolute", "fanuc")
    reading = gx.read(MAIN, "fanuc", subprograms=more).reading
    made = gx.Pipeline(pipeline.source, pipeline.target, pipeline.passes, reading, stamp=False)
    return made.run(folder / "main.nc").text


@pytest.mark.parametrize(
    "name", ["O7", "O7.nc", "o7.NC", "O0007.nc", "O00007", "7.nc", "0007.tap", "00000007.Nc"]
)
def test_names_of_files(tmp_path: Path, name: str) -> None:
    """A number is found by every name that the control gives to its file, and by no other."""
    (tmp_path / name).write_bytes(SUB)
    if name.startswith("00000007"):
        with pytest.raises(gx.InputError, match="GX210"):
            run(tmp_path)
        return
    assert run(tmp_path) == OUT


def test_the_ending_of_the_program(tmp_path: Path) -> None:
    """A subprogram may end as the program that calls it."""
    (tmp_path / "p.ptp").write_bytes(MAIN)
    (tmp_path / "O7.ptp").write_bytes(SUB)
    assert gx.Pipeline.parse("absolute", "fanuc").run(tmp_path / "p.ptp").text == OUT


def test_other_folders(tmp_path: Path) -> None:
    """Folders are looked at one after the other, and only those that were named."""
    for name in ("a", "b", "subs"):
        (tmp_path / name).mkdir()
    (tmp_path / "subs" / "O7").write_bytes(SUB)
    with pytest.raises(gx.InputError, match="GX210"):
        run(tmp_path / "a", tmp_path / "b")
    assert run(tmp_path / "a", tmp_path / "b", tmp_path / "subs") == OUT


def test_a_program_without_a_folder() -> None:
    """Bytes lie nowhere, so nothing lies beside them."""
    with pytest.raises(gx.InputError, match="GX210"):
        gx.Pipeline.parse("absolute", "fanuc").run(MAIN)


@pytest.mark.parametrize("name", ["../O7", "/etc/passwd", "a/../O0007", "O0007\0", "", "."])
def test_names_with_a_path_find_nothing(tmp_path: Path, name: str) -> None:
    """A name is one of those that a folder lists, or none."""
    (tmp_path / "sub").mkdir()
    (tmp_path / "O7").write_bytes(SUB)
    assert list(Folders([tmp_path / "sub"], RULE).of_name(name)) == []


def test_a_link_that_leads_out(tmp_path: Path) -> None:
    """Of a link counts where it leads: inside of its folder it is a file as any other."""
    (tmp_path / "in").mkdir()
    (tmp_path / "secret").write_bytes(SUB)
    link = tmp_path / "in" / "O0007"
    link.symlink_to(tmp_path / "secret")
    with pytest.raises(LookupFailedError, match="link to a place outside"):
        list(Folders([tmp_path / "in"], RULE).of_number(7))
    link.unlink()
    (tmp_path / "in" / "real").write_bytes(SUB)
    link.symlink_to("real")
    assert [each.text for each in Folders([tmp_path / "in"], RULE).of_number(7)] == [SUB]


@pytest.mark.parametrize("kind", ["pipe", "folder", "unreadable", "huge"])
def test_what_is_no_file(tmp_path: Path, kind: str) -> None:
    """What cannot be read as a file is refused at the call, and does not hang."""
    place = tmp_path / "O7.nc"
    if kind == "pipe":
        os.mkfifo(place)
    elif kind == "folder":
        place.mkdir()
    elif kind == "huge":
        with place.open("wb") as stream:
            stream.truncate(1 << 40)
    else:
        place.symlink_to(tmp_path / "O7.nc")
    with pytest.raises(gx.InputError, match=r"main\.nc:4:1: error\[GX227\]"):
        run(tmp_path)


def test_binary_is_refused_in_its_line(tmp_path: Path) -> None:
    """A file that holds no program is refused as any text is that is none."""
    (tmp_path / "O7").write_bytes(bytes(range(256)))
    with pytest.raises(gx.InputError) as caught:
        run(tmp_path)
    assert {Path(each.where.file).name for each in caught.value.diagnostics if each.where} == {"O7"}


def test_no_folder(tmp_path: Path) -> None:
    """A folder that went away is said."""
    with pytest.raises(LookupFailedError, match="cannot read"):
        list(Folders([tmp_path / "gone"], RULE).of_number(7))


def test_what_was_read_is_not_overwritten(tmp_path: Path) -> None:
    """The file of a subprogram came through the door: no result may take its place."""
    (tmp_path / "O7").write_bytes(SUB)
    with inputs.visit():
        run(tmp_path)
        assert inputs.is_read(tmp_path / "O7")


def test_certificate_and_map_name_files(tmp_path: Path) -> None:
    """The certificate has the hash of every file; the map counts its lines on."""
    (tmp_path / "main.nc").write_bytes(MAIN)
    (tmp_path / "subs").mkdir()
    (tmp_path / "subs" / "O7").write_bytes(SUB)
    said = ["run", "-f", "fanuc", "-x", "absolute", "--subprograms", str(tmp_path / "subs")]
    said += ["--certificate", str(tmp_path / "c"), "--map", str(tmp_path / "m"), "-q"]
    done = call(*said, "-o", str(tmp_path / "o"), str(tmp_path / "main.nc"))
    assert done.exit_code == 0, done.output
    (file,) = json.loads((tmp_path / "c").read_text())["source"]["files"]
    assert (Path(file["name"]).name, file["first"], file["lines"]) == ("O7", 7, 3)
    lines = json.loads((tmp_path / "m").read_text())["lines"]
    assert lines == [[1, 1, 3, 1], [4, 8, 2, -3]]  # 8 is line 2 of the file, 5 the end


def test_two_that_differ_are_named() -> None:
    """Of files with the same bytes any is right."""
    one, same, other = Found("a", b"1"), Found("b", b"1"), Found("c", b"2")
    assert only([one, same], "O7") is one
    with pytest.raises(LookupFailedError, match="O7 stands in more than one file: a and c"):
        only([one, other], "O7")


def test_subprograms_of_a_shop_are_kept(shared: Path) -> None:
    """Real subprograms, whose modes their caller leaves, come out byte for byte."""
    folder = shared / "corpus/programs/fanuc/ailtonbsj-free-cnc-simulator-wine/Mill"
    files = [*folder.glob("MM/Fanuc/50*.nc"), *folder.glob("INCH/Fanuc/60*.nc")]
    assert len(files) == 21
    pipeline = gx.Pipeline.parse("absolute", "fanuc")
    for file in files:
        done = pipeline.run(file)
        assert done.text == file.read_bytes()
        assert done.certificate.verified
        assert {each.code for each in done.certificate.warnings} == {"GX228"}


def test_a_real_caller_names_what_is_missing(shared: Path, tmp_path: Path) -> None:
    """The programs that are there are called, and the one that is not is named."""
    folder = shared / "corpus/programs/fanuc/ailtonbsj-free-cnc-simulator-wine/Mill/INCH/Fanuc"
    pipeline = gx.Pipeline.parse("absolute", "fanuc")
    with pytest.raises(gx.InputError, match="subprogram O6003 is not in this file"):
        pipeline.run(folder / "M98_P_inch.nc")
    (tmp_path / "6003.nc").write_bytes(b"(C)\r\nM99")
    lines = (folder / "M98_P_inch.nc").read_bytes().splitlines(keepends=True)
    plain = [line for line in lines if b"($" not in line and b"M06" not in line]
    (tmp_path / "main.nc").write_bytes(b"".join(plain))
    said = {"subprograms": (folder,), "start": {"Z": 5.0}, "increment": "IS-B"}
    reading = gx.read(MAIN, "fanuc", **said).reading
    whole = gx.Pipeline(pipeline.source, pipeline.target, pipeline.passes, reading)
    done = whole.run(tmp_path / "main.nc").certificate
    assert done.verified
    assert done.source["files"][-1]["name"].endswith("6013.nc")
    assert len(done.source["files"]) == 13

"""Stamps: a program that was turned into commands is not turned into commands twice."""

from __future__ import annotations

import dataclasses
import os
import re

import pytest
import stamp_kit as kit
from cli_kit import call, expanded
from oracles import rs274

import gcxform as gx
from gcxform.stamps.comment import LONGEST, Stamp, Stamps, stamps_in
from gcxform.syntax.source import Source

LINES = "absolute | segment chord-error=1um"
HEAD = "GCXFORM STAMP 0123456789AB COMPENSATED BY 0.1.0 VOLUMETRIC"


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GCXFORM_PIPELINE", raising=False)
    return kit.workplace(tmp_path)


def found(text):
    return stamps_in(Source.of_bytes(text))


# --- what is written ---


@pytest.mark.parametrize("dialect", ["linuxcnc", "fanuc", "haas"])
def test_where_stamps_stand(place, dialect):
    text = kit.pipeline(kit.VOLUMETRIC, place, dialect).run(kit.PLATE).text
    lines = text.split(b"\n")
    assert lines[:2] == [b"%", b"O1000 (PLATE)"]
    assert re.fullmatch(
        rb"\(GCXFORM STAMP [0-9A-F]{12} COMPENSATED BY 0\.1\.0 VOLUMETRIC\)", lines[2]
    )
    assert lines[3] == b"G21 G90 G17 G94"
    assert lines[-4:] == [b"M30", f"(GCXFORM SEAL {kit.seal_of(text)})".encode(), b"%", b""]


def test_grbl_and_no_end_of_the_last_line(place):
    program = b"G21 G90 G94\nG0 X0 Y0 Z5\nG1 X100 F500"
    text = kit.pipeline(kit.VOLUMETRIC, place, "grbl").run(program).text
    assert text.startswith(b"(GCXFORM STAMP ")
    assert text.endswith(f"\n(GCXFORM SEAL {kit.seal_of(text)})\n".encode())
    assert all(len(line) < 80 for line in text.split(b"\n"))
    assert found(text).fits


@pytest.mark.parametrize("program", [b"", b"\n\n", b"%\n%\n", b"(NOTHING)\n"])
def test_what_moves_nothing_has_no_stamp(place, program):
    assert kit.pipeline(kit.VOLUMETRIC, place).run(program).text == program


@pytest.mark.parametrize("end", [b"\n", b"\r\n", b"\r"])
def test_line_ends_are_those_of_the_program(place, end):
    pipe = kit.pipeline(kit.VOLUMETRIC, place, "fanuc")
    program = kit.PLATE.replace(b"\n", end)
    text = pipe.run(program).text
    plain = dataclasses.replace(pipe, stamp=False).run(program).text
    assert kit.bare(text) == plain
    assert text.count(end) == plain.count(end) + 2
    assert found(text).fits


@pytest.mark.parametrize("end", [b"\n", b"\r\n"])
def test_line_ends_may_become_others_on_the_way(place, end):
    program = kit.PLATE.replace(b"\n", end)
    text = kit.pipeline(kit.VOLUMETRIC, place, "fanuc").run(program).text
    sent = text.replace(b"\r", b"") if b"\r" in end else text.replace(b"\n", b"\r\n")
    assert sent != text
    assert found(sent).fits
    assert f"(GCXFORM SEAL {kit.seal_of(sent)})".encode() in text


def test_a_byte_order_mark_stays_first(place):
    text = kit.pipeline(kit.VOLUMETRIC, place, "fanuc").run(b"\xef\xbb\xbf" + kit.PLATE[2:]).text
    assert text.startswith(b"\xef\xbb\xbf")
    assert found(text).fits


def test_the_digest_is_about_the_pipeline_and_not_where_it_is(place, tmp_path_factory):
    def digest(chain, **changes):
        return found(kit.pipeline(chain, place, **changes).run(kit.PLATE).text).stamps[0].digest

    one = digest(kit.VOLUMETRIC)
    assert digest(f"absolute | {kit.VOLUMETRIC}") != one
    assert digest(kit.VOLUMETRIC.replace("5um", "6um")) != one
    assert digest(kit.VOLUMETRIC, words="all") != one
    assert digest(kit.VOLUMETRIC, machine="set.toml") != one
    assert digest(kit.VOLUMETRIC + " iterations=0") == one, "as it is by default"
    other = kit.workplace(tmp_path_factory.mktemp("elsewhere"))
    elsewhere = kit.pipeline(kit.VOLUMETRIC, other).run(kit.PLATE).text
    assert found(elsewhere).stamps[0].digest == one
    (other / "model.toml").write_text(kit.MODEL.replace("0.2", "0.3"))
    changed = kit.pipeline(kit.VOLUMETRIC, other).run(kit.PLATE).text
    assert found(changed).stamps[0].digest != one


def test_many_steps_are_counted():
    steps = tuple(f"STEP-{n}" for n in range(30))
    stamp = Stamp("0" * 12, ("COMPENSATED", "AXES"), "ABCDEF", "0.1.0", steps)
    assert len(stamp.content) <= LONGEST
    assert re.search(r"0\.1\.0 AND 30 MORE$", stamp.content)


def test_the_certificate_has_them(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    done = pipe.run(kit.PLATE)
    assert done.certificate.stamps["written"] == [done.text.split(b"\n")[2].decode()]
    assert done.certificate.output["lines"] == done.text.count(b"\n") == len(done.source_map)
    assert done.certificate.growth["blocks_out"] == done.text.count(b"\n") - 2
    worst = done.text.split(b"\n")[done.certificate.largest["output_line"] - 1]
    assert worst[:1] in b"GXY", "the line that is meant, stamps counted"
    stripped = kit.pipeline("strip", place).run(done.text).certificate
    assert stripped.stamps["read"] == [done.certificate.stamps["written"][0][1:-1]]


def test_the_map_has_their_neighbours(place):
    done = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE)
    lines = done.text.split(b"\n")
    source = kit.PLATE.split(b"\n")
    assert len(done.source_map) == len(lines) - 1
    assert source[done.source_map[2]] == lines[3]
    assert source[done.source_map[-2]] == b"M30"
    assert source[done.source_map[-1]] == b"%"


def test_a_map_of_runs(place):
    (place / "part.nc").write_bytes(kit.PLATE)
    words = ("run", "-f", "linuxcnc", "-x", kit.VOLUMETRIC, "--map", "map.json", "-o", "out.nc")
    assert call(*words, "part.nc").exit_code == 0
    import json

    document = json.loads((place / "map.json").read_text())
    whole = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE)
    assert expanded(document["lines"]) == whole.source_map


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("program", [kit.PLATE, kit.PLATE[2:-2], kit.PLATE.replace(b"%\n", b"")])
def test_linuxcnc_takes_stamped_programs(place, program):
    program = program.replace(b"O1000 (PLATE)\n", b"")
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    stamped, plain = (pipe.run(program), dataclasses.replace(pipe, stamp=False).run(program))
    ends = [[move.machine[1] for move in rs274.run(each.text).moves] for each in (stamped, plain)]
    assert ends[0] == ends[1] != []


# --- the proof ---


def test_a_stamp_that_is_not_written_is_noticed(place, monkeypatch):
    monkeypatch.setattr("gcxform.stamps.writing.Heads.edit", lambda self, text: (text, None))
    with pytest.raises(gx.VerificationError, match="GX609"):
        kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE)


def test_a_stamp_that_is_not_read_is_noticed(place, monkeypatch):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    once = pipe.run(kit.PLATE).text
    monkeypatch.setattr("gcxform.pipeline.plan.stamps_in", lambda source: Stamps())
    for stamp in (True, False):
        with pytest.raises(gx.VerificationError, match="GX609"):
            dataclasses.replace(pipe, stamp=stamp).run(once)


def test_a_seal_of_another_text_is_noticed(place, monkeypatch):
    monkeypatch.setattr("gcxform.stamps.writing.short", lambda digest: "0" * 12)
    with pytest.raises(gx.VerificationError, match="GX609"):
        kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE)


def test_a_dialect_without_comments_has_no_stamps(place):
    spoken = gx.Registry.load().dialects["linuxcnc"]

    class Mute(spoken):
        name = "mute"
        text_rule = dataclasses.replace(spoken.text_rule, comments="")

    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    done = dataclasses.replace(pipe, target=Mute).run(kit.PLATE.replace(b" (PLATE)", b""))
    assert b"GCXFORM" not in done.text
    assert any("no stamp" in line for line in done.certificate.not_checked)


# --- never twice ---


def test_once_and_not_twice(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    once = pipe.run(kit.PLATE).text
    assert kit.code(pipe, once) == "GX241"
    assert kit.code(kit.pipeline(kit.VOLUMETRIC + " outside=clamp", place), once) == "GX240"
    edited = once.replace(b"G0 ", b"G00 ")
    assert kit.code(pipe, edited) == "GX240"
    assert kit.code(pipe, once[: once.index(b"M30")]) == "GX240"


def test_again(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    once = pipe.run(kit.PLATE).text
    twice = dataclasses.replace(pipe, again=True).run(once)
    assert any("once more" in line and "COMPENSATED" in line for line in twice.certificate.assumed)
    assert [stamp.facts for stamp in found(twice.text).stamps] == [("COMPENSATED",)] * 2
    assert not any("once more" in line for line in pipe.run(kit.PLATE).certificate.assumed)


def test_there_and_back_and_there(place):
    there, back = (kit.pipeline(chain, place) for chain in (kit.VOLUMETRIC, kit.INVERSE))
    assert kit.code(back, kit.PLATE) == "", "a program without stamps may be anything"
    commands = there.run(kit.PLATE).text
    nominal = back.run(commands).text
    assert [stamp.facts for stamp in found(nominal).stamps] == [("NOMINAL",), ("COMPENSATED",)]
    assert kit.code(back, nominal) == "GX241"
    again = there.run(nominal).text
    assert len(found(again).stamps) == 3
    assert kit.code(there, again) == "GX241"


def test_tips_and_axes(place):
    to_axes, to_tips = (
        kit.pipeline(
            f"{LINES} | {name} tolerance=10um",
            place,
            machine="set.toml",
        )
        for name in ("rtcp", "to-tip")
    )
    axes = to_axes.run(kit.TIPS).text
    assert re.search(rb"\(GCXFORM STAMP \w{12} AXES [0-9A-F]{6} BY 0.1.0 RTCP\)", axes)
    assert kit.code(to_axes, axes) == "GX241"
    tips = to_tips.run(axes).text
    assert found(tips).stamps[0].facts == ("TIP",)
    assert kit.code(to_tips, tips) == "GX241"
    assert kit.code(to_axes, tips) == ""
    both = kit.pipeline(kit.VOLUMETRIC, place).run(axes).text
    assert [stamp.facts for stamp in found(both).stamps] == [("COMPENSATED",), ("AXES",)]
    for pipe in (to_axes, to_tips):  # both take positions for nominal
        assert kit.code(pipe, both) == ("GX241" if pipe is to_axes else "GX240")


def test_one_run_of_two_steps_is_one_stamp(place):
    chain = f"{LINES} | rtcp tolerance=10um | {kit.VOLUMETRIC}"
    text = kit.pipeline(chain, place, machine="set.toml").run(kit.TIPS).text
    (stamp,) = found(text).stamps
    assert stamp.facts == ("COMPENSATED", "AXES")
    assert stamp.steps == ("RTCP", "VOLUMETRIC")


def test_axes_are_corrected_once(place):
    repost = f"{LINES} | repost calibrated=found.toml tolerance=10um"
    pipe = kit.pipeline(repost, place, machine="set.toml")
    once = pipe.run(kit.TIPS).text
    assert kit.code(pipe, once) == "GX241"
    assert kit.code(kit.pipeline(repost, place, machine="found.toml"), once) == ""
    to_axes = f"{LINES} | rtcp tolerance=10um"
    assert kit.code(pipe, kit.pipeline(to_axes, place, machine="set.toml").run(kit.TIPS).text) == ""
    wrong = kit.pipeline(to_axes, place, machine="found.toml").run(kit.TIPS).text
    assert kit.code(pipe, wrong) == "GX240"


def test_what_needs_no_positions_runs_on(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    for chain in (
        "absolute",
        "strip",
        "renumber",
        "strip | renumber",
        "segment chord-error=1um | metric",
    ):
        text = kit.pipeline(chain, place).run(once).text
        assert found(text).fits, chain
        assert [stamp.content for stamp in found(text).stamps] == [
            stamp.content for stamp in found(once).stamps
        ]
        assert kit.code(kit.pipeline(kit.VOLUMETRIC, place), text) == "GX241"


def test_a_copy_is_a_copy(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    edited = once.replace(b"(GCX", b"  (gcx", 1)
    assert kit.pipeline("", place).run(edited).text == edited


def test_text_passes_in_the_run_keep_the_stamp(place):
    text = kit.pipeline(f"{kit.VOLUMETRIC} | strip | renumber", place).run(kit.PLATE).text
    assert len(found(text).stamps) == 1
    assert found(text).fits
    assert b"\n(GCXFORM STAMP" in text


def test_another_dialect_keeps_it(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    text = kit.pipeline("", place, to="grbl").run(once).text
    assert text.startswith(b"(PLATE)\n(GCXFORM STAMP")
    assert found(text).fits
    assert kit.code(kit.pipeline(kit.VOLUMETRIC, place, "grbl"), text) == "GX240"


def test_no_stamp(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    plain = dataclasses.replace(pipe, stamp=False)
    text = plain.run(kit.PLATE).text
    assert b"GCXFORM" not in text
    assert kit.bare(pipe.run(kit.PLATE).text) == text
    back = dataclasses.replace(kit.pipeline(kit.INVERSE, place), stamp=False)
    assert b"GCXFORM" not in back.run(pipe.run(kit.PLATE).text).text, "it would say what is not so"
    absolute = dataclasses.replace(kit.pipeline("absolute", place), stamp=False)
    assert found(absolute.run(pipe.run(kit.PLATE).text).text).fits


def test_edited_programs_stay_edited(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    edited = once.replace(b"Y50.", b"Y51.").replace(b"X0. Y51.", b"X0. Y50.")
    done = kit.pipeline("absolute", place).run(edited)
    assert done.certificate.stamps["edited"] == "it has been edited since"
    assert found(done.text).edited == "it has been edited since"
    cut = kit.pipeline("absolute", place).run(once[: once.index(b"(GCXFORM SEAL")])
    assert "seal" in cut.certificate.stamps["edited"]
    assert b"SEAL" not in cut.text


# --- what is read ---


@pytest.mark.parametrize(
    "line",
    [
        f"({HEAD})",
        f"  ( {HEAD.lower()} )  ",
        f"N10 ({HEAD})",
        f"n0010({HEAD})",
        f";{HEAD}",
        f"; {HEAD})",
        f"({HEAD.replace(' ', '')})",
        f"(Gcxform Stamp {HEAD[14:]})",
        f"G21 ({HEAD})",
        f"({HEAD.replace('VOLUMETRIC', 'A-PASS OF 9 OTHERS AND 2 MORE')})",
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r", ""])
def test_a_stamp_is_known_however_it_is_written(line, end):
    stamps = found(f"%{end or chr(10)}{line}{end}".encode())
    assert [stamp.facts for stamp in stamps.stamps] == [("COMPENSATED",)]
    assert stamps.stamps[0].version == "0.1.0"
    assert stamps.line == 2
    assert not stamps.fits


@pytest.mark.parametrize(
    "line",
    [
        "(GCXFORM)",
        "(MADE WITH GCXFORM 0.1.0 VOLUMETRIC)",
        "(GCXFORM STAMP IS NOT HERE)",
        "(GCXFORM STAMP 0123456789)",
        "(THE GCXFORM STAMP 0123456789AB COMPENSATED BY 0.1.0 VOLUMETRIC)",
        "GCXFORM STAMP 0123456789AB COMPENSATED BY 0.1.0 VOLUMETRIC",
        "(gcxform seals 20079D8EA095)",
    ],
)
def test_a_comment_that_talks_of_gcxform_is_no_stamp(line):
    assert not found(f"%\n{line}\nG0 X1\n".encode())


@pytest.mark.parametrize(
    "line",
    [
        "(GCXFORM STAMP 0123456789AB)",
        "(GCXFORM STAMP 0123456789AB",
        "(GCXFORM STAMP 0123456789AB COMPENSATED)",
        "(GCXFORM STAMP 0123456789AB COMPENSATED NOMINAL BY 0.1.0 X)",
        "(GCXFORM STAMP 0123456789AB BY 0.1.0 X)",
        "(GCXFORM STAMP 0123456789AB TWICE BY 0.1.0 X)",
        "(GCXFORM STAMP 0123456789AB \xe4\xff BY)",
        "(GCXFORM SEAL 0123456789AB)",
    ],
)
def test_a_broken_stamp_is_refused_where_it_matters(place, line):
    program = kit.PLATE.replace(b"G21", line.encode("latin-1") + b"\nG21", 1)
    if line.endswith(")"):
        assert kit.code(kit.pipeline("absolute", place), program) == ""
    assert kit.code(kit.pipeline(kit.VOLUMETRIC, place), program) == "GX240"


# --- the command line ---


def test_post_twice(place):
    (place / "part.nc").write_bytes(kit.PLATE)
    words = ("post", "-f", "linuxcnc", "-x", kit.VOLUMETRIC, "part.nc")
    assert call(*words).exit_code == 0
    once = (place / "part.nc").read_bytes()
    os.utime("part.nc", (1_600_000_000, 1_600_000_000))
    second = call(*words)
    assert second.exit_code == 0
    assert "done already" in second.stderr
    assert "2020-09-13" in second.stderr
    assert (place / "part.nc").read_bytes() == once
    assert os.stat("part.nc").st_mtime == 1_600_000_000
    other = call("post", "-f", "linuxcnc", "-x", f"{kit.VOLUMETRIC} outside=clamp", "part.nc")
    assert other.exit_code == 3
    assert "gcxform 0.1.0 did volumetric" in other.stderr
    (place / "part.nc").write_bytes(once.replace(b"Y50.", b"Y51."))
    edited = call(*words)
    assert edited.exit_code == 3
    assert "edited since" in edited.stderr


def test_run_twice(place):
    (place / "part.nc").write_bytes(kit.PLATE)
    words = ("run", "-f", "linuxcnc", "-x", kit.VOLUMETRIC)
    assert call(*words, "-o", "once.nc", "part.nc").exit_code == 0
    second = call(*words, "-o", "twice.nc", "once.nc")
    assert second.exit_code == 3
    assert "GX241" in second.stderr
    assert "done already" in second.stderr
    assert not (place / "twice.nc").exists()
    assert call(*words, "--again", "-o", "twice.nc", "once.nc").exit_code == 0
    assert call(*words, "--no-stamp", "-o", "plain.nc", "part.nc").exit_code == 0
    assert b"GCXFORM" not in (place / "plain.nc").read_bytes()


def test_a_pipeline_file_says_it_too(place):
    (place / "part.nc").write_bytes(kit.PLATE)
    job = '[input]\ndialect = "linuxcnc"\n{}[[pass]]\nuse = "volumetric"\nmodel = "model.toml"\n'
    job = "format = 1\n" + job + "part-origin = [0, 0, 0]\n[output]\nstamp = {}\n"
    for again, stamp in (("", "true"), ("again = true\n", "false")):
        (place / "job.toml").write_text(job.format(again, stamp))
        assert call("post", "-p", "job.toml", "part.nc").exit_code == 0
        assert (b"GCXFORM" in (place / "part.nc").read_bytes()) == (stamp == "true")


def test_edited_is_a_warning_where_nothing_depends_on_it(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    (place / "part.nc").write_bytes(once.replace(b"Y50.", b"Y51."))
    for verb in (("run", "-o", "out.nc"), ("post",), ("check",)):
        said = call(verb[0], "-f", "linuxcnc", "-x", "absolute", *verb[1:], "part.nc")
        assert said.exit_code == 0
        assert "warning[GX242]" in said.stderr


def test_info_and_check_say_what_it_is(place):
    (place / "part.nc").write_bytes(kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text)
    assert "gcxform 0.1.0 did volumetric: COMPENSATED" in call("info", "part.nc").stdout
    checked = call("check", "-f", "linuxcnc", "-x", kit.VOLUMETRIC, "part.nc")
    assert checked.exit_code == 1
    assert "gcxform 0.1.0 did volumetric: COMPENSATED" in checked.stdout
    assert "GX241" in checked.stderr
    plain = call("check", "-f", "linuxcnc", "part.nc")
    assert plain.exit_code == 0
    assert "not edited since" in plain.stdout


def test_compare_does_not_mind(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    (place / "a.nc").write_bytes(pipe.run(kit.PLATE).text)
    (place / "b.nc").write_bytes(dataclasses.replace(pipe, stamp=False).run(kit.PLATE).text)
    assert "SAME" in call("compare", "-f", "linuxcnc", "a.nc", "b.nc").stdout


def test_resume_carries_the_stamp(place):
    once = kit.pipeline(kit.VOLUMETRIC, place).run(kit.PLATE).text
    (place / "part.nc").write_bytes(once)
    line = once[: once.index(b"Y50.")].count(b"\n") + 1
    words = ("resume", "-f", "linuxcnc", "--line", str(line), "--clearance", "50mm")
    assert len(found(call(*words, "part.nc").stdout_bytes).stamps) == 1
    whole = call(*words, "--rest", "part.nc").stdout_bytes
    assert found(whole).fits
    assert kit.code(kit.pipeline(kit.VOLUMETRIC, place), whole) == "GX241"
    (place / "part.nc").write_bytes(once.replace(b"M30", b"M02"))
    assert not found(call(*words, "--rest", "part.nc").stdout_bytes).fits


def test_nothing_is_written_on_a_refusal(place):
    pipe = kit.pipeline(kit.VOLUMETRIC, place)
    parts = []
    with pytest.raises(gx.InputError):
        pipe.run_stream(Source.of_bytes(pipe.run(kit.PLATE).text), parts.append)
    assert parts == []

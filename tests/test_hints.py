"""Hints help: what they give is a setting that takes its value, said as the user can say it."""

from __future__ import annotations

import json
import pickle
from pathlib import Path
from typing import Any

import pytest
from cli_kit import call
from rtcp_kit import chain_of_kind, machine_text
from rtcp_kit import pipeline as rtcp

import gcxform as gx
from gcxform.catalogue.remedies import StepBefore, put_before, ways
from gcxform.catalogue.settings import ON_COMMAND_LINE, for_chain, settings
from gcxform.cli.common.options import pipeline_options
from gcxform.pipeline.file import SECTIONS
from gcxform.plugin.registry import default_registry
from gcxform.testing.hints import try_hint


@pytest.mark.parametrize(
    ("hint", "typed"),
    [
        ('increment = "IS-B" in [input] if it is so', "--increment IS-B if it is so"),
        ('increment = "calculator IS-B" in [input]', "--increment 'calculator IS-B'"),
        ("or say start = { X = ... } in [input]", "or say --start X=..."),
        ("decimals = { A = 4, C = 4 } in [output]", "--decimals A=4,C=4"),
        ('deviation = "20 um" in [budget]', "--budget 20um"),
        ('file = "machine.toml" in [machine]', "-m machine.toml"),
        ('chord-error = "2 um", or arcs = "split"', "chord-error=2um, or arcs=split"),
        ("part-origin = [0, 1.5, z]", "part-origin=0,1.5,z"),
        ('peck-return = "0.5 mm" in [control]', 'peck-return = "0.5 mm" in [control]'),
        ("start: X=4 is fine", "start: X=4 is fine"),
    ],
)
def test_hints_for_who_typed_a_chain(hint: str, typed: str) -> None:
    assert for_chain(hint) == typed


@pytest.mark.parametrize(
    "hint",
    [
        'increments = "IS-B" in [input]',
        'increment = "IS-F" in [input]',
        'block-delete = "maybe" in [input]',
        "growth = 0 in [budget]",
        'chord-error = "2 parsec"',
        'colour = "red" in [output]',
    ],
)
def test_a_hint_that_would_not_work_is_found(hint: str) -> None:
    with pytest.raises(ValueError, match=r"[a-z]"):
        try_hint(hint, default_registry())


def test_every_key_of_the_command_line_is_one_of_a_pipeline_file() -> None:
    @pipeline_options
    def command() -> None: ...

    known = {option for each in command.__click_params__ for option in each.opts}  # type: ignore[attr-defined]
    for (section, key), option in ON_COMMAND_LINE.items():
        (setting,) = settings(f"{key} = 1 in [{section}]")
        assert section in SECTIONS
        assert setting.key == key
        assert option in known, option


# --- what is typed works ---

DRILL = b"G21 G90 G94 G17\nG0 X0. Y0. Z5.\nG81 X1. Y1. Z-5. R1. F100\nG80\nM30\n"


def hint_of(file: Path, text: bytes, *words: str) -> str:
    file.write_bytes(text)
    found = call("run", *words, str(file), "-o", str(file.with_suffix(".out")))
    assert found.exit_code in (2, 3), found.stderr
    return found.stderr.partition("hint: ")[2].strip()


def test_the_way_out_of_a_chain_is_an_option(tmp_path: Path) -> None:
    file = tmp_path / "f.nc"
    text = b"G21 G90 G94\nG0 X1000 Y0 Z0\nM30\n"
    hint = hint_of(file, text, "-f", "fanuc", "-x", "absolute")
    assert hint.startswith("--increment IS-B if X1000 is 1 mm, --increment calculator if")
    assert (
        call("run", "-f", "fanuc", "-x", "absolute", "--increment", "IS-B", str(file)).exit_code
        == 0
    )


def test_who_has_a_file_is_told_what_to_write_into_it(tmp_path: Path) -> None:
    pipeline = tmp_path / "p.toml"
    pipeline.write_text('format = 1\n[input]\ndialect = "fanuc"\n[[pass]]\nuse = "absolute"\n')
    hint = hint_of(tmp_path / "f.nc", b"G0 X10\n", "-p", str(pipeline))
    assert hint.startswith('increment = "IS-B" in [input]')


def test_a_budget_can_be_typed(tmp_path: Path) -> None:
    file = tmp_path / "f.nc"
    chain = ("-f", "linuxcnc", "-x", "segment arcs=split max-length=1mm arc-step=1deg")
    words = ("-f", "linuxcnc", "-x", "segment arc-step=1deg")
    text = b"G21 G90\nG0 X0 Y0\nG2 X20 Y0 I10 F100\nM2\n"
    assert "--budget 20um" in hint_of(file, text, *words)
    assert call("run", *words, "--budget", "20um", str(file)).exit_code == 0
    assert call("run", *chain, "--budget", "20um", "--growth", "2", str(file)).exit_code in (2, 3)


def test_decimals_feed_units_and_parameters_can_be_typed(tmp_path: Path) -> None:
    file = tmp_path / "f.nc"
    file.write_bytes(b"G91.1\nG1 X#100 Y0 Z0\nM2\n")
    words = ("run", "-q", "-f", "linuxcnc", "-x", "metric", "--feed", "2", "--units", "in")
    found = call(*words, "--parameters", "100=0.5", "--decimals", "X=2", str(file))
    assert found.exit_code == 0, found.stderr
    assert "X12.7 " in found.stdout
    assert call(*words, "--parameters", "100", str(file)).exit_code == 2
    assert call(*words, "--decimals", "X=a", str(file)).exit_code == 2


WAIT = DRILL.replace(b"G81", b"G82 P500.")  # 0.5 s on a Fanuc, 500 s on a Haas


def test_cycles_have_a_way_out(tmp_path: Path) -> None:
    hint = hint_of(tmp_path / "f.nc", WAIT, "-f", "fanuc", "-t", "haas", "-x", "absolute")
    assert hint == 'put the pass "cycles" before'
    chain = gx.Pipeline.parse("cycles | absolute", "fanuc")
    assert chain.run(DRILL).certificate.verified


def test_g92_in_inches_has_one_too() -> None:
    text = b"G20 G90 G94\nG0 X1 Y1 Z1\nG92 X1 Y0 Z0\nG1 X2 F5\nM2\n"
    with pytest.raises(gx.InputError) as caught:
        gx.Pipeline.parse("metric", "linuxcnc").run(text)
    assert 'the pass "offsets" before' in caught.value.diagnostics[0].hint
    found = gx.Pipeline.parse("offsets | metric", "linuxcnc").run(text)
    assert b"G1 X50.8" in found.text  # 1 inch on from X25.4, which G92 calls 1 inch


def test_a_tolerance_without_unit_is_asked_about(tmp_path: Path) -> None:
    def warned(chain: str) -> list[str]:
        return [each.hint for each in gx.Pipeline.parse(chain, "linuxcnc").warnings]

    assert warned("segment chord-error=5") == [
        'chord-error = "5 um" if it is 5 um, chord-error = "5 mm" if it is not'
    ]
    assert warned("segment chord-error=5mm | arcs tolerance=0.1") == []
    file = tmp_path / "f.nc"
    file.write_bytes(b"G0 X0\nM2\n")
    found = call("check", "-f", "linuxcnc", "-x", "segment chord-error=5", str(file))
    assert "warning[GX748]" in found.stderr
    assert "chord-error=5um if it is 5 um" in found.stderr
    pipeline = tmp_path / "p.toml"
    pipeline.write_text("format = 1\n[input]\ndialect = 'grbl'\n[budget]\ndeviation = 20\n")
    assert "deviation = 20 is 20 mm" in call("check", "-p", str(pipeline)).stderr


SEGMENT = "segment chord-error=5"


def found_of(file: Path, text: bytes, *words: str) -> list[dict[str, Any]]:
    file.write_bytes(text)
    done = call("check", "--json", *words, str(file))
    assert done.stderr == ""
    found: list[dict[str, Any]] = json.loads(done.stdout)["findings"]
    assert done.exit_code == (1 if found else 0)
    return found


def test_findings_are_values_with_their_ways_out(tmp_path: Path) -> None:
    file = tmp_path / "p.nc"
    (found,) = found_of(file, WAIT, "-f", "fanuc", "-t", "haas", "-x", "absolute")
    assert found["ways"] == [[{"kind": "pass", "name": "cycles"}]]
    assert (found["place"]["file"], found["place"]["line"]) == (str(file), 3)
    text = b"G21 G90 G94\nG0 X0 Y0 Z0\n/G1 X1. F9.\nM30\n"
    (found,) = found_of(file, text, "-f", "fanuc", "-x", "absolute")
    keys = {"kind": "setting", "file": "pipeline", "section": "input", "key": "block-delete"}
    assert found["ways"] == [[{**keys, "value": '"execute"'}], [{**keys, "value": '"skip"'}]]
    assert found_of(file, DRILL, "-f", "fanuc", "-x", "absolute") == []


ENDING = {
    "no file": (("-f", "linuxcnc", "none.nc"), 5, ["GX901"]),
    "no pass": (("-f", "linuxcnc", "-x", "nosuch", "p.nc"), 2, ["GX704"]),
    "no pipeline": (("-p", "none.toml", "p.nc"), 2, ["GX709"]),
    "a key that is none": (("--limit", "x=1", "p.nc"), 2, ["GX701"]),
    "a line too long": (("--limit", "line=4", "-f", "linuxcnc", "-x", "", "p.nc"), 3, ["GX761"]),
    "an option that is none": (("--bogus",), 2, ["GX700"]),
    "warned before": (("-f", "linuxcnc", "-x", SEGMENT, "none.nc"), 5, ["GX748", "GX901"]),
}


@pytest.mark.parametrize("name", ENDING)
def test_what_ends_a_check_is_a_finding_as_well(name: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.nc").write_bytes(b"G0 X1 Y1\nM2\n")
    words, code, codes = ENDING[name]
    done = call("check", *words, "--json")
    assert (done.exit_code, done.stderr) == (code, "")
    assert [found["code"] for found in json.loads(done.stdout)["findings"]] == codes
    assert call("check", *words).exit_code == code


def test_what_ends_info_is_a_finding_too(tmp_path: Path) -> None:
    done = call("info", "--json", str(tmp_path / "none.nc"))
    assert (done.exit_code, done.stderr) == (5, "")
    assert [found["code"] for found in json.loads(done.stdout)["findings"]] == ["GX901"]


def test_what_a_hint_offers_goes_with_it() -> None:
    hint = pickle.loads(pickle.dumps(put_before("feed", "rtcp", "mode=inverse-time") + ", or so"))
    assert hint == 'put the pass "feed" before "rtcp", with mode = "inverse-time", or so'
    assert ways(hint) == [(StepBefore("feed", "rtcp", "mode=inverse-time"),)]
    places = "X = ... in [work-offset.G55], length = ... in [tool.*]"
    assert [len(way) for way in ways(places)] == [2]


# --- hints that do no harm ---

TURNED = b"G21 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\nG43.4 H1 Z0.\nG1 X5. A20. F600.\n"


def test_behind_g49_the_tool_is_taken_out_of_the_part_before_axes_turn(tmp_path: Path) -> None:
    """With axes turned the tool stands in the part: to turn them back there would cut it."""
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    step = rtcp(tmp_path, machine, tolerance=0.01, tip_codes="read")
    with pytest.raises(gx.InputError) as caught:
        step.run(TURNED + b"G49\nG1 X9. F600.\nM30\n")
    (found,) = caught.value.diagnostics
    assert found.code == "GX330"
    assert "along its axis and turn" in found.hint


def test_the_setting_for_pecks_is_one_that_works(tmp_path: Path) -> None:
    text = DRILL.replace(b"G81", b"G83").replace(b"R1.", b"R1. Q2.")
    hint = hint_of(tmp_path / "f.nc", text, "-f", "fanuc", "-x", "cycles")
    setting = hint.partition(" in [control] of the machine file")[0]
    machine = tmp_path / "m.toml"
    machine.write_text(f"format = 1\n[control]\n{setting}\n")
    words = ("-f", "fanuc", "-x", "cycles", "-m", str(machine))
    found = call("run", *words, str(tmp_path / "f.nc"), "-o", str(tmp_path / "f.out"))
    assert found.exit_code == 0, found.stderr


@pytest.mark.parametrize("tool", ["2 TOOL CALL 1 Z S1000\n", ""])
def test_where_axes_stand_at_the_start_is_asked_only_where_that_helps(
    tool: str, tmp_path: Path
) -> None:
    text = f"0 BEGIN PGM A MM\n{tool}3 L IX+10 R0 FMAX\n4 END PGM A MM\n".encode()
    hint = hint_of(tmp_path / "f.h", text, "-f", "heidenhain", "-t", "fanuc", "-x", "absolute")
    helps = "--start" in hint
    start = ("--start", "X=0,Y=0,Z=0")
    found = call("check", "-f", "heidenhain", *start, str(tmp_path / "f.h"))
    assert helps == ("GX207" not in found.stderr)
    assert helps or "write X absolute before: what line 2 does loses it" in hint


# --- hints that are words ---

HEAD = "G21 G90 G94 G17"
WORDS = {
    "a motion code": (
        "write G1 in this block, or G0 if the way is clear",
        f"{HEAD} F9.\nX1.\n",
        f"{HEAD} F9.\nG1 X1.\n",
    ),
    "a feed": (
        "write an F word",
        f"{HEAD}\nG0 X0. Y0.\nG1 X1.\n",
        f"{HEAD}\nG0 X0. Y0.\nG1 X1. F50.\n",
    ),
    "a start of an arc": (
        "begin with a line to a known point",
        f"{HEAD} F9.\nG2 X1. Y0. I.5 J0.\n",
        f"{HEAD} F9.\nG1 X0. Y0.\nG2 X1. Y0. I.5 J0.\n",
    ),
    "a place of the machine in G91": (
        "write it under G90, with its place in the machine",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG91\nG53 G0 Z0.\n",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG91\nG90 G53 G0 Z0.\n",
    ),
    "a place of the machine by an arc": (
        "write G0 in this block if the way is clear, or G1",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG2 X1. Y0. I.5 J0.\nG53 X5.\n",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG2 X1. Y0. I.5 J0.\nG53 G0 X5.\n",
    ),
    "a plane in a contour": (
        "lead the tool off the contour and cancel it with G40 before, and begin it again behind",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG41.1 D2 G1 X10.\nX20.\nG18\nX30.\nG40 G1 Y20.\n",
        f"{HEAD} F9.\nG0 X0. Y0. Z0.\nG41.1 D2 G1 X10.\nX20.\nG40 G1 Y20.\nG18\nX30.\nG17\n"
        "G41.1 D2 G1 X40.\nX50.\nG40 G1 Y40.\n",
    ),
}
"""Advice in words: what it says, a program that gets it, and the program that follows it."""


@pytest.mark.parametrize("name", WORDS)
def test_advice_in_words_is_followed_and_leads_out(name: str) -> None:
    said, before, after = WORDS[name]
    chain = gx.Pipeline.parse("absolute", "linuxcnc")
    with pytest.raises(gx.InputError) as caught:
        chain.run(f"{before}M2\n".encode())
    assert said in caught.value.diagnostics[0].hint
    assert chain.run(f"{after}M2\n".encode()).certificate.verified

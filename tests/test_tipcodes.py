"""Codes that let the control follow the tip, as `rtcp` reads them."""

from __future__ import annotations

import hashlib

import pytest
from rtcp_kit import chain_of_kind, machine_text, pipeline

import gcxform as gx
from gcxform.contract.tip_codes import without_tip_codes
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

FANUC = default_registry().dialect("fanuc")
POINTS = "X10. Y5. Z3. A0. C0.\nX12. Y7. Z4. A20. C30.\nX9. Y2. Z2. A40. C-15.\nX9. Y2. A0. C0.\n"


def program(code: str) -> bytes:
    head = f"G21 G90 G94 G17 G54\nG0 X0. Y0. A0. C0.\n{code} H1 Z0.\nG1 F600.\n"
    return f"{head}{POINTS}G49\nM30\n".encode()


@pytest.mark.parametrize("spelling", ["G43.4", "G043.40", "G 43 . 4"])
def test_it_writes_what_it_writes_of_tips(tmp_path, spelling):
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    plain = pipeline(tmp_path, machine, tolerance=0.01).run(program("G43"))
    read = pipeline(tmp_path, machine, tolerance=0.01, tip_codes="read").run(program(spelling))
    assert read.text == plain.text
    assert read.certificate.verified
    assert read.certificate.source["sha256"] == hashlib.sha256(program(spelling)).hexdigest()
    assert read.source_map == plain.source_map


def test_unless_asked_it_refuses(tmp_path):
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    with pytest.raises(gx.InputError, match="GX210"):
        pipeline(tmp_path, machine, tolerance=0.01).run(program("G43.4"))


@pytest.mark.parametrize("use", ["to-tip", "repost"])
def test_nothing_is_corrected_twice(tmp_path, use):
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3))
    options = {"calibrated": "machine.toml"} if use == "repost" else {}
    with pytest.raises(gx.UsageError, match="unknown key 'tip-codes'"):
        pipeline(tmp_path, machine, tolerance=0.01, use=use, tip_codes="read", **options)


@pytest.mark.parametrize(
    "text", [b"G43 H1\nG43.1 X1\n", b"(G43.4)\nG43 H1\n", b"G43.41\nG143.4\nG43.4.1\n", b""]
)
def test_other_codes_stay(text):
    source = Source.of_bytes(text)
    assert without_tip_codes(source, FANUC.tip_rule.codes) is source


def test_windows_of_any_size_are_alike():
    text = b"(G43.4 here)\r\nG43.4 H1 Z5.\r\nG1 X1.\r\n(again) G43.4 H2\r\n"
    source = without_tip_codes(Source.of_bytes(text), FANUC.tip_rule.codes)
    wanted = b"(G43.4 here)\r\nG43 H1 Z5.\r\nG1 X1.\r\n(again) G43 H2\r\n"
    for size in (1, 5, 17, 1000):
        assert b"".join(source.windows(size)) == wanted


@pytest.mark.parametrize("size", [3, 1000])
def test_a_program_with_both_is_refused_at_the_plain_one(size):
    source = without_tip_codes(
        Source.of_bytes(b"G43.4 H1\n(G43)\nG1 X1.\nG43H2\n"), FANUC.tip_rule.codes
    )
    with pytest.raises(gx.InputError) as error:
        b"".join(source.windows(size))
    assert error.value.diagnostics[0].where.line == 4

"""What a program was taken to mean that it does not say: in the certificate, and in `check`."""

from __future__ import annotations

from pathlib import Path

import pytest
from cli_kit import call

import gcxform as gx
from gcxform.diagnostics import Severity

PLUNGE = b"G21 G90 G94\nG0 X0. Y0. Z50.\nG28 Z0.\nM30\n"


def assumed(text: bytes, dialect: str, chain: str = "absolute") -> gx.Certificate:
    return gx.Pipeline.parse(chain, dialect).run(text).certificate


def test_a_way_home_that_leads_down_is_said_and_warned_of() -> None:
    found = assumed(PLUNGE, "fanuc")
    (warning,) = found.warnings
    assert (warning.code, warning.severity) == ("GX229", Severity.WARNING)
    assert warning.where is not None
    assert warning.where.line == 3
    assert "down by 50 mm" in warning.message
    assert warning.message in found.assumed
    assert "warnings" not in found.to_json()


@pytest.mark.parametrize(
    "line", [b"G91 G28 Z0.", b"G28 Z60.", b"G28 Z50.", b"G28 X0.", b"G91 G28 Z-1."]
)
def test_other_ways_home_are_not(line: bytes) -> None:
    assert not assumed(PLUNGE.replace(b"G28 Z0.", line), "fanuc").warnings


def test_nothing_is_assumed_of_what_a_program_does_not_use() -> None:
    found = assumed(b"G21 G90 G94 G17 G40 G54\nG0 X0. Y0.\nM30\n", "fanuc").assumed
    assert found == []


def test_calls_of_what_is_not_at_hand_are_counted() -> None:
    calls = b"G65 P9832\nG65 P9810 X1. Y1.\n" + b"G65 P9810 X5. Y1.\n"
    found = assumed(b"O1\nG21 G90 G94 G17 G40 G54\n" + calls + b"G90 G0 X1.\nM30\n", "fanuc")
    assert found.kept_calls == {"P9810": 2, "P9832": 1}
    assert "what programs do that are called and not at hand: P9810 (2), P9832 (1)" in (
        found.not_checked
    )


def test_m_codes_of_linuxcnc_act_in_a_known_order() -> None:
    found = assumed(b"G21 G90 G94 G17 G40 G54\nG0 X0 Y0\nG1 X1 F9 M8\nM2\n", "linuxcnc").assumed
    assert found == []


@pytest.mark.parametrize("chain", ["", "absolute"])
def test_check_lists_what_is_assumed(chain: str, tmp_path: Path) -> None:
    file = tmp_path / "part.nc"
    file.write_bytes(b"O1\nG21 G90\nG0 X0. Y0. Z5.\nM98 P20002\nM30\nO2\nG0 X1. M9\nM99\n")
    found = call("check", "-f", "fanuc", "-x", chain, str(file))
    assert found.exit_code == 0
    said = found.stdout
    assert "assumed   M98 P20002 calls O2, 2 times\n" in said
    assert said.count("assumed   M9 beside a move acts after it\n") == 1
    assert "assumed   feed-mode G94, which the program does not state\n" in said


def test_run_warns_of_a_way_down(tmp_path: Path) -> None:
    file = tmp_path / "part.nc"
    file.write_bytes(PLUNGE)
    found = call("run", "-f", "fanuc", "-x", "absolute", str(file), "-o", str(tmp_path / "o.nc"))
    assert found.exit_code == 0
    assert "3:1: warning[GX229]" in found.stderr


@pytest.mark.parametrize(
    ("body", "line"),
    [
        ("T0101\nG0 X30. Z2.\nG1 Z-20. F9.", 2),
        ("G0 X30. Z2. (Y)\nG99 G1 Z-20. F9.", 3),
        ("T0101 M6\nG0 X30. Z2.", 0),
        ("T0101\nG43 H1\nG0 X30. Z2.", 0),
        ("T0101\nG0 X30. Z2.\nG0 Y5.", 0),
        ("T0101\nG0 Z2.", 0),
        ("T101\nG0 X30. Z2.", 0),
        ("G0 X30. Z2.\nG99 G81 Z-9. R2. F9.", 0),
        ("(T0101 G99)\nG0 X30. Z2.", 0),
    ],
)
def test_what_looks_like_a_lathe_is_warned_of(body: str, line: int) -> None:
    found = assumed(f"G21 G90 G94\n{body}\nM30\n".encode(), "fanuc")
    where = [each.where for each in found.warnings if each.code == "GX236"]
    assert [each.line for each in where if each is not None] == ([line] if line else [])


def test_a_control_of_mills_alone_is_not_asked_about_lathes() -> None:
    found = assumed(b"G21 G90 G94\nT0101\nG0 X30. Z2.\nM30\n", "linuxcnc")
    assert not found.warnings

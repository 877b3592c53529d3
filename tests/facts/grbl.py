"""Facts about GRBL 1.1h, from what its own parser was seen to do; meanings worked out by hand.

A motion is its kind and the words of its end, then F: `feed X1 F10`. Axes not named are at 0. A
control that rejects some lines and runs the others gives no program that can be read: refused.
"""

from __future__ import annotations

from typing import Any

READ = {
    "slash_is_executed": ("/G0 X1", "rapid X1"),
    "both_comments_go": ("G0 X1 (abc) Y2 ; tail", "rapid X1 Y2"),
    "small_letters_and_blanks": ("g 0 x 1 . 5", "rapid X1.5"),
    "power_up_is_rapid": ("X5", "rapid X5"),
    "power_up_is_mm": ("G0 X1|G20 X1", "rapid X1|rapid X1"),
    "rapid_in_g93_needs_no_feed": ("G93 X5", "rapid X5"),
    "n_of_ten_million": ("N10000000 G0 X1", "rapid X1"),
    "line_of_79": ("G0 X1 Y2 Z" + "0" * 72, "rapid X1 Y2"),
    "blanks_do_not_count": ("G0 X1" + " " * 80 + "Y2", "rapid X1 Y2"),
    "after_m30": ("F10 G0 X1|M30|G0 X2", "rapid X1|M30|rapid X2"),
    "m5_first": ("M3 S10|G1 X5 F100 M5", "M3|M5|feed X5 F100"),
    "m9_first": ("M8|G1 X5 F100 M9", "M8|M9|feed X5 F100"),
    "m0_last": ("G1 X5 F100 M0|X6", "feed X5 F100|M0|feed X6 F100"),
    "dwell_seconds": ("G4 P1.5", "dwell 1.5"),
    "g61_is_known": ("G61|G0 X1", "rapid X1"),
    "g91_1_is_known": ("G91.1|G2 X10 I5 F10", "cw X10 I5 F10"),
    "half_circle": ("G2 X10 I5 F10", "cw X10 I5 F10"),
    "circle_with_its_end": ("G2 X0 Y0 I5 F10", "cw I5 F10"),
    "r_short": ("G2 X5 Y5 R5 F10", "cw X5 Y5 I5 F10"),
    "r_long": ("G2 X5 Y5 R-5 F10", "cw X5 Y5 J5 F10"),
    "g80_beside_g28": ("G0 X5|G80 G28|G0 X1 Y0 Z0", "rapid X5|rapid|rapid X1"),
    "third_centre": ("G2 X10 I5 K3 F10", "cw X10 I5 F10"),
    "percent": ("%|G0 X1", "rapid X1"),
    "zx": ("G18 G2 X10 Z0 I5 F10", "cw X10 I5 F10"),
    "off_by_4um": ("G2 X10.004 I5 F10", "cw X10.004 I5 F10"),
    "off_by_a_thousandth": ("G2 X200.09 I100 F10", "cw X200.09 I100 F10"),
    "feed_kept_over_units": ("F100 G1 X1|G20|G1 X2", "feed X1 F100|feed X2 F3.937008"),
    "feed_scaled_in_units": ("G20 G1 X1 F10", "feed X1 F10"),
    "g53_absolute_in_g91": ("G0 X5|G91 G53 G0 X1", "rapid X5|rapid X1"),
    "g28_through": ("G0 X9 Y9 Z9|G91 G28 Z0", "rapid X9 Y9 Z9|rapid X9 Y9"),
    "g10_l2": ("G10 L2 P1 X5|G0 X0|G53 G0 X0", "rapid|rapid X-5"),
    "g10_without_p": ("G10 L2 X5|G0 X1", "rapid X1"),
    "g92": ("G0 X5|G92 X1|G0 X1|G53 G0 X1", "rapid X5|rapid X-3"),
    "g43_1": ("G43.1 Z5|G0 Z0|G49|Z0", "rapid|rapid"),
}

REFUSED = {
    "percent_beside_a_word": "% G0 X1",
    "g80_beside_g92": "G80 G92 X1",
    "g80_beside_g28_x": "G80 G28 X1",
    "third_centre_alone": "G2 X10 K5 F10",
    "third_centre_beside_r": "G2 X10 R5 K0 F10",
    "program_number": "O1234|G0 X1",
    "n_beyond_ten_million": "N10000001 G0 X1",
    "line_of_80": "G0 X1 Y2 Z" + "0" * 73,
    "exponent": "G0 X1e3",
    "two_signs": "G0 X--5",
    "point_alone": "G0 X.",
    "code_with_fraction": "G1.1 X1 F1",
    "no_such_axis": "G0 A1",
    "word_twice": "G0 X1 X2",
    "two_of_a_group": "G0 G1 X1 F1",
    "unused_word": "G0 X1 P1",
    "no_feed": "G1 X1",
    "g93_no_feed": "G93 G1 X1 F1|X2",
    "circle_without_end": "G2 I5 F10",
    "turns": "G2 X10 I5 P2 F10",
    "r_closed": "G2 X0 Y0 R5 F10",
    "no_centre": "G2 X10 F10",
    "off_by_6um": "G2 X10.006 Y0 I5 F10",
    "off_by_half": "G2 X2001.1 I1000 F10",
    "absolute_centre": "G90.1",
    "feed_per_turn": "G95 F1",
    "ninth_offset": "G59.3",
    "blending": "G64",
    "retract": "G98",
    "cycle": "G81 X1 Z-1 R1 F10",
    "length_of_a_tool": "G43 H1",
    "suspended_shift": "G92.2",
    "cutter": "G41 D1",
    "tool_change": "T1 M6",
    "axis_after_g80": "G80|X1",
    "dwell_s": "G4 S1",
    "dwell_x": "G4 X1",
    "dwell_alone": "G4",
    "g53_after_g80": "G80|G53 X1",
    "g10_p7": "G10 L2 P7 X1",
    "g10_r": "G10 L2 P1 R30",
    "g43_1_x": "G43.1 X1",
    "after_m2": "G0 X1|M2|X2",
}


def facts() -> list[dict[str, Any]]:
    """Return the facts in the form of those of LinuxCNC."""
    read = [
        {"name": name, "program": _lines(text), "expect": "ok", "motions": _motions(meaning)}
        for name, (text, meaning) in READ.items()
    ]
    refused = [
        {"name": name, "program": _lines(text), "expect": "refuse"}
        for name, text in REFUSED.items()
    ]
    return [{"dialect": "grbl-1.1h", **f, "name": f"grbl_{f['name']}"} for f in read + refused]


def _lines(text: str) -> str:
    return text.replace("|", "\n") + "\n"


def _motions(meaning: str) -> list[dict[str, Any]]:
    at = dict.fromkeys("XYZ", 0.0)
    return [_motion(words.split(), at) for words in meaning.split("|")]


def _motion(words: list[str], at: dict[str, float]) -> dict[str, Any]:
    kind = words[0]
    if kind == "dwell":
        return {"type": "dwell", "seconds": float(words[1])}
    if kind[0] == "M":
        return {"type": "event", "what": kind}
    value = {word[0]: float(word[1:]) for word in words[1:]}
    end = at | {axis: value[axis] for axis in "XYZ" if axis in value}
    if kind != "cw":
        return {"type": kind, "end": end} | ({"F": value["F"]} if "F" in value else {})
    centre = {"X": value.get("I", 0.0), "Y": value.get("J", 0.0)}
    return {"type": "arc", "sense": "cw", "turns": 1, "end": end, "center": centre, "F": value["F"]}

"""The verification, fed with texts that somebody tampered with: each must be refused."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import gcxform as gx
from gcxform.emit.emitter import Emitted
from gcxform.emit.same_rows import SameRows
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.syntax.source import Source

MODEL = Path(__file__).parents[1] / "examples" / "lddm" / "model.toml"
CHAIN = "absolute"
COMPENSATED = f"absolute | volumetric model={MODEL} part-origin=100,100,100"
PROGRAM = b"""\
G21 G90 G17 G94
S1000 M3
G0 X0 Y0 Z5 A0
M8
G1 Z-1.5 F100
X40 Y-10 F300
G2 X60 Y10 I0 J20
G1 X60 Y40 A90
X80
X60
G4 P1.5
G93 G1 X0 Y40 F2
G94 G3 X0 Y40 I5 J0 F100
G18 G2 X10 Z-1.5 I5 K0
G0 Z5
G91 G1 X1.5 Y-2.5
X1.5 Y-2.5
M2
"""

Line = tuple[bytes, int]  # text with its end, and line of the input from 0
Change = Callable[[list[Line]], Iterable[Line]]


def run(
    change: Change = iter,
    chain: str | gx.Pipeline = CHAIN,
    program: bytes = PROGRAM,
    size: int = 1 << 19,
) -> bytes:
    """Run a chain whose emitter lies: the lines it writes are changed before they are verified."""
    source = Source.of_bytes(program)
    pipeline = gx.Pipeline.parse(chain, "linuxcnc") if isinstance(chain, str) else chain
    job = Run(pipeline, source, "full")
    assert job.stages is not None
    emitter = job.stages.emitter
    emit, texts = emitter.emit, list[bytes]()

    def lying(*task: object) -> Emitted:
        emitted = emit(*task)  # type: ignore[arg-type]
        lines = emitted.text.splitlines(keepends=True)
        changed = list(change(list(zip(lines, emitted.source.tolist(), strict=True))))
        several = [(part, n) for text, n in changed for part in text.splitlines(keepends=True)]
        text = b"".join(line for line, _ in several)
        source = np.array([number for _, number in several], np.int64)
        return Emitted(text, source, np.zeros(len(source), np.int64))

    emitter.emit = lying  # type: ignore[method-assign]
    job.over(Output(texts.append, None), lambda _: None, size)
    return b"".join(texts)


# --- ways to tamper with a text ---


def said(old: str, new: str) -> Change:
    """Say something else, once."""

    def change(lines: list[Line]) -> Iterable[Line]:
        assert sum(text.count(old.encode()) for text, _ in lines) == 1, old
        return [(text.replace(old.encode(), new.encode()), number) for text, number in lines]

    return change


def dropped(*wanted: int) -> Change:
    """Leave out what was written for lines of the input."""

    def change(lines: list[Line]) -> Iterable[Line]:
        assert set(wanted) <= {number for _, number in lines}
        return [line for line in lines if line[1] not in wanted]

    return change


def swapped(first: int) -> Change:
    """Let the texts of two lines change places."""

    def change(lines: list[Line]) -> Iterable[Line]:
        texts = [text for text, _ in lines]
        texts[first : first + 2] = reversed(texts[first : first + 2])
        return zip(texts, (number for _, number in lines), strict=True)

    return change


def moved_on(word: str) -> Change:
    """Say a word one line later, behind the words there."""

    def change(lines: list[Line]) -> Iterable[Line]:
        texts = [text for text, _ in lines]
        at = texts.index(word.encode() + b"\n")
        texts[at : at + 2] = b"\n", texts[at + 1].rstrip() + b" " + texts[at]
        return zip(texts, (number for _, number in lines), strict=True)

    return change


def inserted(text: str, number: int) -> Change:
    """Write one line more behind what was written for a line of the input."""

    def change(lines: list[Line]) -> Iterable[Line]:
        place = max(k for k, line in enumerate(lines) if line[1] == number) + 1
        return [*lines[:place], (text.encode() + b"\n", number), *lines[place:]]

    return change


def led_by(text: str, number: int) -> Change:
    """Write one line more before what was written for a line of the input."""

    def change(lines: list[Line]) -> Iterable[Line]:
        place = next(k for k, line in enumerate(lines) if line[1] == number)
        return [*lines[:place], (text.encode() + b"\n", number), *lines[place:]]

    return change


TAMPERED = {
    "the sign of a position": (said("Y-10", "Y10"), "off"),
    "another depth": (said("Z-1.5 F100", "Z-1.6 F100"), "off"),
    "another unit": (said("G21", "G20"), "off"),
    "the end of a rapid": (said("G0 X0", "G0 X1"), "off"),
    "a rotary axis": (said("A90", "A91"), "degrees off"),
    "a move is dropped": (dropped(5), "."),
    "there and back are dropped": (dropped(8, 9), "missing"),
    "the last move is dropped": (dropped(16), "off"),
    "two lines change places": (swapped(7), "."),
    "an extra move for a line that has none": (inserted("X60 Y40", 10), "does not have"),
    "an extra move beyond the end": (inserted("X90", 8), "off"),
    "an extra move back and forth": (inserted("X70\nX80", 8), "."),
    "another feed": (said("F300", "F301"), "feed"),
    "a feed is dropped": (said(" F300", ""), "feed"),
    "another time in G93": (said("F2\n", "F2.01\n"), "time"),
    "another feed mode": (said("G93 G1", "G1"), "feed mode"),
    "a rapid goes astray on its way": (led_by("G0 Z-9", 14), "off"),
    "the first rapid goes astray": (led_by("G0 Z-9", 2), "off"),
    "a rapid cuts": (said("G0 Z5", "G1 Z5"), "rapid"),
    "a cut becomes a rapid": (said("G1 X60", "G0 X60"), "rapid"),
    "the sense of an arc": (said("G2 X60", "G3 X60"), "."),
    "the sense of a full circle": (said("G94 G3", "G94 G2"), "off"),
    "a circle becomes a line": (said("G94 G3 X0 Y40 I5 J0", "G94 G1 X0 Y40"), "off"),
    "the centre of a circle": (said("I5 J0", "I5.1 J0"), "off"),
    "the plane of an arc": (said("G18 ", "G17 "), "."),
    "an arc becomes its chord": (said("G2 X60 Y10 I0 J20", "G1 X60 Y10"), "off"),
    "two turns": (said("I5 J0 F100", "I5 J0 P2 F100"), "off"),
    "M8 is missing": (said("M8\n", "\n"), "M8"),
    "M8 comes twice": (inserted("M8", 3), "M8"),
    "M8 becomes M9": (said("M8", "M9"), "M8"),
    "M8 after the cut has begun": (moved_on("M8"), "M8"),
    "another speed": (said("S1000", "S1001"), "S"),
    "another dwell": (said("P1.5", "P1.6"), "G4|dwell|DWELL"),
    "the end is missing": (said("M2\n", "\n"), "M2"),
}


@pytest.mark.parametrize("name", TAMPERED)
def test_a_text_tampered_with_is_refused(name: str) -> None:
    change, message = TAMPERED[name]
    with pytest.raises(gx.VerificationError, match=message):
        run(change)


@pytest.mark.parametrize("name", ["the sign of a position", "M8 is missing", "another feed"])
def test_it_is_refused_in_small_windows(name: str) -> None:
    old, new = {"t": ("Y-10", "Y10"), "M": ("M8\n", "\n"), "a": ("F300", "F301")}[name[0]]

    def change(lines: list[Line]) -> Iterable[Line]:
        return [(text.replace(old.encode(), new.encode()), number) for text, number in lines]

    with pytest.raises(gx.VerificationError):
        run(change, size=20)


@pytest.mark.parametrize("chain", [CHAIN, COMPENSATED])
@pytest.mark.parametrize("axis", "XYZ")
@pytest.mark.parametrize("sign", [1, -1])
def test_an_axis_may_not_be_off_by_twice_the_budget(chain: str, axis: str, sign: int) -> None:
    program = b"G21 G90 G94\nG0 X0 Y0 Z0\nG1 X31.5 Y32.5 Z33.5 F100\nX0 Y0 Z0\nM2\n"
    budget = gx.Pipeline.parse(chain, "linuxcnc").limit()

    def change(lines: list[Line]) -> Iterable[Line]:
        last = max(k for k, line in enumerate(lines) if line[1] == 2)
        words = lines[last][0].split()
        moved = [w if w[:1] != axis.encode() else by(w, sign * 2 * budget) for w in words]
        assert moved != words
        lines[last] = (b" ".join(moved) + b"\n", 2)
        return lines

    run(chain=chain, program=program)
    with pytest.raises(gx.VerificationError, match="off"):
        run(change, chain, program)


def by(word: bytes, distance: float) -> bytes:
    """Return an axis word farther on."""
    return word[:1] + f"{float(word[1:]) + distance:.6f}".encode()


def test_nodes_that_are_not_stopped_at_are_seen() -> None:
    program = b"G21 G90 G94\nG0 X-100 Y0 Z0\nG1 X300 F100\nM2\n"

    def change(lines: list[Line]) -> Iterable[Line]:
        pieces = [k for k, line in enumerate(lines) if line[1] == 2]
        assert len(pieces) > 5
        return [line for k, line in enumerate(lines) if k not in pieces[1:-1]]

    with pytest.raises(gx.VerificationError, match="off"):
        run(change, COMPENSATED, program)


@pytest.mark.parametrize(
    "change",
    [
        said("(LOG,X)\n", "\n"),
        said("(LOG,X)", "(LOG,Y)"),
        said("(plain)", "(MSG,plain)"),
        moved_on("(LOG,X)"),
    ],
)
def test_comments_that_act_are_events(change: Change) -> None:
    program = b"G21 G90 G94 G17\nG0 X0 Y0 Z0\n(LOG,X)\nX5\nG1 X10 F100 (plain)\nM2\n"
    run(program=program)
    with pytest.raises(gx.VerificationError, match=r"became|moved|missing"):
        run(change, program=program)


def test_a_word_of_the_machine_counts_from_where_it_did(monkeypatch: pytest.MonkeyPatch) -> None:
    program = b"G21 G90 G94\nG0 X0 Y0 Z5\nG92 X1\nG0 X#5063\nG0 X5\nM2\n"
    with pytest.raises(gx.InputError, match="would be written anew"):
        run(chain="offsets", program=program)
    everywhere = np.ones((1, 9), np.bool_)
    monkeypatch.setattr(SameRows, "_unshifted", lambda *_: everywhere)
    with pytest.raises(gx.VerificationError, match="counts from elsewhere"):
        run(chain="offsets", program=program)


@pytest.mark.parametrize("other", ["G38.3", "G38.4", "G38.5"])
def test_a_probing_move_stays_what_it_is(other: str) -> None:
    program = b"G21 G90 G94\nG0 X0 Y0 Z5\nG38.2 Z-5 F50\nM2\n"
    run(program=program)
    with pytest.raises(gx.VerificationError, match="tied to the spindle or to a probe"):
        run(said("G38.2", other), program=program)


@pytest.mark.parametrize("code", ["G0", "G1"])
def test_short_moves_left_out_may_not_lead_far_away(code: str) -> None:
    """A thousand steps of 0.2 um are a tenth of a millimetre there and as much back."""
    there = [f"X{1 + 0.0002 * k:.4f} F{100 + k}" for k in range(1, 500)]
    back = [f"X{1 + 0.0002 * k:.4f} F{100 - k / 10:g}" for k in range(498, -1, -1)]
    moves = "\n".join([f"{code} {there[0]}", *there[1:], *back])
    program = f"G21 G90 G94\nG0 X0 Y0 Z0\nG1 X1 F100\n{moves}\nG1 X5 F100\nM2\n".encode()
    with pytest.raises(gx.VerificationError, match="missing"):
        run(dropped(*range(3, 3 + 998)), program=program)


def test_an_event_stays_before_the_first_piece_of_its_move() -> None:
    program = b"G21 G90 G94\nG0 X0 Y0 Z0\nG1 X9 F100 M8\nM2\n"

    def change(lines: list[Line]) -> Iterable[Line]:
        first = next(k for k, line in enumerate(lines) if b"M8" in line[0])
        lines[first] = (lines[first][0].replace(b" M8", b""), 2)
        lines[first + 1] = (lines[first + 1][0].replace(b"\n", b" M8\n"), 2)
        return lines

    chain = "segment arcs=split max-length=3mm"
    assert run(chain=chain, program=program).count(b"M8") == 1
    with pytest.raises(gx.VerificationError, match="M8"):
        run(change, chain, program)


# --- the reader, on which the proof stands ---


def test_the_proof_reads_as_the_control_does() -> None:
    program = b"""\
G20 G90 G17
G0 X1 Y0 Z0
G21 G2 X45.4 Y0 I10 J0 F100
G3 X45.4 Y0 I-5 J0
G3 X55.4 Y10 R-10
G91 G1 X1.5 Y-1
X1.5
G90 X3
G91 X1
M2
"""
    path = gx.read(program, "linuxcnc").path
    ends = [25.4, 45.4, 45.4, 55.4, 56.9, 58.4, 3.0, 4.0]
    assert path.end[:, 0].tolist() == pytest.approx(ends)
    assert path.sense.tolist()[1:4] == [-1, 1, 1]
    assert path.sweep[1:4].tolist() == pytest.approx([np.pi, 2 * np.pi, 1.5 * np.pi])
    assert path.centre[1:4, :2].tolist() == [
        pytest.approx(centre, abs=1e-9) for centre in ([35.4, 0.0], [40.4, 0.0], [55.4, 0.0])
    ]


# --- what is right passes ---


@pytest.mark.parametrize("size", [1, 20, 1 << 19])
@pytest.mark.parametrize(
    "chain",
    [
        CHAIN,
        COMPENSATED,
        COMPENSATED + " tolerance=1um",
        "segment chord-error=2um max-length=3mm",
        f"metric | segment arcs=split arc-step=10deg | {COMPENSATED}",
    ],
)
def test_what_was_written_passes_in_windows_of_any_size(chain: str, size: int) -> None:
    assert run(chain=chain, size=size) == run(chain=chain)


# --- feeds that are converted ---

CONVERTED = b"""\
G21 G90 G94 G17 S500
G0 X0 Y0 Z5 A0
G1 X10 F100
G2 X30 Y0 I10 F200
G3 X10 Y0 Z10 I-10
G1 A90 F45
X60 F300
M2
"""
WRONG_FEEDS = {
    "another time": (said("F10\n", "F10.02\n"), "time"),
    "an arc as long as its chord": (said("F6.366", "F10"), "time"),
    "a helix that does not rise": (said("F6.287", "F6.366"), "time"),
    "a rotary move in mm": (said("F0.5", "F0.02"), "time"),
    "a feed per minute": (said("F6\n", "F300\n"), "time"),
    "the mode is not stated": (said("G93", "G94"), "time"),
    "per turn": (said("G93", "G95"), "feed mode"),
    "the mode is not restored": (said("G94 M2", "M2"), "left"),
}


@pytest.mark.parametrize("name", WRONG_FEEDS)
def test_a_feed_converted_wrong_is_refused(name: str) -> None:
    change, message = WRONG_FEEDS[name]
    chain = "feed mode=inverse-time"
    assert run(chain=chain, program=CONVERTED).count(b"F") == 5
    with pytest.raises(gx.VerificationError, match=message):
        run(change, chain, CONVERTED)


@pytest.mark.parametrize("chain", ["segment chord-error=1um", "segment | feed mode=inverse-time"])
def test_one_piece_of_many_may_not_be_faster(chain: str) -> None:
    """A piece takes less of the time of its move than the rounding of feeds may change."""
    mode = "G94 F3" if "feed" in chain else "G93 F3"
    program = f"G21 G90 {mode}\nG0 X0 Y0\nG2 X0 Y0 I500 {mode[4:]}\nG94 M2\n".encode()
    chain = chain.replace("segment |", "segment chord-error=1um |")

    def change(lines: list[Line]) -> Iterable[Line]:
        text, number = lines[700]
        word = next(word for word in text.split() if word[:1] == b"F")
        lines[700] = text.replace(word, b"F%.3f" % (3 * float(word[1:]))), number
        return lines

    assert run(chain=chain, program=program).count(b"F") > 1000
    with pytest.raises(gx.VerificationError, match="faster or slower"):
        run(change, chain, program)


def test_a_feed_per_minute_converted_wrong_is_refused() -> None:
    program = b"G21 G90 G93\nG0 X0 Y0\nG1 X10 F20\nG3 X20 Y10 J10 F6\nG94 G1 X30 F70\nM2\n"
    chain = "feed mode=per-minute"
    run(chain=chain, program=program)
    for old, new in ((b"F200", b"F201"), (b"F94.248", b"F90"), (b"F70", b"F70.1")):
        with pytest.raises(gx.VerificationError, match=r"time|feed"):
            run(
                lambda lines, o=old, n=new: [(t.replace(o, n), k) for t, k in lines], chain, program
            )  # type: ignore[misc]


@pytest.mark.parametrize("fine", "AC")
def test_an_axis_with_more_decimals_has_a_budget_of_its_own(tmp_path: Path, fine: str) -> None:
    coarse = "CA"["AC".index(fine)]
    start = "{ X = 0.0, Y = 0.0, Z = 0.0, A = 0.0, C = 0.0 }"
    (tmp_path / "p.toml").write_text(
        f'format = 1\n[input]\ndialect = "linuxcnc"\nstart = {start}\n'
        '[[pass]]\nuse = "segment"\narcs = "split"\nmax-length = "5 mm"\n'
        f"[output]\ndecimals = {{ {coarse} = 2, {fine} = 4 }}\n"
    )
    pipeline = gx.Pipeline.load(tmp_path / "p.toml")
    program = f"G21 G90 G94\nG1 X10 {fine}10 {coarse}7 F100\nM2\n".encode()
    assert f"{fine}5. {coarse}3.5".encode() in run(chain=pipeline, program=program)
    off_by = said(f"{coarse}3.5", f"{coarse}3.505")
    assert b".505" in run(off_by, pipeline, program)
    with pytest.raises(gx.VerificationError, match=r"a rotary axis is 0\.00"):
        run(said(f"{fine}5.", f"{fine}5.005"), pipeline, program)


@pytest.mark.parametrize(
    ("old", "new"),
    [("G53 G0 X-5. Y-6.", "G53 G0 X-5."), ("G53 G0 X-5. Y-6.", "G53 G0 Y-6.")],
)
def test_an_axis_that_goes_to_a_place_of_the_machine_does_not_rest(old: str, new: str) -> None:
    """Where that place is the source does not know, and yet the axis has to move."""
    program = b"G21 G90 G94 G17 G54\nG0 X0. Y0. Z9.\nG53 G0 X-5. Y-6.\nG0 X1. Y2.\nM2\n"
    assert b"X-5. Y-6." in run(program=program)
    with pytest.raises(gx.VerificationError, match="GX601"):
        run(said(old, new), program=program)


def test_a_last_move_from_nowhere_known_is_not_left_out() -> None:
    """No move behind it would show that Z has stayed where it was."""
    program = b"G21 G90 G94 G17 G54\nG0 X1. Y2.\nG0 Z3.\nM2\n"
    assert b"Z3." in run(program=program)
    with pytest.raises(gx.VerificationError, match="a move of the source is missing"):
        run(dropped(2), program=program)


def test_what_turns_alone_goes_on_turning_alone() -> None:
    """With a linear axis that moves by a rounding the feed is that axis's, and the turn a rapid."""
    program = b"G21 G90 G94 G17 G54\nG0 X1. Y2. A0.\nG1 A90. F100\nX2.\nM2\n"
    roomy = replace(gx.Pipeline.parse(CHAIN, "linuxcnc"), budget=0.01)
    assert b"A90. F100" in run(chain=roomy, program=program)
    with pytest.raises(gx.InputError, match="rotary ones turned alone"):
        run(said("G1 A90.", "G1 X1.0005 A90."), roomy, program)
    timed = program.replace(b"G94 ", b"G93 ").replace(b"F100\nX2.", b"F2\nX2. F2")
    assert b"X1.0005" in run(said("G1 A90.", "G1 X1.0005 A90."), roomy, timed)

"""The user's own lines where the tool is drawn back: `retract-lines`, `return-lines` of `rtcp`.

The oracle reads the text by itself, with G53 as what it is, and follows the tool by matrices of
scipy; LinuxCNC's interpreter is asked where it stands. What is outside of these moves has to be, to
the byte, what is written without such lines.
"""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from kinematics_kit import tool
from oracles import rs274
from rtcp_kit import LENGTH, ROUNDED, ZERO
from seeds_kit import some
from test_rtcp_choice import with_axis
from test_rtcp_repost import ROOM, step_of
from test_rtcp_retract import BACK, FEED, LIMITS, OPTIONS, TOLERANCE, round_about, steps_of

import gcxform as gx
from gcxform.emit.emitter import Emitted, Emitter
from gcxform.pipeline.chain_text import parse_chain
from gcxform.plugin.registry import default_registry

TOP = 700.0
UP = {"retract_lines": ["M9", "(up)", f"G53 G0 Z{TOP}"], "return_lines": ["G4 X1.5", "M8"]}
LINES = {
    "dry": {"retract_lines": ["M9"], "return_lines": ["M8"]},
    "up": UP,
    "aside": {
        "retract_lines": [f"G53 G0 Z{TOP}", "G53 G0 X-40."],
        "return_lines": ["G53 G0 Y25. (over the part)", "M8"],
    },
    "late": {"return_lines": [f"G0 G53 Z{TOP}"]},
    "whole": {"retract_lines": [f"G53 G90 G0 X1. Y2. Z{TOP}"]},
}
ROOMY = 3 * (ROUNDED + ROOM)


def stops(text, letters, zero=ZERO):
    """Return where axes stand after every line (n, 5), as words; G53 counts from the machine."""
    here, found = dict.fromkeys(letters, 0.0), []
    at, length = dict(zip("XYZ", zero, strict=True)), 0.0
    for line in text.decode().splitlines():
        line = re.sub(r"\([^)]*\)", "", line)
        words = dict(re.findall(r"([A-Z])(-?[\d.]+)", line))
        length = LENGTH if "G43" in line else length
        for letter in letters if "G4 " not in line else "":
            if letter in words:
                shift = at.get(letter, 0.0) + length * (letter == "Z") if "G53" in line else 0.0
                here[letter] = float(words[letter]) - shift
        found.append([here[letter] for letter in letters])
    return np.array(found)


def tips_at(chain, poses, zero):
    """Return tips (n, 3) on the workpiece and tool axes for words of axes (n, 5)."""
    return tool(chain, poses[:, :3] + zero + [0.0, 0.0, LENGTH], poses[:, 3:])


def once(kind):
    """Return a program in which the tool is drawn back once on this kind of machines.

    It says G1 once, so that behind G53 G0 this has to be said again.
    """
    text = round_about(0.8 if kind == "bc-trunnion" else 1.6, 25.0)
    head, _, rest = text.partition(b"G1 ")
    return head + b"G1 " + rest.replace(b"G1 ", b"")


def converted(folder, kind, **options):
    """Return the result for a kind of machines, its chain, and that without user's lines."""
    text = once(kind)
    plain, _, _ = steps_of(folder, kind, LIMITS[kind], **OPTIONS)
    steps, _, target = steps_of(folder, kind, LIMITS[kind], **OPTIONS, **options)
    return steps.run(text, "full"), target, plain.run(text)


def turning_at(at, lines, options):
    """Return the rows that turn axes, by the user's lines, which stand once and in order."""
    before, behind = options.get("retract_lines", []), options.get("return_lines", [])
    for said in (before, behind):
        if said:
            start = lines.index(said[0])
            assert lines[start : start + len(said)] == said
            assert all(lines.count(line) == 1 for line in said)
    first = lines.index(before[0]) + len(before) if before else lines.index(behind[0]) - 1
    last = lines.index(behind[0]) if behind else first + 1
    while not before and (at[first, 3:] != at[first - 1, 3:]).any():
        first -= 1
    return range(first if before else first + 1, last)


def check_drawn(text, chain, options, zero=ZERO):
    """Check where the tool is drawn back, by what the text says.

    Return which axes each block moves behind the lines, and the lines of the text from the block
    that draws the tool back to that in which it goes in.
    """
    at = stops(text, ("X", "Y", "Z", *chain.letters), zero)
    turning = turning_at(at, text.decode().splitlines(), options)
    turned = at[turning.start - 1 : turning.stop, 3:]
    assert (np.diff(turned, axis=0) != 0.0).any(axis=1).all()
    first = turning.start - 1 - len(options.get("retract_lines", ()))
    behind = turning.stop + len(options.get("return_lines", ()))
    begin, over = tips_at(chain, at[[first - 1, first]], zero)[0]
    axis = tips_at(chain, at[[first]], zero)[1][0]
    assert np.linalg.norm(over - begin - BACK * axis) <= ROOMY
    assert (at[first, 3:] == at[first - 1, 3:]).all()
    if any("G53" in line for line in options.get("retract_lines", ())):
        assert len(turning) == 1
        assert (at[turning.start, :3] == at[turning.start - 1, :3]).all()
    else:
        away = tips_at(chain, at[[*turning]], zero)[0] - over
        assert np.linalg.norm(away, axis=1).max() <= 0.1 * BACK + ROOMY
    last = behind
    while np.linalg.norm(tips_at(chain, at[[last - 1]], zero)[0][0] - over) > ROOMY:
        last += 1
    assert (at[turning.stop : last + 1, 3:] == at[turning.stop - 1, 3:]).all()
    (tip,), (other,) = tips_at(chain, at[[last]], zero)
    assert np.linalg.norm(tip - begin) <= ROOMY
    assert np.linalg.norm(other - axis) <= np.radians(0.01)
    order = [[k for k in range(3) if at[r, k] != at[r - 1, k]] for r in range(behind, last)]
    return order, range(first, last + 1)


ORDER = {"up": [[0, 1], [2]], "aside": [[1], [0], [2]], "late": [[0, 1], [2]], "dry": []}
ORDER["whole"] = [[0, 1, 2]]


@pytest.mark.parametrize("name", LINES)
@pytest.mark.parametrize("kind", sorted(LIMITS))
def test_lines_stand_where_they_should_and_the_tool_comes_back(tmp_path, kind, name):
    result, chain, plain = converted(tmp_path, kind, **LINES[name])
    order, drawn = check_drawn(result.text, chain, LINES[name])
    assert [axes for axes in ORDER[name] if axes in order] == order
    new, old = result.text.splitlines(), plain.text.splitlines()
    rest = len(new) - drawn.stop
    assert new[: drawn.start + 1] == old[: drawn.start + 1]
    assert new[-rest:] == old[-rest:]
    assert drawn.start + rest < len(old)
    count = len(LINES[name].get("retract_lines", ())) + len(LINES[name].get("return_lines", ()))
    told = result.certificate.added
    assert (told["retracts"], told["lines of retracts"]) == (1, count)
    assert any(f"{count} lines of retracts" in said for said in result.certificate.not_checked)


def some_lines(rng, taken):
    """Return up to four lines, none twice: places of the machine, and what else there is."""
    found = []
    for _ in range(int(rng.integers(0, 5))):
        axes = rng.permutation([*"XYZ"])[: rng.integers(1, 4)]
        place = "".join(f" {axis}{rng.uniform(-300.0, 300.0):.3f}" for axis in axes)
        words = rng.permutation(["G53", "G0", "G90"][: rng.integers(2, 4)])
        others = ["M7", "M8", "M9", f"G4 P{rng.integers(1, 900)}", f"(say {rng.integers(9)})"]
        move = " ".join(words) + place
        line = move if rng.random() < 0.5 else str(rng.choice(others))
        found += [line] if line not in [*taken, *found] else []
    return found


@pytest.mark.parametrize("seed", some(16))
def test_any_lines_that_are_taken_are_followed(tmp_path, seed):
    """In which order axes come back is asked of the lines from the last to the first."""
    rng = np.random.default_rng(seed)
    before = some_lines(rng, [])
    lines = {"retract_lines": before, "return_lines": some_lines(rng, before)}
    kind = sorted(LIMITS)[seed % len(LIMITS)]
    if not lines["return_lines"]:
        lines["return_lines"] = ["(it has turned)"]
    result, chain, _ = converted(tmp_path, kind, **lines)
    order, _ = check_drawn(result.text, chain, lines)
    moves = [line for said in lines.values() for line in said if "G53" in line]
    named = [{k for k, axis in enumerate("XYZ") if axis in line} for line in moves]
    wanted = [{0, 1, 2}.difference(*named)] if named else []
    for axes in reversed(named):
        wanted.append(axes.difference(*wanted))
    assert [set(axes) for axes in order] == [axes for axes in wanted if [*sorted(axes)] in order]
    assert len(order) <= len(moves) + 1


@pytest.mark.parametrize("kind", ["bc-trunnion", "nutating-head"])
def test_the_work_offset_is_that_of_the_target(tmp_path, kind):
    """G53 counts from the machine that is written for, whatever the other has."""
    zero = np.array([-12.5, 31.0, 44.0])
    steps, _, chain = steps_of(tmp_path, kind, LIMITS[kind], **OPTIONS, **UP)
    text = (tmp_path / "target.toml").read_text()
    for axis, one, other in zip("XYZ", ZERO, zero, strict=True):
        text = text.replace(f"{axis} = {one}\n", f"{axis} = {other}\n")
    (tmp_path / "target.toml").write_text(text)
    steps = gx.Pipeline.load(tmp_path / "p.toml")
    result = steps.run(once(kind), "full")
    check_drawn(result.text, chain, UP, zero)
    moved = once(kind).replace(b"G0 Z50.", b"G0 Z50. A0. C0.\nG53 G0 Z0.")
    with pytest.raises(gx.InputError, match="elsewhere on the target"):
        steps.run(moved)


@pytest.mark.parametrize("processes", [False, True])
def test_each_time_the_tool_is_drawn_back_has_its_lines(tmp_path, monkeypatch, processes):
    monkeypatch.setattr("gcxform.syntax.source.WINDOW", 1)
    if not processes:
        monkeypatch.setattr("gcxform.system.worker.LINUX", False)
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", LIMITS["ac-trunnion"], **OPTIONS, **UP)
    head, _, rest = round_about(tilt=25.0).partition(b"G0 X20.")
    cut = b"G0 X20." + rest.removesuffix(b"M30\n")
    one = steps.run(head + cut + b"M30\n", "full")
    result = steps.run(head + 3 * cut + b"M30\n", "full")
    assert result.certificate.added == {n: 3 * k for n, k in one.certificate.added.items()}
    for line in UP["retract_lines"] + UP["return_lines"]:
        assert result.text.splitlines().count(line.encode()) == 3


@pytest.mark.skipif(not rs274.available(), reason="rs274 is not installed")
@pytest.mark.parametrize("name", ["dry", "up", "aside"])
def test_linuxcnc_does_what_is_planned(tmp_path, name):
    """Its interpreter reads the text: G53 ends there, and behind it all is as without the lines."""
    lines = {k: [t.replace("G4 X", "G4 P") for t in v] for k, v in LINES[name].items()}
    runs = []
    for options in ({}, lines):
        steps_of(tmp_path, "bc-trunnion", LIMITS["bc-trunnion"], **OPTIONS, **options)
        text = (tmp_path / "p.toml").read_text().replace('"fanuc"', '"linuxcnc"')
        (tmp_path / "p.toml").write_text(text)
        result = gx.Pipeline.load(tmp_path / "p.toml").run(once("bc-trunnion"), "full")
        setting = "G10 L2 P1 " + " ".join(f"{a}{v}" for a, v in zip("XYZ", ZERO, strict=True))
        setting += f"\nG43.1 Z{LENGTH}\n"
        program = result.text.replace(b"G43 H1 ", b"")
        runs.append((rs274.run(setting.encode() + program), program.splitlines()))
    (plain, _), (found, text) = runs
    moves = {move.line - 3: move for move in found.moves}
    for number, line in enumerate(text):
        if b"G53" in line:
            for axis, value in re.findall(r"([XYZ])(-?[\d.]+)", line.decode()):
                assert moves[number].machine[1][axis] == pytest.approx(float(value), abs=2e-4)
            assert moves[number].kind == "RAPID"
    last = [m.machine[1] for m in plain.moves][-3:]
    assert [m.machine[1] for m in found.moves][-3:] == [pytest.approx(m, abs=2e-4) for m in last]
    happens = [what for _, what in found.events if what in ("M8", "M9")]
    assert happens == [line for k in lines.values() for line in k if line in ("M8", "M9")]


# --- what is refused ---


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("M3", "M3: the spindle has to turn as before"),
        ("M0", "M0: what an operator does"),
        ("M30", "M30: what an operator does"),
        ("M6", "what M6 does"),
        ("M123", "what M123 does"),
        ("M8.5", "what M8.5 does"),
        ("M8 M9", "several codes"),
        ("m8", "m8 may not stand here"),
        ("G0 Z5.", "a place of the machine"),
        ("G53 Z5.", "G53 without G0"),
        ("G53 G1 Z5. F100.", "G1 may not"),
        ("G53 G0 Z5", "no decimal point"),
        ("G53 G0 C0.", "C may not stand beside"),
        ("G53 G0 Z5. M9", "M may not stand beside"),
        ("G53 G0", "names no axis"),
        ("G91 G53 G0 Z0.", "G91 may not"),
        ("G28 Z0.", "G28 may not"),
        ("G53 G0 Z1. Z2.", "twice"),
        ("G4", "not one word for its time"),
        ("G4 X1. P1", "not one word for its time"),
        ("T2", "T2 may not"),
        ("N10 M9", "several codes"),
        ("#1=2", "no plain word"),
        ("/M9", "no plain word"),
        ("M9 (up", "no plain word"),
        ("%", "no plain word"),
        ("; dry", "has no such comments"),
        ("O100", "O100 may not"),
    ],
)
def test_a_line_is_refused_by_name(tmp_path, line, message):
    """With the place of the option in the pipeline file."""
    with pytest.raises(gx.UsageError, match=f"GX745.*{re.escape(line)}.*{message}") as error:
        steps_of(tmp_path, "ac-trunnion", {}, **OPTIONS, return_lines=["M8", line])
    where = error.value.diagnostics[0].where
    text = (tmp_path / "p.toml").read_text().splitlines()
    assert where.file.endswith("p.toml")
    assert text[where.line - 1].startswith("return-lines")


def test_inert_codes_are_those_of_both_machines(tmp_path):
    steps_of(tmp_path, "ac-trunnion", {}, **OPTIONS)
    for name in ("machine.toml", "target.toml"):
        text = (tmp_path / name).read_text()
        (tmp_path / name).write_text(text + "[control]\ninert-m = [77]\n")
        said = (tmp_path / "p.toml").read_text()
        if "M77" not in said:
            said = said.replace("retract = ", "retract-lines = ['M77']\nretract = ")
            (tmp_path / "p.toml").write_text(said)
            with pytest.raises(gx.UsageError, match="M77"):
                gx.Pipeline.load(tmp_path / "p.toml")
    limits = LIMITS["ac-trunnion"]
    for letter, ends in limits.items():
        text = (tmp_path / "target.toml").read_text()
        text = text.replace(f"[axis.{letter}]\n", f"[axis.{letter}]\nlimits = {[*ends]}\n")
        (tmp_path / "target.toml").write_text(text)
    result = gx.Pipeline.load(tmp_path / "p.toml").run(round_about(tilt=25.0), "full")
    assert result.text.splitlines().count(b"M77") == 1


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"retract_lines": ["M9"]}, "go with retract"),
        ({**OPTIONS, "retract_lines": "M9"}, "expected a list of lines"),
        ({**OPTIONS, "retract_lines": [9]}, "expected a list of lines"),
        ({**OPTIONS, "retract_lines": [""]}, "none of them empty"),
        ({**OPTIONS, "retract_lines": ["(\u00fcber)"]}, "plain characters"),
    ],
)
def test_options_that_do_not_fit(tmp_path, options, message):
    with pytest.raises(gx.UsageError, match=message):
        steps_of(tmp_path, "ac-trunnion", {}, **options)


# --- the proof ---


@pytest.fixture
def drawn(tmp_path):
    """Return the pass, its context, the path of a program, and that with the lines."""
    kind, lines = "bc-trunnion", LINES["aside"] | {"return_lines": ["M8", "G53 G0 Y25."]}
    lines = lines | {"retract_lines": ["M9", *lines["retract_lines"]]}
    steps, _, _ = steps_of(tmp_path, kind, LIMITS[kind], **OPTIONS, **lines)
    read = gx.Program(round_about(0.8, 25.0), steps.source, steps.machine_reading)
    path = with_axis(read.path, "B")
    step = step_of(steps)
    after = step.apply(path, steps.context)
    step.prove(path, after, steps.context)
    assert step.added(path, after, steps.context)["lines of retracts"] == 5
    return step, steps.context, path, after


def refused(drawn, after, what=None):
    """Check that the proof refuses a path: GX606."""
    step, context, path, _ = drawn
    with pytest.raises(gx.VerificationError, match="GX606"):
        (what or step).prove(path, after, context)


def test_the_proof_wants_each_block_once_and_in_its_place(drawn):
    step, _, _, after = drawn
    given = after.given
    for k, one in enumerate(given):
        refused(drawn, after.replace(given=given[:k] + given[k + 1 :]))
        refused(drawn, after.replace(given=(*given[: k + 1], *given[k:])))
        refused(drawn, after.replace(given=(*given[:k], replace(one, text="M7"), *given[k + 1 :])))
        late = replace(one, row=one.row + 1)
        refused(drawn, after.replace(given=(*given[:k], late, *given[k + 1 :])))
    refused(drawn, after.replace(given=(*given, replace(given[0], row=1))))
    refused(drawn, after.replace(given=()))
    refused(drawn, after, replace(step, retract_lines=None))
    refused(drawn, after, replace(step, return_lines=None))
    other = gx.Lines(tuple(reversed(step.retract_lines.texts)))
    refused(drawn, after, replace(step, retract_lines=other))


def test_the_proof_wants_what_happens_in_them_and_nothing_else(drawn):
    _, _, _, after = drawn
    events = after.events
    inner = [k for k, event in enumerate(events) if event.within]
    assert [events[k].what for k in inner] == ["M9", "G53", "G53", "M8", "G53"]
    for k in inner:
        refused(drawn, after.replace(events=events[:k] + events[k + 1 :]))
        refused(drawn, after.replace(events=(*events[: k + 1], *events[k:])))
        other = replace(events[k], what="M7")
        refused(drawn, after.replace(events=(*events[:k], other, *events[k + 1 :])))
        refused(drawn, after.replace(events=(*events[:k], events[k].at(3), *events[k + 1 :])))
    refused(drawn, after.replace(events=(gx.Event(0, "M8"), *events)))
    refused(drawn, after.replace(events=events[1:]))


def test_the_proof_follows_every_move(drawn):
    """Each end by a hundredth, each feed by a thousandth, each kind: it is another path."""
    _, _, _, after = drawn
    first = after.given[0].row - 1
    rows = [*range(first, after.given[-1].row + 5)]
    columns = [0, 1, 2, *(after.axes.index(letter) for letter in "BC")]
    for row in rows:
        for column in columns:
            end = after.end.copy()
            end[row, column] += 0.01
            refused(drawn, after.replace(end=end))
        for size in (0.999, 1.001):
            feed = after.feed.copy()
            feed[row] *= size
            if np.isfinite(feed[row]):
                refused(drawn, after.replace(feed=feed))
        kind = after.kind.copy()
        kind[row] = gx.Kind.RAPID - kind[row] + gx.Kind.LINE
        refused(drawn, after.replace(kind=kind))
        if after.form[row] == gx.Form.MACHINE:
            form = after.form.copy()
            form[row] = gx.Form.PLAIN
            refused(drawn, after.replace(form=form))


def test_the_tool_goes_in_from_over_the_cut(drawn):
    """From a hundredth aside or above, in the time that this takes, is from elsewhere."""
    _, _, _, after = drawn
    row = after.given[-1].row + 3  # behind that, Y, X and Z have come back
    for column in range(3):
        end, feed = after.end.copy(), after.feed.copy()
        end[row, column] += 0.01
        feed[row] = FEED / np.linalg.norm((end[row] - end[row - 1])[:3])
        refused(drawn, after.replace(end=end, feed=feed))


def test_axes_come_back_in_their_order(drawn):
    """Z last: a way with Z before X is another, though it ends at the same place."""
    _, _, _, after = drawn
    row = after.given[-1].row + 2  # behind that, Y has come back: X, then Z
    x, z = after.end[row - 1 : row + 2, 0], after.end[row - 1 : row + 2, 2]
    assert x[0] != x[1] == x[2]
    assert z[0] == z[1] != z[2]
    end, feed = after.end.copy(), after.feed.copy()
    end[row, [0, 2]] = x[0], z[2]
    feed[[row, row + 1]] = feed[[row + 1, row]]
    refused(drawn, after.replace(end=end, feed=feed))


# --- the text ---


def tampered(monkeypatch, change):
    """Let the emitter write other lines: `change` gets their list, with source and nth of each."""
    write = Emitter.emit

    def emit(self, *given):
        done = write(self, *given)
        rows = [*zip(done.text.splitlines(True), done.source, done.nth, strict=True)]
        text, source, nth = zip(*change(rows), strict=True)
        return Emitted(b"".join(text), np.array(source), np.array(nth))

    monkeypatch.setattr(Emitter, "emit", emit)


def at_line(rows, text):
    return next(k for k, (line, _, _) in enumerate(rows) if line.rstrip() == text.encode())


@pytest.mark.parametrize("line", [*UP["retract_lines"], *UP["return_lines"]])
@pytest.mark.parametrize(
    "change",
    [
        lambda rows, k: rows[:k] + rows[k + 1 :],
        lambda rows, k: rows[: k + 1] + rows[k:],
        lambda rows, k: [*rows[:k], (b"M7\n", *rows[k][1:]), *rows[k + 1 :]],
        lambda rows, k: [*rows[: k - 1], rows[k], rows[k - 1], *rows[k + 1 :]],
        lambda rows, k: [*rows[:k], rows[k + 1], rows[k], *rows[k + 2 :]],
    ],
    ids=["missing", "doubled", "other", "earlier", "later"],
)
def test_a_text_with_other_lines_is_not_written(tmp_path, monkeypatch, change, line):
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", LIMITS["ac-trunnion"], **OPTIONS, **UP)
    tampered(monkeypatch, lambda rows: change(rows, at_line(rows, line)))
    with pytest.raises(gx.VerificationError):
        steps.run(round_about(tilt=25.0))


@pytest.mark.parametrize("row", range(1, 6))
def test_a_text_in_which_the_tool_comes_back_elsewhere_is_not_written(tmp_path, monkeypatch, row):
    """A number of a move behind the lines is a tenth larger."""
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", LIMITS["ac-trunnion"], **OPTIONS, **UP)

    def change(rows):
        k = at_line(rows, "M8") + row
        word = re.compile(rb"([XYZC]-?)([\d.]+)")
        line = word.sub(lambda m: m[1] + b"%.4f" % (float(m[2]) + 0.1), rows[k][0], count=1)
        assert line != rows[k][0]
        return [*rows[:k], (line, *rows[k][1:]), *rows[k + 1 :]]

    tampered(monkeypatch, change)
    with pytest.raises(gx.VerificationError):
        steps.run(round_about(tilt=25.0))


def test_in_a_chain_lines_are_divided_by_commas(tmp_path):
    steps, _, _ = steps_of(tmp_path, "ac-trunnion", LIMITS["ac-trunnion"], **OPTIONS, **UP)
    chain = (
        f"retarget tolerance={TOLERANCE} target=target.toml rapids=ends "
        f"axis-tolerance=0.5 retract={BACK} retract-feed={FEED} "
        f"retract-lines='M9,(up),G53 G0 Z{TOP}' return-lines='G4 X1.5, M8'"
    )
    (step,) = parse_chain(chain, tmp_path, default_registry())
    assert step == step_of(steps)

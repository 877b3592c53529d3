"""M codes of the machine that let the control follow the tip, as `rtcp` reads them."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from gcxform_plugins.passes.rtcp.forward.cutting import Cutting
from rtcp_kit import LENGTH, axes, chain_of_kind, machine_text, pipeline, positions
from seeds_kit import some

import gcxform as gx
from gcxform.contract.tip_codes import with_switches
from gcxform.pipeline.output import Output
from gcxform.pipeline.run import Run
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source

CONTROL = '[control]\ntip-on = "M428"\ntip-off = "M429"\n'
NUTATING = '[control]\ntip-on = "M429"\ntip-off = "M428"\n'
LINUXCNC = default_registry().dialect("linuxcnc")
HEAD = ["G21 G90 G94 G17 G54", "G0 X0 Y0 Z90 A0 C0", "G43 H1"]
WHOLE = [
    *HEAD,
    "M428",
    "G1 X10. Y5. Z3. A0. C0. F600.",
    "X12. Y7. Z4. A20. C30.",
    "X9. Y2. A0. C0.",
    "M429",
    "G49",
    "M2",
]


def linuxcnc(folder, control=CONTROL, **options):
    """Return the pipeline of `rtcp` for a LinuxCNC with a trunnion."""
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3)) + control
    options = options if "use" in options else {"tip_codes": "read", **options}
    pipeline(folder, machine, tolerance=0.01, **options)
    text = (folder / "p.toml").read_text().replace('"fanuc"', '"linuxcnc"')
    (folder / "p.toml").write_text(text)
    return gx.Pipeline.load(folder / "p.toml")


def text_of(lines):
    return "".join(f"{line}\n" for line in lines).encode()


def switched(seed):
    """Return lines of a program in cuts of tips, and which of them switch, by the sense of each.

    Between the cuts axes are at 0, and there it switches off and on, or says again what holds.
    """
    rng = np.random.default_rng(seed)
    lines, senses = list(HEAD), {}
    for cut in range(int(rng.integers(1, 4))):
        for sense in [False] * int(rng.integers(0, 2)) + [True] * int(rng.integers(1, 3)):
            senses[len(lines)] = sense
            lines.append("M428" if sense else "M429")
        lines.append(f"G1 X{cut}. Y0. A0. C0. F500.")
        for _ in range(int(rng.integers(1, 5))):
            x, y, z, a, c = rng.uniform(-1.0, 1.0, 5) * [50.0, 50.0, 20.0, 40.0, 90.0]
            lines.append(f"X{x:.3f} Y{y:.3f} Z{z:.3f} A{a:.3f} C{c:.3f}")
        lines.append(f"X{cut}. A0. C0.")
        if rng.random() < 0.5:
            senses[len(lines)] = False
            lines += ["M429", "X20. Y3."]
    return [*lines, "G49", "M2"], senses


def without(lines, gone):
    """Return a program without some lines, and which line each of the others was."""
    kept = [k for k in range(len(lines)) if k not in gone]
    return text_of(lines[k] for k in kept), kept


@pytest.mark.parametrize("seed", some(12))
def test_it_writes_what_it_writes_of_a_program_without_the_codes(tmp_path, seed):
    lines, senses = switched(seed)
    plain, kept = without(lines, senses)
    step = linuxcnc(tmp_path)
    read = step.run(text_of(lines))
    there = linuxcnc(tmp_path, control="").run(plain)
    assert read.certificate.verified
    assert read.text == there.text
    assert b"M42" not in read.text
    assert list(read.source_map) == [kept[line] for line in there.source_map]


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("size", [1, 40, 200])
def test_windows_of_any_size_are_alike(tmp_path, seed, size):
    program = text_of(switched(seed)[0])
    step = linuxcnc(tmp_path)
    parts = []
    Run(step, Source.of_bytes(program), "on").over(Output(parts.append, None), abs, size)
    assert b"".join(parts) == step.run(program).text


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("seed", some(12))
@pytest.mark.parametrize("size", [1, 0])
def test_each_code_counts(tmp_path, seed, size):
    """With the senses turned round it is a program in axes wherever it was one of tips."""
    step = linuxcnc(tmp_path, control=NUTATING)
    run = Run(step, Source.of_bytes(text_of(switched(seed)[0])), "on")
    with pytest.raises(gx.InputError, match="a feed of linear and rotary axes together"):
        run.over(Output(len, None), abs, size)


def test_what_they_mean_is_said_by_the_machine_file(tmp_path):
    other = [{"M428": "M429", "M429": "M428"}.get(line, line) for line in WHOLE]
    one = linuxcnc(tmp_path).run(text_of(WHOLE)).text
    assert linuxcnc(tmp_path, control=NUTATING).run(text_of(other)).text == one


def anyhow(rng):
    """Return lines with codes and turns anywhere, and where it is refused first, told line by line.

    The model knows one thing at a time: what is on, whether an axis is turned, whether X, Y and Z
    still stand where the last block said. `plain`: nothing moves in axes while one is turned.
    """
    lines, state, turned, wrong = [*HEAD, "G1 F500."], None, False, []
    whole = last = 0
    lost, plain = False, True
    for _ in range(int(rng.integers(3, 12))):
        kind = rng.choice(["on", "off", "turn", "back", "move"], p=[0.25, 0.1, 0.2, 0.35, 0.1])
        before = turned
        if kind in ("on", "off"):
            lines.append("M428" if kind == "on" else "M429")
            lost |= turned and state != kind
            state = str(kind)
            continue
        turned = {"turn": True, "back": False}.get(str(kind), turned)
        whole = 360 * int(rng.integers(-1, 2)) if kind == "back" else whole
        there = {"turn": f" A{rng.integers(1, 40)}. C7.", "back": f" A0 C{whole}"}
        lines.append(f"X{rng.uniform(-9.0, 9.0):.3f}{there.get(str(kind), '')}")
        steps = kind == "turn" or (kind == "back" and (before or whole != last))
        unsaid = state is None and (before or steps)
        wrong += [len(lines)] * (lost or unsaid or (state == "off" and steps))
        plain &= not (state == "off" and turned)
        last = whole
    return [*lines, "M2"], wrong, plain


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("seed", some(60))
def test_a_model_that_reads_line_by_line_agrees(tmp_path, seed):
    rng = np.random.default_rng(seed)
    lines, wrong, plain = anyhow(rng)
    run = Run(linuxcnc(tmp_path), Source.of_bytes(text_of(lines)), "on")
    parts = []
    out = Output(parts.append, None)
    size = int(rng.choice([0, 1, 30, 90]))
    if wrong:
        with pytest.raises(gx.InputError) as error:
            run.over(out, abs, size)
        found = error.value.diagnostics[0]
        assert found.code in ("GX311", "GX320", "GX330")
        assert found.where.line in wrong
        return
    run.over(out, abs, size)
    if plain:
        text, _ = without(lines, {k for k, line in enumerate(lines) if line[:3] == "M42"})
        assert b"".join(parts) == linuxcnc(tmp_path, control="").run(text).text


# --- switching with axes turned ---


def sections(seed):
    """Return lines of a program that switches with axes turned, and their stations.

    A station is where the program says that the tool goes: whether its words are of the tip, X, Y
    and Z, and the angles; by number of its line.
    """
    rng = np.random.default_rng(seed)
    lines, stations = [*HEAD, "M429"], {}
    place, angles = [0.0, 0.0, 90.0], [0.0, 0.0]

    def go(code, tip, where, turned):
        words = [f"{a}{v:.3f}" for a, v in zip("XYZAC", [*where, *turned], strict=True)]
        stations[len(lines)] = tip, [float(word[1:]) for word in words]
        lines.append(f"{code} {' '.join(words)}")

    for _ in range(int(rng.integers(2, 5))):
        angles = (rng.uniform(-1.0, 1.0, 2) * [60.0, 170.0]).tolist()
        go("G0", False, place, angles)
        lines.append("M428")
        for k in range(int(rng.integers(1, 5))):
            place = rng.uniform(-40.0, 40.0, 3).tolist()
            angles = angles if k < 2 else (np.array(angles) + rng.uniform(-9.0, 9.0, 2)).tolist()
            go("G1" if k else "G0", True, place, angles)
        lines.append("M429")
        for code in ("G0", "G1")[: int(rng.integers(1, 3))]:
            place = rng.uniform(-40.0, 40.0, 3).tolist()
            go(code, False, place, angles)
    lines.insert(4, "G1 F400.")
    return [*lines, "M2"], {line + (line >= 4): station for line, station in stations.items()}


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("seed", some(25))
def test_switched_with_axes_turned(tmp_path, seed):
    """Where the axes stand after each block is worked out by the matrices of scipy."""
    lines, stations = sections(seed)
    parts = []
    out = Output(parts.append, [])
    run = Run(linuxcnc(tmp_path), Source.of_bytes(text_of(lines)), "on")
    run.over(out, abs, [0, 1, 60][seed % 3])
    written = positions(b"".join(parts), "XYZAC")
    source = np.array(out.source_map)
    chain = chain_of_kind("ac-trunnion", 3)
    for line, (tip, said) in stations.items():
        wanted = np.array([said])
        if tip:
            wanted[:, :3] = axes(chain, wanted)
        found = written[np.flatnonzero(source == line)[-1]]
        np.testing.assert_allclose(found, wanted[0], atol=6e-4, err_msg=lines[line])


@pytest.mark.parametrize("seed", range(6))
def test_a_switch_that_is_left_out_is_noticed(tmp_path, seed, monkeypatch):
    """Whoever takes axes for tips, or tips for axes, does not get through the proof."""
    lines, _ = sections(seed)
    forget = seed % 2 == 1
    plain = Cutting.__init__

    def wrong(self, options, path, context, place, way):
        place.off = np.full(len(path), forget)
        plain(self, options, path, context, place, way)

    monkeypatch.setattr(Cutting, "__init__", wrong)
    with pytest.raises(gx.GcxformError, match=r"GX601|GX320"):
        linuxcnc(tmp_path, rapids="ends").run(text_of(lines))


def test_what_is_not_known_may_not_move(tmp_path, monkeypatch):
    """Behind a switch the source does not know where X stands; the output must not move it."""
    lines = with_line(6, "M429", "G0 Z100.", "G0 A0. C0.", "M428", "G0 X1. Y2. Z3.")
    plain = Cutting.run

    def moved(self):
        path, row = plain(self)
        end = path.end.copy(order="F")
        end[np.flatnonzero(path.end[:, 2] == 100.0 + LENGTH), 0] = 33.0
        return path.replace(end=end), row

    assert linuxcnc(tmp_path).run(text_of(lines)).certificate.verified
    monkeypatch.setattr(Cutting, "run", moved)
    with pytest.raises(gx.VerificationError, match="GX601"):
        linuxcnc(tmp_path).run(text_of(lines))


def with_line(number, *new):
    return [*WHOLE[:number], *new, *WHOLE[number:]]


REFUSED = {
    "off": (with_line(5, "M429"), 7, "GX320.*feed of linear and rotary axes together"),
    "off with an axis turned": (with_line(6, "M429"), 8, "GX311.*not known here"),
    "there and back": (with_line(6, "M429", "M428"), 9, "GX311.*not known here"),
    "not all named": (with_line(6, "M429", "G0 X1. Y2.", "M428", "G0 X1. Z3."), 10, "GX311"),
    "Z not named": (with_line(6, "M429", "M428", "G0 X1. Y2."), 9, "GX311"),
    "a cut comes first": (with_line(6, "M429", "M428", "G1 X1. Y2. Z3."), 9, "GX311"),
    "steps from nowhere": (with_line(6, "M429", "G91 G0 X1."), 8, "GX207"),
    "never": ([line for line in WHOLE if line[:2] != "M4"], 5, "is not known"),
    "not yet": ([*WHOLE[:3], "G1 X1. C5. F100.", "C0.", *WHOLE[3:]], 4, "is not known"),
    "no longer": (with_line(8, "G1 C5. F100."), 9, "GX320"),
    "beside a move": ([*WHOLE[:3], "M428 G1 X10. Y5. F600.", *WHOLE[5:]], 4, "beside a move"),
    "a whole turn without": (with_line(8, "G1 C360. F100."), 9, "GX320"),
    "there for no cut": (with_line(7, "G53 G1 X1. C360. F9."), 8, "in machine coordinates"),
    "another length": (with_line(6, "G43.1 Z5."), 8, "the tool length changes"),
}
GREAT = {
    "off": (with_line(5, "M429"), 7, "does not follow the tip"),
    "on with an axis turned": (with_line(6, "M428"), 7, "M428 where not all"),
    "off with an axis turned": (with_line(6, "M429"), 7, "M429 where not all"),
    "there and back": (with_line(6, "M429", "M428"), 7, "M429 where not all"),
    "no longer, in the last rapid": (with_line(8, "G0 C5."), 9, "does not follow the tip"),
    "a whole turn without": (with_line(8, "G1 C360. F100."), 9, "does not follow the tip"),
    "behind the last move": ([*WHOLE[:6], "M429", "M2"], 7, "M429 where not all"),
}


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("name", GREAT)
@pytest.mark.parametrize("size", [1, 0])
def test_on_great_circles_all_is_tips(tmp_path, name, size):
    """There the program may be off, and switch, only where all axes are at 0."""
    lines, line, message = GREAT[name]
    lines = [each.replace(" C30.", "") for each in lines]  # or the tool axis would have to leap
    step = linuxcnc(tmp_path, orientation_path="great-circle", before="")
    run = Run(step, Source.of_bytes(text_of(lines)), "on")
    with pytest.raises(gx.InputError, match=message) as error:
        run.over(Output(len, None), abs, size)
    found = error.value.diagnostics[0]
    assert (found.code, found.where.line) == ("GX330", line)


READ = {
    "on again with an axis turned": with_line(6, "M428"),
    "off in the last rapid": with_line(8, "G0 C5."),
    "before axes are known": ["G21 G90 G94 G17 G54", "M428", *WHOLE[1:]],
    "behind the last move": [*WHOLE[:6], "M429", "M2"],
    "home while off": with_line(6, "M429", "G53 G0 Z100.", "A0. C0.", "M428", "G0 X1. Y2. Z3."),
}


@pytest.mark.parametrize("name", READ)
def test_it_is_read(tmp_path, name):
    result = linuxcnc(tmp_path).run(text_of(READ[name]))
    assert result.certificate.verified
    assert b"M42" not in result.text


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("name", REFUSED)
@pytest.mark.parametrize("size", [1, 0])
def test_it_is_refused_by_name(tmp_path, name, size):
    lines, line, message = REFUSED[name]
    run = Run(linuxcnc(tmp_path), Source.of_bytes(text_of(lines)), "on")
    with pytest.raises(gx.InputError, match=message) as error:
        run.over(Output(len, None), abs, size)
    found = error.value.diagnostics[0]
    assert found.code in (message[:5], "GX330")
    assert found.where.line == line


@pytest.mark.usefixtures("one_process")
@pytest.mark.parametrize("angle", [360.0, -720.0, 540.0, 359.999, 0.001])
@pytest.mark.parametrize("size", [1, 0])
def test_whole_turns_are_as_none(tmp_path, angle, size):
    """There it may switch, be off, and go to a place of the machine; nowhere else."""
    turned = [f"G1 X10. C{angle} F600.", "M429", "X11.", "G53 G0 Z5.", "M428", "G1 C0. F600."]
    run = Run(linuxcnc(tmp_path), Source.of_bytes(text_of(with_line(7, *turned))), "on")
    parts = []
    if angle % 360.0:
        with pytest.raises(gx.InputError, match=r"GX320.*where it starts|GX311"):
            run.over(Output(len, None), abs, size)
        return
    run.over(Output(parts.append, None), abs, size)
    text = b"".join(parts).split(b"\n")
    at = text.index(b"G53 G0 Z5.")
    assert text[at - 1].startswith((b"X11.", b"G1 X11."))  # as the axes are without turns
    assert b"Y" not in text[at - 1]


@pytest.mark.usefixtures("one_process")
def test_a_position_that_is_lost_is_not_known(tmp_path):
    """M101 may move axes; where nothing moves behind it in its window, the next one says so."""
    lines = [*WHOLE[:4], "M429", "M101", "M428", *WHOLE[4:]]
    step = linuxcnc(tmp_path, control=CONTROL + 'user-codes = "keep"\n')
    for size in (1, 8, 12, 16, 24, 32, 40, 48, 56, 64, 72, 80, 0):
        with pytest.raises(gx.InputError, match="GX311"):
            Run(step, Source.of_bytes(text_of(lines)), "on").over(Output(len, None), abs, size)


@pytest.mark.usefixtures("one_process")
def test_on_great_circles_a_position_that_is_lost_is_refused_at_the_switch(tmp_path):
    lines = [*WHOLE[:4], "M429", "M101", "M428", *WHOLE[4:]]
    lines = [each.replace(" C30.", "") for each in lines]
    told = CONTROL + 'user-codes = "keep"\n'
    step = linuxcnc(tmp_path, control=told, orientation_path="great-circle", before="")
    for size in (1, 8, 12, 16, 24, 32, 40, 48, 56, 64, 72, 80, 0):
        with pytest.raises(gx.InputError, match="GX330"):
            Run(step, Source.of_bytes(text_of(lines)), "on").over(Output(len, None), abs, size)


@pytest.mark.parametrize(
    "options",
    [
        {"tip_codes": "refuse"},
        {"use": "to-tip"},
        {"use": "repost", "calibrated": "machine.toml"},
        {"control": ""},
    ],
)
def test_otherwise_no_such_program_is_read(tmp_path, options):
    with pytest.raises(gx.InputError, match="GX201"):
        linuxcnc(tmp_path, **options).run(text_of(WHOLE))


def test_a_block_that_is_skipped_keeps_no_code(tmp_path):
    lines = with_line(4, "/M428")
    step = linuxcnc(tmp_path)
    text = (tmp_path / "p.toml").read_text()
    for policy in ("skip", "execute"):
        said = text.replace("[machine]", f'block-delete = "{policy}"\n[machine]')
        (tmp_path / "p.toml").write_text(said)
        step = gx.Pipeline.load(tmp_path / "p.toml")
        if policy == "skip":
            with pytest.raises(gx.InputError, match="GX330"):
                step.run(text_of(lines))
        else:
            assert b"M428" not in step.run(text_of(lines)).text


def test_in_a_subprogram_they_are_read(tmp_path):
    """Sub and call are written out, and the codes are read where they are executed."""
    sub = ["o<on> sub", "M428", "o<on> endsub"]
    called = [*sub, *("o<on> call" if line == "M428" else line for line in WHOLE)]
    plain, _ = without(WHOLE, {3, 7})
    read = replace(linuxcnc(tmp_path), structure="written-out").run(text_of(called))
    assert read.text == linuxcnc(tmp_path, control="").run(plain).text


def test_behind_offsets_they_are_read(tmp_path):
    offsets = '[[pass]]\nuse = "offsets"\n[[pass]]\nuse = "segment"\nchord-error = 0.001\n'
    lines = [*WHOLE[:3], "G92 X5.", *WHOLE[3:8], "G92.1", *WHOLE[8:]]
    read = linuxcnc(tmp_path, before=offsets).run(text_of(lines))
    plain, _ = without(lines, {4, 8})
    assert read.text == linuxcnc(tmp_path, control="", before=offsets).run(plain).text
    with pytest.raises(gx.InputError, match="GX320"):
        linuxcnc(tmp_path, before=offsets, control=NUTATING).run(text_of(lines))


def test_comment_and_other_words_of_their_blocks_stay(tmp_path):
    lines = [line.replace("M428", "N7 m 0428 M8 (tips) ") for line in WHOLE]
    text = linuxcnc(tmp_path).run(text_of(lines)).text
    assert re.search(rb"^N7 M8 \(tips\) $", text, re.MULTILINE)


def test_a_code_that_is_left_is_no_proof(tmp_path, monkeypatch):
    """Whoever leaves a code in the text is found out: what reads it does not know the code."""
    monkeypatch.setattr("gcxform.emit.templates.unsaid_words", lambda *_: frozenset())
    monkeypatch.setattr("gcxform.emit.emitter.nothing_left", lambda *_: False)
    with pytest.raises(gx.VerificationError, match="M428"):
        linuxcnc(tmp_path).run(text_of(WHOLE))


def test_the_dialect_itself_stays_as_it_is():
    other = with_switches(LINUXCNC, {"tip-on": "M430", "tip-off": "M429"})
    assert {429, 430} == set(other.m_codes) - set(LINUXCNC.m_codes)
    assert with_switches(LINUXCNC, {"g52": "fanuc"}) is LINUXCNC


@pytest.mark.parametrize("first", ["on", "off"])
def test_the_machine_file_may_say_what_holds_at_the_start(tmp_path, first):
    """Then the program need not, with whatever axes are turned."""
    turned = ["G1 X1. Y2. Z3. A5. C10. F600.", "A0. C0."] if first == "on" else ["G0 C20.", "C0."]
    lines = [*WHOLE[:3], *turned, *WHOLE[3:]]
    with pytest.raises(gx.InputError, match="whether the control follows the tip is not known"):
        linuxcnc(tmp_path).run(text_of(lines))
    told = CONTROL + f'tip-at-start = "{first}"\n'
    result = linuxcnc(tmp_path, control=told).run(text_of(lines))
    said = [line for line in lines if line not in ("M428", "M429")]
    other = linuxcnc(tmp_path, control="", rapids="ends").run(text_of(said))
    verb = "follows" if first == "on" else "does not follow"
    assert f"the control {verb} the tip before the first block" in result.certificate.assumed
    if first == "on":
        assert result.text == other.text
    else:
        assert b"\nG0 C20.\nC0.\n" in result.text


@pytest.mark.parametrize(
    ("control", "message"),
    [
        ('tip-on = "M428"', "given together"),
        ('tip-off = "M428"', "given together"),
        ('tip-on = "M428"\ntip-off = "M428"', "cannot say both"),
        ('tip-on = "M428"\ntip-off = "G49"', "expected an M code"),
        ('tip-on = "M5"\ntip-off = "M428"', "expected an M code"),
        ('tip-on = 428\ntip-off = "M429"', "expected an M code"),
        ('tip-on = ["M428"]\ntip-off = "M429"', "expected"),
        ('tip-at-start = "perhaps"', "tip-at-start: expected"),
    ],
)
def test_settings_that_say_nothing_are_refused(tmp_path, control, message):
    with pytest.raises(gx.UsageError, match=message):
        linuxcnc(tmp_path, control=f"[control]\n{control}\n")


# --- a control that follows the tip with its tool length ---

BY_LENGTH = [
    "G21 G90 G94 G17 G54",
    "G0 X0. Y0. A0. C0.",
    "G43.4 H1 Z90.",
    "G0 X10. Y5. Z3. A20. C30.",
    "G1 X12. F100.",
    "G0 A0. C0.",
    "G49",
    "M30",
]


def fanuc(folder, control):
    machine = machine_text("ac-trunnion", chain_of_kind("ac-trunnion", 3)) + control
    return pipeline(folder, machine, tolerance=0.01, tip_codes="read", rapids="ends")


def test_what_holds_at_the_start_ends_where_a_length_follows_the_tip(tmp_path):
    """G43.4 follows the tip, whatever was said of the control before the first block."""
    there = fanuc(tmp_path, "").run(text_of(BY_LENGTH)).text
    said = fanuc(tmp_path, '[control]\ntip-at-start = "off"\n').run(text_of(BY_LENGTH)).text
    assert said == there
    assert b"G0 X10. Y5. Z3." not in there


@pytest.mark.parametrize("behind", [2, 3])
def test_a_length_that_follows_and_a_code_that_does_not_are_refused(tmp_path, behind):
    """Which of the two holds is not known; X, Y and Z must not be taken for those of axes."""
    lines = [*BY_LENGTH[:behind], "M429", *BY_LENGTH[behind:]]
    with pytest.raises(gx.InputError, match=r"(?s)GX330.*does not follow the tip"):
        fanuc(tmp_path, CONTROL).run(text_of(lines))

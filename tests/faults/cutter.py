"""Faults of cutter compensation: reading, the centre path, its proof."""

from __future__ import annotations

from faults.mutation import CORPUS, CUTTER, Mutation

PLANTED = "tests/test_planted_comp.py"


def _offsetting(
    name: str, old: str, new: str, file: str = "offsetting", test: str = CUTTER
) -> Mutation:
    return Mutation(
        f"offsetting: {name}",
        f"plugins/gcxform_plugins/passes/cutter_comp/{file}.py",
        old,
        new,
        test,
    )


def _entry(name: str, file: str, old: str, new: str, test: str = "") -> Mutation:
    case = f"tests/test_corpus.py::test_case[cutter-comp/{test}]"
    return Mutation(
        f"arc entry: {name}",
        f"plugins/gcxform_plugins/passes/cutter_comp/{file}.py",
        old,
        new,
        case if test else "tests/test_arc_entries.py",
    )


def _beside(name: str, old: str, new: str, file: str = "proof") -> Mutation:
    return Mutation(
        f"beside: {name} not looked at",
        f"plugins/gcxform_plugins/passes/cutter_comp/{file}.py",
        old,
        new,
        CUTTER,
    )


MUTATIONS = (
    Mutation(
        "cutter-comp: a contour in a tilted plane is one of the axes",
        "plugins/gcxform_plugins/passes/cutter_comp/refusals.py",
        "(on | leaves) & tilted[path.frame, 2 - path.plane]",
        "(on | leaves) & False",
        f"{CORPUS}[cutter-comp/tilted]",
    ),
    Mutation(
        "cutter-comp: every control goes straight past corners in rapid",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "if not context.source.cutter_comp.corners:",
        "if False:",
        f"{CORPUS}[cutter-comp/rapid-corner-fanuc]",
    ),
    Mutation(
        "cutter-comp: the machine file goes before what the program says of corners",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        'corners_said(path, context).only if name == "corners" else ""',
        '""',
        "tests/test_corpus.py::test_case[cutter-comp/siemens-corners-said]",
    ),
    Mutation(
        "cutter-comp: what the program says of corners later does not count",
        "plugins/gcxform_plugins/passes/cutter_comp/corners_said.py",
        "zip(self.rows.tolist(), self.ways, strict=True)",
        "[*zip(self.rows.tolist(), self.ways, strict=True)][:1]",
        "tests/test_corpus.py::test_case[cutter-comp/gx740-changes]",
    ),
    Mutation(
        "cutter: a tool that is only selected is asked for its radius",
        "gcxform/cli/program/machine_needs.py",
        "spindle = selected if block.meaning.changes_tool else spindle",
        "spindle = selected",
        "tests/test_machine_new.py::test_the_radius_of_the_tool_in_the_spindle_is_asked_for",
    ),
    Mutation(
        "cutter: how a contour is resolved is guessed where a parameter decides it",
        "gcxform/pipeline/cutter_comp.py",
        "if len(ways) != 1:",
        "if not ways:",
        f"{CORPUS}[cutter-comp/gx233-volumetric]",
    ),
    Mutation(
        "cutter: that the control's offsets act no more is not said",
        "gcxform/pipeline/cutter_comp.py",
        "(ways[0], *plan.passes)), (RESOLVED,)",
        "(ways[0], *plan.passes)), ()",
        f"{CORPUS}[volumetric/contour]",
    ),
    Mutation(
        "cutter: a negative diameter keeps its side",
        "gcxform/modal/moves/cutter_comp.py",
        "np.where(radius < 0, -SIDES[code], SIDES[code])",
        "SIDES[code]",
        CUTTER,
    ),
    Mutation(
        "cutter: d of a tool is a radius, whatever d-is says",
        "gcxform/machine/file.py",
        "radius=tool.d / 2 if half else tool.d",
        "radius=tool.d",
        f"{CORPUS}[cutter-comp/d-is-a-diameter]",
    ),
    Mutation(
        "cutter: d of a tool is a radius where nothing says it",
        "gcxform/machine/file.py",
        "if control.D_IS not in file.control:",
        "if False:",
        f"{CORPUS}[bad/gx437-d]",
    ),
    Mutation(
        "a thread in passes is offered to be written out",
        "gcxform/emit/codewords.py",
        "if cycle is not None and cycle.refused:",
        "if False:",
        f"{CORPUS}[dialects/across/thread-in-passes]",
    ),
    Mutation(
        "cutter: the diameter is taken for the radius",
        "gcxform/modal/moves/cutter_comp.py",
        "value * unit / 2",
        "value * unit",
        CUTTER,
    ),
    Mutation(
        "cutter: T counts before it is in the spindle",
        "gcxform/modal/moves/cutter_comp.py",
        "np.where(_is_m6(lines, changes), selected, np.nan), changes, state.tool",
        "selected, selected == selected, state.tool",
        CUTTER,
    ),
    Mutation(
        "copying: a probe stays as it is in other coordinates",
        "gcxform/emit/same_rows.py",
        "framed |= one_move | cycle[:, 0]",
        "framed |= cycle[:, 0]",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "copying: distances stay as they are where a turn is folded away",
        "gcxform/emit/same_rows.py",
        "incremental[:, 0] & (self.frames(rows, others) | nowhere)",
        "incremental[:, 0]",
        "tests/test_corpus.py::test_case",
    ),
    _offsetting("the other side", "at + moves.off *", "at - moves.off *"),
    _offsetting("arcs grow inside", "- self.sense * self.off", "+ self.sense * self.off", "moves"),
    _offsetting("the other crossing", "* turns >= 0)", "* turns <= 0)"),
    _offsetting(
        "moves that go backwards are let through", "moves.first) >= -1e-9)", "moves.first) >= -9e9)"
    ),
    _offsetting(
        "small turns are corners", "np.abs(turn) <= manner.straight", "np.abs(turn) <= 1e-9"
    ),
    _offsetting("the inside is the outside", "((turn < 0) |", "((turn > 0) |"),
    _offsetting(
        "a contour is joined to the one before",
        "joined = ~moves.begins",
        "joined = moves.begins | True",
        test=f"{CORPUS}[cutter-comp/planes]",
    ),
    _offsetting(
        "what is refused first is told, not what comes first",
        "min(self.found, key=lambda each: each[0])",
        "self.found[0]",
        test=f"{CORPUS}[cutter-comp/gx350-first]",
    ),
    Mutation(
        "cutter-comp: a contour that begins along the tool goes before all others",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "            row = row[row < blind[0]]",
        "            row = row[:0]",
        f"{CORPUS}[cutter-comp/gx350-before-along]",
    ),
    Mutation(
        "cutter-comp: arcs that meet straight but for their last decimal have a corner",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "STRAIGHT = 1e-3",
        "STRAIGHT = 1e-4",
        f"{CORPUS}[cutter-comp/tangent-arcs-rounded]",
    ),
    Mutation(
        "cutter-comp: corners go the wrong way",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "np.where(path.side[rows] > 0, gx.Kind.ARC_CW",
        "np.where(path.side[rows] < 0, gx.Kind.ARC_CW",
        CUTTER,
    ),
    Mutation(
        "cutter-comp: still moves stay on the contour",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "end[still, axes] = end[mover, axes]",
        "pass",
        CUTTER,
    ),
    Mutation(
        "cutter-comp: the speed in inverse time is that of the centre",
        "plugins/gcxform_plugins/passes/cutter_comp/cutter_comp.py",
        "np.where(change, feed * programmed / np.where(change, mine, 1.0), feed)",
        "feed",
        CUTTER,
    ),
    Mutation(
        "compensated: a stretch ends where another begins",
        "gcxform/pipeline/cutter_comp.py",
        "last if line < left else before + line",
        "before + line",
        CUTTER,
    ),
    Mutation(
        "compensated: what began before the end of a text is forgotten",
        "gcxform/pipeline/cutter_comp.py",
        "if at and tail.begins != UNSEEN:",
        "if at:",
        CUTTER,
    ),
    Mutation(
        "compensated: a stretch begins as far from the end of a text as from its start",
        "gcxform/pipeline/cutter_comp.py",
        "before + at)",
        "before)",
        CUTTER,
    ),
    Mutation(
        "compensated: windows end inside a stretch",
        "gcxform/pipeline/cutter_comp.py",
        "        at = stretch.begins if stretch.begins >= 0 else size\n",
        "        at = size\n",
        CUTTER,
    ),
    Mutation(
        "compensated: contours may be moved",
        "gcxform/pipeline/cutter_comp.py",
        "if type(step).undo is not Pass.undo and before.side.any():",
        "if False:",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "compensated: a contour may be cut",
        "gcxform/pipeline/cutter_comp.py",
        "elif len(rows) != len(new):",
        "elif False:",
        PLANTED,
    ),
    Mutation(
        "compensated: a point of a contour may be moved",
        "gcxform/pipeline/cutter_comp.py",
        "rows[_changed(before, rows, after, new)]",
        "rows[:0]",
        PLANTED,
    ),
    Mutation(
        "compensated: the move that ends compensation may be moved",
        "gcxform/toolpath/contours.py",
        "last_on > last_left",
        "np.append(on, False)",
        PLANTED,
    ),
    Mutation(
        "compensated: a move along the tool ends compensation",
        "gcxform/toolpath/contours.py",
        "np.where(in_plane & ~on, rows, -2)",
        "np.where(~on, rows, -2)",
        f"{CORPUS}[cutter-comp/gx233-leaving-behind-z]",
    ),
    Mutation(
        "compensated: a window that begins within a contour is free of it",
        "gcxform/toolpath/contours.py",
        "-1 if path.leaving else -2",
        "-2",
        "tests/test_cutter_comp.py::test_the_way_off_a_contour_is_kept_in_every_window",
    ),
    Mutation(
        "stretches: the move that ends compensation is none of it",
        "gcxform/proof/compensated_stretches.py",
        "first + int(off[0]) + 1",
        "first + int(off[0])",
        PLANTED,
    ),
    Mutation(
        "stretches: nothing goes on in the next window",
        "gcxform/proof/compensated_stretches.py",
        "whole = piece if self._open is None else _joined(self._open, piece)",
        "whole = piece",
        PLANTED,
    ),
    Mutation(
        "centrepath: how far the centre is off is not looked at",
        "gcxform/proof/centre_path.py",
        "if not off.distance <= budget:",
        "if False:",
        PLANTED,
    ),
    Mutation(
        "centrepath: where the control stops is not looked at",
        "gcxform/proof/centre_path.py",
        "if (stop := _stop(self.ways, one, self.context)) is not None:",
        "if (stop := None) is not None:",
        "tests/test_corpus.py::test_case",
    ),
    Mutation(
        "centrepath: what differs is taken for the same",
        "gcxform/proof/centre_path.py",
        "    return all(np.array_equal",
        "    return any(np.array_equal",
        PLANTED,
    ),
    Mutation(
        "centrepath: one setting of a control is compared",
        "gcxform/proof/centre_path.py",
        "for way in self.ways:",
        "for way in self.ways[:1]:",
        PLANTED,
    ),
    _offsetting(
        "LinuxCNC never looks back",
        "> manner.straight, True)",
        "> 9.9, True)",
        test="tests/test_corpus.py::test_case",
    ),
    _beside("begins", 'self._fail(wrong & ~self.entry, "the centre is not', 'str("'),
    _beside("ends", 'self._fail(wrong, "the centre is not', 'str("'),
    _beside("backwards", 'self._fail(back, "', 'str("'),
    _beside("sweeps", 'self._fail(self.arc & (off > slack), "', 'str("'),
    _beside("centres", 'self._fail(moved, "the centre of', 'str("the centre of'),
    _entry("its direction is not looked at", "proof", "(uneven | turned |", "(uneven |"),
    _entry("its start is not looked at", "proof", "(uneven | turned |", "(turned |"),
    _entry("it keeps its centre", "offsetting", "(2 * along) * u", "(3 * along) * u"),
    _entry("a small one", "offsetting", "<= moves.radius", "< 0", "arc-begins-too-small"),
    _entry(
        "an inside corner moves its end",
        "offsetting",
        "refusals.add(JOIN, blocked, message)",
        "str(message)",
        "arc-begins-then-inside",
    ),
    _entry("a circle", "offsetting", "moves.sweep[k] > TURN - WHOLE", "False", "arc-begins-whole"),
    _beside("missing corners", 'self._fail(missing, "', 'str("'),
    _beside("round corners", "self.row[k][round_it & wrong]", "self.row[k][:0]"),
    _beside("other axes", "on[~same.all(axis=1)]", "on[:0]"),
    _beside("still moves", "on[~moves & (_apart(a, b) > CLOSE)]", "on[:0]"),
    _beside("rising corners", "self.row[k][rises]", "self.row[k][:0]"),
    _beside("feeds", "owner[~same]", "owner[:0]", "unchanged"),
    _beside("speeds in inverse time", "timed[owner] & ~goes", "timed[owner]", "unchanged"),
    _beside("sliding ends", "free & slid", "free & False"),
    _beside("sliding joints", "free |= enters", "free |= enters & False"),
    _beside("sliding turns", "np.append(self.none[1:], False)", "ends"),
    _beside("rapid corners", "self.row[k][rapid]", "self.row[k][:0]"),
    _beside(
        "modes of corners",
        "!= getattr(before, name)[owner]\n",
        "!= getattr(after, name)\n",
        "unchanged",
    ),
    Mutation(
        "cutter: a radius that is not said is 0",
        "gcxform/machine/machine.py",
        'of the cutter, mm; else not known")] = NOT_SAID',
        'of the cutter, mm; else not known")] = 0.0',
        "tests/test_corpus.py::test_case[cutter-comp/radius-not-said]",
    ),
    Mutation(
        "cutter: a length that is not said is 0",
        "gcxform/machine/machine.py",
        'to the tip, mm; else not known")] = NOT_SAID',
        'to the tip, mm; else not known")] = 0.0',
        "tests/test_corpus.py::test_case[dialects/fanuc/length-not-said]",
    ),
)

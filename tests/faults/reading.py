"""Faults of reading: modes, positions, arcs, and what a control refuses."""

from __future__ import annotations

from faults.mutation import CORPUS, FACTS, FOUND, LIMITS, READING, VERIFY, Mutation

MUTATIONS = (
    # reading
    Mutation(
        "reading: inches are millimetres",
        "gcxform/modal/frames/track.py",
        "np.where(self.modes.inch, word[0] * INCH, word[0])",
        "np.where(self.modes.inch, word[0], word[0])",
        READING,
    ),
    Mutation(
        "reading: the sense of arcs is swapped",
        "gcxform/toolpath/path.py",
        "2.0 * self.kind - 5.0",
        "5.0 - 2.0 * self.kind",
        READING,
    ),
    Mutation(
        "reading: the centre word that is dropped makes an arc alone",
        "gcxform/modal/moves/arcs.py",
        "~(in_plane & self.rule.drops_third)",
        "~(has.any(axis=1) & self.rule.drops_third)",
        CORPUS,
    ),
    Mutation(
        "reading: GRBL leaves G92 its axis words beside G80",
        "gcxform/modal/meaning/sorting.py",
        "dialect.block_rule.g80_beside_motion or words.isdisjoint(dialect.axes)",
        "dialect.block_rule.g80_beside_motion or bool(words)",
        CORPUS,
    ),
    Mutation(
        "reading: G80 leaves G43.1 its axis words",
        "gcxform/modal/meaning/sorting.py",
        'meaning.groups["motion"] != "G80" or code.act == "length-vector"',
        'meaning.groups["motion"] != "G80"',
        CORPUS,
    ),
    Mutation(
        "reading: a percent sign beside words is dropped",
        "gcxform/modal/meaning/sorting.py",
        "return alone and dialect.program_rule.drops_percent",
        "return dialect.program_rule.drops_percent",
        CORPUS,
    ),
    Mutation(
        "reading: a percent sign that says nothing goes to a control to which it does",
        "gcxform/emit/expressible.py",
        "source is not target and not framed",
        "source is not target and not target.program_rule.has_percent",
        CORPUS,
    ),
    Mutation(
        "reading: a full circle has no sweep",
        "gcxform/toolpath/angles.py",
        "return np.where(same, TURN, angle)",
        "return np.where(same, 0.0, angle)",
        READING,
    ),
    Mutation(
        "reading: the long arc by radius is the short one",
        "gcxform/modal/moves/arcs.py",
        "np.where(radius > 0, sense, -sense)",
        "np.where(radius > 0, sense, sense)",
        READING,
    ),
    Mutation(
        "reading: distances are added to the last absolute position only",
        "gcxform/modal/frames/track.py",
        "np.where(placed, value - steps, 0.0)",
        "np.where(placed, value, 0.0)",
        READING,
    ),
    Mutation(
        "reading: positions are not carried into the next window",
        "gcxform/modal/frames/track.py",
        "self.state.position = np.array(self.frame.positions(end[None, :])[0])",
        "pass",
        VERIFY,
    ),
    Mutation(
        "reading: modes are not carried into the next window",
        "gcxform/modal/interpreter.py",
        "int(column[-1]) for name, column in last.items()",
        "self.state.groups[name] for name in last",
        VERIFY,
    ),
    Mutation(
        "reading: a lost position is ignored",
        "gcxform/toolpath/path.py",
        "start[(self.lost >> axis & 1) == 1, axis] = np.nan",
        "pass",
        FOUND,
    ),
    # what a control refuses
    Mutation(
        "limits: a line may be one character longer",
        LIMITS,
        "if long > limit:",
        "if long > limit + 1:",
        FACTS,
    ),
    Mutation(
        "limits: blanks and comments count",
        LIMITS,
        "without_blanks(window.line(line)) if blanks else int(length[line])",
        "int(length[line])",
        FACTS,
    ),
    Mutation(
        "limits: speeds and times may be negative",
        LIMITS,
        "any(value < 0 for",
        "any(value < -10 for",
        FACTS,
    ),
    Mutation(
        "limits: turns belong to lines",
        LIMITS,
        "arc = (modes.motion >= Kind.ARC_CW)",
        "arc = (modes.motion > Kind.ARC_CCW)",
        FACTS,
    ),
    Mutation(
        "limits: arcs in inches are held to the tolerance of mm",
        "gcxform/modal/moves/arcs.py",
        "np.where(inch, rule.in_inch, 1.0)",
        "np.where(inch, 1.0, 1.0)",
        FACTS,
    ),
    Mutation(
        "limits: one M word more",
        "gcxform/modal/meaning/sorting.py",
        'word.address == "M"][most:][:1]',
        'word.address == "M"][most + 1 :][:1]',
        FACTS,
    ),
    Mutation(
        "limits: any tool is in the table",
        LIMITS,
        "named not in tools",
        "False",
        FACTS,
    ),
)

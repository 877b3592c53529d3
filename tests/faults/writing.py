"""Faults of writing."""

from __future__ import annotations

from faults.mutation import CORPUS, FIGURES, FOUND, LAWS, VERIFY, Mutation

MUTATIONS = (
    Mutation(
        "writing: another axis may move where only the machine knows whether it does",
        "gcxform/emit/copying.py",
        "        lines[self.path.block[extra]] = True\n",
        "",
        "tests/test_corpus.py::test_case[volumetric/perhaps-another-axis]",
    ),
    Mutation(
        "comments: what acts at once is taken over",
        "gcxform/emit/expressible.py",
        "in target.text_rule.acts_anywhere}",
        "in source.text_rule.acts_anywhere}",
        "tests/test_corpus.py::test_case[dialects/across/comment-of-real-time]",
    ),
    Mutation(
        "writing: numbers are cut off, not rounded",
        "gcxform/emit/numbers.py",
        "(0.5 + TIE))\n    return np.copysign",
        "TIE)\n    return np.copysign",
        FIGURES,
    ),
    Mutation(
        "writing: an axis that the block does not name stays behind",
        "gcxform/emit/positions.py",
        "moved = ~(np.abs(held - self.before[:, column]) < 0.5 * self.step[column])",
        "moved = np.zeros(len(held), np.bool_)",
        FIGURES,
    ),
    Mutation(
        "writing: a motion code that has changed is not stated",
        "gcxform/emit/stated.py",
        "changes = moves & (before != after)",
        "changes = np.zeros(len(before), np.bool_)",
        LAWS + "::test_a_motion_code_that_no_longer_holds_is_stated",
    ),
    Mutation(
        "writing: centres count from where the start was before rounding",
        "gcxform/emit/centres.py",
        "return np.where(exact, start, before)",
        "return start",
        LAWS + "::test_centres_count_from_the_start_as_it_is_written",
    ),
    Mutation(
        "writing: distances are rounded one by one",
        "gcxform/emit/positions.py",
        "value - self.before[rows, column], value)",
        "(self.task.path.end - self.task.path.start)[rows, column], value)",
        LAWS + "::test_distances_do_not_drift",
    ),
    Mutation(
        "writing: what the control believes is not carried into the next window",
        "gcxform/emit/emitter.py",
        "believed.position = np.array(held)",
        "del held",
        VERIFY,
    ),
    Mutation(
        "writing: lengths in another unit are kept",
        "gcxform/emit/depending.py",
        'if inch[line] or address == "X":',
        "if False:",
        FOUND,
    ),
    Mutation(
        "writing: the point that a return goes over keeps its number in another unit",
        "gcxform/emit/writing.py",
        "quantise(value / INCH if inch else value * INCH, decimals)",
        "quantise(value, decimals)",
        CORPUS + "[metric/home-by-a-point]",
    ),
    Mutation(
        "writing: a block to where nobody knows is converted",
        "gcxform/emit/converting.py",
        "found[task.path.block[rows[lost]]] = False",
        "del lost",
        CORPUS + "[hazards/machine-coordinates-in-inches]",
    ),
    Mutation(
        "writing: increments are converted as if they were lengths",
        "gcxform/emit/converting.py",
        "(task.window.decimals[numbers] < 0).any()",
        "not numbers",
        CORPUS + "[bad/gx506-home]",
    ),
    Mutation(
        "writing: a linear axis is written where rotary ones turn alone",
        "gcxform/emit/positions.py",
        "alone = self._turning if axis in LINEAR",
        "alone = self._turning if not axis",
        CORPUS,
    ),
    Mutation(
        "writing: words of radius and angle are X and Y",
        "gcxform/emit/copying.py",
        "        if not self.same.polar.any():\n            return",
        "        if len(self.same.polar):\n            return",
        CORPUS,
    ),
    Mutation(
        "writing: a cycle does not mind whether words are radius and angle",
        "gcxform/emit/same_rows.py",
        " & self._polar_alike(rows, others)\n",
        "\n",
        CORPUS,
    ),
    Mutation(
        "writing: a feed without a point is the same in every feed mode",
        "gcxform/emit/stated.py",
        "return np.asarray(~self._other_mode | pointed[line])",
        "return np.ones(len(line), np.bool_)",
        CORPUS,
    ),
    Mutation(
        "writing: words are added behind the end of their block",
        "gcxform/emit/templates.py",
        """        elif item.kind == "block_end":
            self._rest()
""",
        """        elif item.kind == "block_end":
            pass
""",
        CORPUS + "[dialects/fanuc/block-end-anew]",
    ),
    Mutation(
        "writing: G10 L20 does not count from where the axes stand",
        "gcxform/emit/manner.py",
        "not (kind == 2 or (kind == 20 and named))",
        "kind not in (2, 20)",
        CORPUS + "[hazards/zero-set-here-elsewhere]",
    ),
    Mutation(
        "writing: G10 L2 counts from where the axes stand",
        "gcxform/emit/manner.py",
        "not (kind == 2 or (kind == 20 and named))",
        "not (kind == 20 and named)",
        CORPUS + "[volumetric/zero-set-behind]",
    ),
    Mutation(
        "writing: L20 of more work offsets counts from where the axes stand",
        "gcxform/emit/manner.py",
        "not (kind == 2 or (kind == 20 and named))",
        "kind != 2",
        CORPUS + "[dialects/fanuc/more-offset-set-behind]",
    ),
)

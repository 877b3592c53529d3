"""Faults of `rtcp` of axes, where angles that are rounded move the tip, and of its proof."""

from __future__ import annotations

from faults.mutation import Mutation

CUTTING = "plugins/gcxform_plugins/passes/rtcp/forward/cutting.py"
CONVERSION = "plugins/gcxform_plugins/passes/rtcp/conversion.py"
TIPS = "plugins/gcxform_plugins/passes/rtcp/proof/tips.py"
DRIVEN = "plugins/gcxform_plugins/passes/rtcp/proof/driven.py"
TESTS = "tests/test_rtcp_tips.py"
WITHIN = f"{TESTS}::test_the_tip_is_within_its_tolerance"
PROVED = f"{TESTS}::test_the_proof_follows_tips"

MUTATIONS = (
    Mutation(
        "tips: what rounded angles do to them is not counted",
        CUTTING,
        "return far if self.to_axes else far",
        "return far if not self.to_axes else far",
        WITHIN,
    ),
    Mutation(
        "tips: rounded angles may take them as far as the tolerance",
        CUTTING,
        "over = astray > ASTRAY * self.options.tolerance",
        "over = astray > 1e9 * self.options.tolerance",
        WITHIN,
    ),
    Mutation(
        "tips: rounded angles where blocks end are not counted",
        CUTTING,
        "            self._check_ends()\n",
        "",
        f"{TESTS}::test_where_blocks_end",
    ),
    Mutation(
        "tips: they are not followed",
        CONVERSION,
        "        self._tips(cutting.path, path, cutting.context, row).check_tips()\n",
        "",
        PROVED,
    ),
    Mutation(
        "tips: the proof does not look at any",
        TIPS,
        "super()._known() & turned &",
        "super()._known() & ~turned &",
        PROVED,
    ),
    Mutation(
        "tips: the proof has no tolerance",
        TIPS,
        "if not self.tip <= self.options.tolerance:",
        "if not self.tip <= 1e9 * self.options.tolerance:",
        PROVED,
    ),
    Mutation(
        "tips: the proof sees those that are written elsewhere",
        DRIVEN,
        "        angles = self.place.angles(here)\n        return here[:, :3],",
        "        angles = self.place.angles(here)\n        return here[:, :3] * 1.001,",
        WITHIN,
    ),
    Mutation(
        "tips: what is measured takes pieces of one line for one",
        CONVERSION,
        "if not _other(before).all():",
        "if False:",
        f"{TESTS}::test_what_is_measured_where_lines_are_cut_before",
    ),
    Mutation(
        "a step measures more than it promises",
        "gcxform/pipeline/kept_promises.py",
        "if name in measured and not measured[name] <= bound + EQUAL:",
        "if name in measured and not measured[name] <= 1e9 * bound:",
        "tests/test_corpus.py::test_a_pass_that_measures_more_than_it_promises",
    ),
)

"""Faults of what `volumetric` leaves to the machine, and of what the proof asks of it."""

from __future__ import annotations

from faults.mutation import CORPUS, Mutation

PLANTED = "tests/test_planted_volumetric.py"
SPARED = "gcxform/proof/spared_rapids.py"
COMPENSATION = "plugins/gcxform_plugins/passes/volumetric/forward/compensation.py"
UNDOING = "plugins/gcxform_plugins/passes/volumetric/undo/machine.py"

MUTATIONS = (
    Mutation(
        "volumetric: a cut begins behind another length where it did before it",
        COMPENSATION,
        "self.left[:-1] | (np.abs(self._jumps()) > SAME).any(axis=1)",
        "self.left[:-1]",
        "tests/test_corpus.py::test_case[volumetric/length-then-line]",
    ),
    Mutation(
        "volumetric: behind another length the machine is taken to have moved with it",
        COMPENSATION,
        "self.end[:-1]]) + jumps)[rows]",
        "self.end[:-1]]))[rows]",
        "tests/test_corpus.py::test_case[volumetric/length-within-the-promise]",
    ),
    Mutation(
        "spared: the start is free of error in the undo",
        UNDOING,
        "actual = entry + self.moved(table, self.place.first_tool)",
        "actual = entry.copy()",
        PLANTED,
    ),
    Mutation(
        "spared: feed moves from the start are not looked at",
        COMPENSATION,
        "known = path.held is not None and bool(np.isfinite(self.start[0]).all())",
        "known = False",
        PLANTED,
    ),
    Mutation(
        "spared: what goes by distances ends where the program says",
        COMPENSATION,
        "distances |= path.form == gx.Form.BLIND",
        "pass",
        f"{CORPUS}[volumetric/distances-beside-the-unknown]",
    ),
    Mutation(
        "spared: feed moves behind rapids that are left are not looked at",
        COMPENSATION,
        "np.append(known, self.left[:-1] |",
        "np.append(known, np.zeros(len(path) - 1, np.bool_) |",
        PLANTED,
    ),
    Mutation(
        "spared: what was written before is forgotten",
        "gcxform/pipeline/run.py",
        "self.held.get(number, path.entry)",
        "path.entry",
        f"{PLANTED}::test_windows_know_where_the_axes_were_left",
    ),
    Mutation(
        "spared: where a rapid is told to go is not looked at",
        SPARED,
        "good = (np.abs(end - goal) <= slack)",
        "good = (np.abs(end - goal) <= 1.0)",
        PLANTED,
    ),
    Mutation(
        "spared: an axis that rests may go anywhere",
        SPARED,
        "(np.abs(end - start) <= STILL) & (np.abs(goal - begin) <= STILL)",
        "(np.abs(goal - begin) <= STILL)",
        PLANTED,
    ),
    Mutation(
        "spared: where feed moves begin is not compared in the first row",
        "gcxform/proof/verify.py",
        "kind[trace.owner] != Kind.RAPID))\n        if not len(rows)",
        "kind[trace.owner] != Kind.RAPID))[1:]\n        if not len(rows)",
        PLANTED,
    ),
    Mutation(
        "spared: an axis that is named where it stands is taken for one that rests",
        COMPENSATION,
        "(np.abs(way) < SAME) & ~named[row]",
        "np.abs(way) < SAME",
        f"{CORPUS}[volumetric/g53-at-rest]",
    ),
    Mutation(
        "spared: two programs are not compared where feed moves begin",
        "gcxform/comparison.py",
        "np.where(fresh & behind & feeds, gap, 0.0)",
        "np.zeros(len(row))",
        "tests/test_compare_model.py::test_what_is_left_to_the_machine",
    ),
    Mutation(
        "promises: what proves itself has room for nothing",
        "plugins/gcxform_plugins/passes/rtcp/conversion.py",
        "        return self.tolerance\n",
        "        return 0.0 if self.demands.resolves else self.tolerance\n",
        "tests/test_promises.py",
    ),
    Mutation(
        "promises: the tip is left out of the largest",
        "gcxform/pipeline/certify.py",
        "largest[key] + off if proved else",
        "largest[key] if proved else",
        "tests/test_promises.py",
    ),
    Mutation(
        "promises: what is written may be off by all of the budget",
        "gcxform/pipeline/plan.py",
        " - sum(step.promise for step in proved)",
        "",
        "tests/test_promises.py",
    ),
    Mutation(
        "promises: arcs that are not there have room",
        "gcxform/pipeline/plan.py",
        "if arcs and LINEAR_ONLY",
        "if LINEAR_ONLY",
        "tests/test_promises.py",
    ),
)

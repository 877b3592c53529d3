"""Faults of printers: filament, commands, homing."""

from __future__ import annotations

from faults.mutation import Mutation

CASE = "tests/test_corpus.py::test_case[printers/{}]"

MUTATIONS = (
    Mutation(
        "printers: a T that changes the tool is nothing",
        "gcxform/modal/meaning/numbered.py",
        "(rule.t_selects and not rule.t_changes)",
        "not rule.t_changes",
        CASE.format("tool-change"),
    ),
    Mutation(
        "printers: M83 is not heard",
        "gcxform/modal/meaning/sorting.py",
        'if code.group in ("spindle", "extrusion"):',
        'if code.group == "spindle":',
        CASE.format("extrusion-by-distances"),
    ),
    Mutation(
        "printers: filament is written as a position behind M83",
        "gcxform/toolpath/path.py",
        "by = [blocks.extruded if axis == EXTRUDER else blocks.incremental for axis in self.axes]",
        "by = [blocks.incremental for axis in self.axes]",
        CASE.format("extrusion-by-distances"),
    ),
    Mutation(
        "printers: G90 leaves E as M83 made it on all of them",
        "gcxform/modal/columns.py",
        "np.where((last == own) & (own >= distance), own, np.int8(-1))",
        "own",
        CASE.format("g90-and-extrusion"),
    ),
    Mutation(
        "printers: a piece of a move has no command",
        "gcxform/emit/needed_modes.py",
        "changes = moves & ((before != after) | alone)",
        "changes = moves & (before != after)",
        CASE.format("for-a-printer"),
    ),
    Mutation(
        "printers: a second command in a block is taken",
        "gcxform/modal/meaning/too_many.py",
        "for word in commands[1:2] if rule.one_command else ():",
        "for word in ():",
        CASE.format("one-command"),
    ),
    Mutation(
        "printers: a motion code stays in force",
        "gcxform/modal/moves/printers.py",
        'moving & ~track.lines.stated("motion")',
        "moving & False",
        CASE.format("motion-each-block"),
    ),
    Mutation(
        "printers: homing loses the filament",
        "gcxform/modal/moves/home.py",
        "(not words and axis != EXTRUDER)",
        "not words",
        CASE.format("homing"),
    ),
)

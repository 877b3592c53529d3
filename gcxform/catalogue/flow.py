"""Codes of programs that compute, call and repeat: 22x."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
    "GX220": (
        "A parameter whose value is not known",
        "An expression reads a parameter (a variable) that nothing in the program has set before. "
        "It has what another program has left in it, or what the control keeps there; to take it "
        "for zero could move a tool to the wrong place. An axis, a feed, a speed or a tool with "
        "such a value stays as it stands and is not known until it is programmed again; so does "
        "an assignment. What is refused are words on which more depends: of arcs, cycles and "
        "shifts, and branches. Set it in the program, or say what it is worth: `parameters = { "
        '"100" = 1.5 }` in [input], with a name as `"<depth>"`. What the control itself changes '
        "(positions, offsets, probe results) cannot be given.",
    ),
    "GX221": (
        "An expression without a value",
        "The control would stop here: a division by zero, the root of a negative number, a number "
        "that is not whole where one is asked for. Or controls are known to compute this in two "
        "ways, such as the rounding of a half on Fanuc; then write it so that there is one.",
    ),
    "GX223": (
        "Subprograms, loops and jumps that do not fit together",
        "A program with calls, loops or jumps is executed as the control would execute it, to "
        "find the blocks that act, in their order. Here that cannot go on: an end without its "
        "beginning, a label twice, a jump to a number that is not there or into a loop. A control "
        "would stop here, or go on in a way that is not documented.",
    ),
    "GX224": (
        "A program that is not over",
        "The loops or calls of the program go on for more blocks than any part needs, so it is "
        "taken for one that never ends. A loop that waits for an input, or that is left by a "
        "button, cannot be written out as plain blocks.",
    ),
    "GX226": (
        "Only a subprogram, which nothing in this file calls",
        "What is transformed is what the control executes when it runs this file. A subprogram "
        "that nothing in the file calls is not executed, so it would be left as it is, and what it "
        "does depends on who calls it. Transform the program that calls it, for subprograms are "
        "looked up in the files beside it; others are kept as they stand, with those that they "
        "call, and where all is written out behind the end; the certificate says how many. Where a "
        "step turns positions into others (volumetric, rtcp), a file is refused in which nothing "
        "else moves, and so is a second program that moves, in a file of a control that runs "
        "programs by their numbers: it would stay as it is, and the stamp would say otherwise. "
        "Give each program a file of its own. A file that is a subprogram by itself is transformed "
        "from where [entry] says that it is called; what is written leaves its caller what it "
        "left before, which is refused where no block can restore it.",
    ),
    "GX227": (
        "Which file the subprogram is in is not certain",
        "A subprogram that is not in the file is looked up beside it, and in the folders of "
        "`subprograms`, by the names that the control gives to such files. A file is taken if the "
        "number in it is the one that is called, or if there is none in it and its name says so. "
        "Two files that differ, one that holds another number, one that cannot be read and a link "
        "out of its folder are refused: move what is not meant to another folder.",
    ),
    "GX228": (
        "A subprogram by itself, of whose call something is not known",
        "The file is a subprogram that another program calls. What it does depends on the modes "
        "and the positions that its caller leaves, and here something is written that would depend "
        "on them. The file is kept as it stands, which the certificate says too. Say how it is "
        'called: `modes = "G91 G21 G94"`, `start`, `feed` and `parameters` in [entry], which are '
        'also what the call gives (`{ "1" = 5.0 }` for `o<hole> call [5]`), or --entry for the '
        "modes; or transform the program that calls it, which finds it beside itself.",
    ),
}

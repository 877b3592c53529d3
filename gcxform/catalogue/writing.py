"""Codes of writing a program, 5, and of proving it, 6."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
    # --- 5xx: emission ---
    "GX480": (
        "A table does not say all that has to be known",
        "Files of this format leave something out, such as their units, their axis or their sign, "
        "and a wrong guess gives a wrong program. Convert the file once with `gcxform table "
        "convert`, which takes what is missing, and use the native file that it writes.",
    ),
    "GX481": (
        "A format cannot hold the model",
        "The format has no place for a part of the error model, which would be lost without a "
        "word. Choose a format that has one, or fit a simpler model with --kind; the fit says what "
        "it leaves.",
    ),
    "GX482": (
        "Something in a foreign table is not supported",
        "The file has an entry that is not known, or is known and has no meaning in an error model "
        "of three linear axes. Leaving it out would change the errors, so the file is refused.",
    ),
    "GX483": (
        "Values of a table are missing, double or out of place",
        "A height map has one height for every position on X with every position on Y, a "
        "positioning test a deviation at every target in each direction, a table in equal steps a "
        "value at each. Look for what is missing, double, or beside the lines of the grid.",
    ),
    "GX484": (
        "Backlash in a pass that does not know the direction of travel",
        "The error of an axis depends on the direction in which it moved last, and this pass "
        'takes one error for each position. Leave backlash to the control; `backlash = "mean"` '
        "compensates the mean of both directions, and half the backlash is left in each.",
    ),
    "GX485": (
        "Deviations of a size that no machine has",
        "The largest deviation of a measured axis is above 1 mm, or none is above a hundredth of a "
        "micrometre. The unit that was said is probably not that of the file.",
    ),
    "GX486": (
        "Ball centres that are not on a circle",
        "An axis is found from the centres of a ball at three angles or more, and they have to be "
        "different and to go round. A row may have been copied, an axis may not have turned, or "
        "the angles belong to another axis. `gcxform calibrate rotary --help` shows the table.",
    ),
    "GX487": (
        "Positions of a rotary axis that do not determine where it is",
        "On a short arc a shift of the centre looks like a larger radius, and the direction is "
        "hardly seen: the errors of the ball centres would be multiplied. Measure along a longer "
        "arc; what the limits of the axis allow is best.",
    ),
    "GX488": (
        "Ball centres that contradict the machine file",
        "The axis that was measured is not the one of the machine file: it points elsewhere by "
        "more than an error of a machine, or positive angles turn the other way. Look at the "
        "letter, at the sign of the angles and at the file (`gcxform machine jog`); one of them "
        "is wrong, and a wrong sign breaks machines.",
    ),
    "GX489": (
        "Ball centres that do not determine all that is asked for",
        "Some unknowns can change together without any reading changing, and the message names "
        "them. The absolute scale of a machine is never seen by balls alone. Squareness needs "
        "poses of both rotary axes, all around and in combination, and better two balls; without "
        "them leave it out (--linear none).",
    ),
    "GX490": (
        "Circular tests of an axis that turns no table",
        "Circular tests with RTCP on tell of the axes that turn the table, because the ball stands "
        "on it. The table of measurements names an axis that the machine file does not have, or "
        "that turns the head; those of the head are found by `gcxform calibrate bundle`.",
    ),
    "GX491": (
        "No room for the poses of a calibration",
        "Balls are probed at poses inside the limits of all axes, with room for the probe around "
        "the ball and before it, with table and probe not leaning too far, and clear of other "
        "balls. There are not enough of them. Or a head cannot turn safely between them: Z does "
        "not go so high that the tip is above all balls at every angle on the way, or the head may "
        "pass the horizontal. Put the balls elsewhere, allow more tilt, or take a shorter probe; "
        "the limits are those of the machine file.",
    ),
    "GX492": (
        "Touches that are not those of the plan",
        "A log of touches has a line for each, X, Y and Z and then perhaps A, B and C, five at "
        "each pose in the order of the plan: along the probe, and from two opposite sides twice. A "
        "touch is missing or stands twice, or the log belongs to another plan.",
    ),
    "GX501": (
        "The target cannot say this",
        "The control that is written for has no such code, word, comment or plane of arcs, and "
        'there is no other way to say the same in its language. For arcs the pass "plane" or '
        '"segment" makes lines of them. `drop` and `m-codes` in [output] say of M codes what may '
        "go, and what takes the place of what; otherwise the source program has to do without.",
    ),
    "GX502": (
        "The block would be too long",
        "The control reads only so many characters of a block and drops or refuses the rest. "
        'Fewer decimals, the pass "strip" for blanks and comments, or `words = "changed"` in '
        "[output] make blocks shorter.",
    ),
    "GX503": (
        "A number with too many digits",
        "The number has more digits than controls take for a word, because a position is far "
        "away or the decimals are many. Check the units of the program and `decimals` in "
        "[output]. In inverse time (G93) the feed of a long and slow move is very small: cut it.",
    ),
    "GX504": (
        "An arc cannot be written as this control accepts it",
        "After rounding, the start, end and centre of this arc describe another arc, or one "
        "that the control refuses by its own rule: mostly a tiny arc, or one of a very large "
        "radius. Give more decimals in [output], or turn arcs into lines with the pass "
        '"segment".',
    ),
    "GX505": (
        "A block with a NUL byte would have to be written anew",
        "NUL bytes are the leader and trailer of punched tape; within a block that changes "
        "there is no telling what they were for. Remove them from the file.",
    ),
    "GX506": (
        "A block that can only stay as it is would have to change",
        "Canned cycles, returns to reference, moves in machine coordinates and blocks that set "
        "coordinates from where the axes stand are copied as they are, or not at all: what a pass "
        "asks for cannot be said in such a block. G92 and G10 L20 get other words behind moves "
        "that were compensated, if they set the same zero with as many decimals as are written. "
        'Resolve it first: the pass "cycles" writes cycles as plain moves, "offsets" folds shifts '
        "into coordinates; inert-m says that an M code calls no macro with the words beside it. "
        "Taps are written again with their ends moved, if the place, one for top and bottom, is "
        "right for both within what is promised; else give the pass a larger tolerance. G28, G30 "
        "and G53 are written in another unit where it is known where they lead (G53 needs a "
        "machine file with work offsets). The moves of a cycle end exactly: under G64 a LinuxCNC "
        "program gets G61 before them and G64 behind them, or the cycle needs a G61 before it.",
    ),
    "GX507": (
        "The program grows beyond the budget",
        "The output has more blocks for each one read than `growth` in [budget] allows. Nothing "
        "was written. Passes that cut moves make many blocks of one where their tolerance is small "
        "and the move long. Give them a larger tolerance, or allow more: a control with little "
        "memory, or one that reads blocks slowly, sets the limit.",
    ),
    "GX508": (
        "Pieces in inverse time that are too short to write",
        "A pass has cut this block into pieces of which some move no axis by the last decimal. "
        "They would be left out, and the time that each of them takes (G93) would be left out with "
        "them, so the tool would be faster than it was told to be. Write more decimals, give the "
        "pass that cuts moves a larger tolerance or length, or lead the tool farther from the "
        "pole, near which pieces become short.",
    ),
    # --- 6xx: verification ---
    "GX509": (
        "The target loses an axis that the source knows",
        "Some codes move axes on one control and not on another: a tool change, a tool length. "
        "Behind one of them the control that is written for stands where the program does not "
        "say, and a block that names only some axes moves from there. Program all linear axes "
        "between that code and this block, where the way is clear. If the code moves nothing on "
        "that machine, a tool change by hand for one, `inert` in [output] says so. So it is with "
        "a tool length that only one of them lets go of behind G28: say it again; and with one "
        "that moves Z by itself: let Z go there alone behind it.",
    ),
    "GX510": (
        "The path is farther off than the budget",
        "A step that promises no bound, or blocks in which axes that a step has moved are left "
        "out, took the path farther from the program than `deviation` in [budget] allows. "
        "Nothing was written. Allow more, or give the step a tolerance.",
    ),
    "GX601": (
        "The output does not do what the program does",
        "The written text was read again, taken through the models of the machine and compared "
        "with the input, and differs by more than the budget, or in a feed, an event or a kind "
        "of move. Nothing was written. This is a bug of gcxform or of a plugin, and a report "
        "with the program and the pipeline helps.",
    ),
    "GX602": (
        "A pass does not keep what it promises",
        "A pass says that its output has a property, and the path it returned does not have it; or "
        "it measures that it deviates by more than it promises. "
        "Nothing was written. This is a bug of the pass: report it to the author of the plugin, "
        "see `gcxform list passes`.",
    ),
    "GX603": (
        "A pass on text changed the meaning of a block",
        "A pass that may change comments, blanks and block numbers only has changed a word. "
        "Nothing was written. This is a bug of the pass: report it to the author of the plugin, "
        "see `gcxform list passes`.",
    ),
}

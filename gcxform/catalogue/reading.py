"""Codes of reading a program: 1 its text, 2 its meaning."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
    # --- 1xx: text ---
    "GX101": (
        "Not a block of this dialect",
        "The grammar of the dialect does not accept the block at the place shown: a character "
        "without meaning there, a word without its number, or a comment that is not closed. A "
        "control would stop here, or read something else than was meant. Correct the block, or "
        "name the right dialect with -f or `dialect` in [input].",
    ),
    "GX102": (
        "A line ends with CR alone",
        "Some controls end a block at CR, others read CR as a blank and take the next line as "
        "part of the same block. A program with such line ends would mean two different things. "
        "Convert the line ends of the file to LF or CRLF.",
    ),
    # --- 2xx: meaning ---
    "GX201": (
        "The dialect has no such code or word",
        "The G code, M code or address letter is not one that the control of this dialect "
        "knows, so nothing is known of its effect. It is refused because an unknown code may "
        "move an axis or change where one goes. Check the dialect first: `gcxform info FILE` says "
        "which ones have all codes of a program, and `-f linuxcnc -t grbl` reads it as written for "
        "one control and writes it for another, with the ways that there are for what this one "
        "lacks. If the code is a macro of your machine, [control.macro] of the machine file "
        "declares it where the control has macros; else a dialect plugin adds it to the codes.",
    ),
    "GX202": (
        "Two codes of one modal group in a block",
        "Codes of one group exclude each other, such as G0 and G1, and the control of this "
        "dialect refuses a block with two of them. Leave the one in the block that is meant.",
    ),
    "GX203": (
        "A word that belongs to nothing",
        "A word stands in a block twice, or no code of the block takes it: I, J, K or R without "
        "an arc, P without a dwell. Controls differ in whether they ignore such words, keep them "
        "for later, or stop, so there is no one meaning to keep. Correct the block: which of two "
        "words is meant, and to which code one belongs, the program does not say.",
    ),
    "GX204": (
        "A feed or a time is missing",
        "A feed move stands where no feed is in force, or a dwell has no time. The feed before "
        "the first F word is what the control happened to hold, and in G93 every feed block "
        "needs its own F. Write the word, or say `feed` in [input] if the control starts with a "
        "feed that you know. LinuxCNC refuses a feed per turn as well before an S word.",
    ),
    "GX205": (
        "A number without a decimal point",
        "On this control a distance without a point counts in its least increment or in units, as "
        "a setting has it: X10 is 10 micrometres or 10 mm. The program does not say which, and a "
        'guess is wrong by a factor of a thousand. Say `increment = "IS-B"` in [input] (0.001 mm '
        "in G21, 0.0001 inch in G20, 0.001 deg; IS-A, IS-C, IS-D and IS-E are known as well), or "
        '`increment = "calculator"` where 1 is 1 mm, 1 inch, 1 deg; a length such as "1 um" is '
        "that length whatever unit is in force, and says nothing of angles. 0 needs neither. What "
        'is computed is rounded to the increment: "calculator IS-B" says both. A feed without a '
        "point is refused where settings of the control decide on its unit: write the point, or "
        "say `feed-increment` in [input].",
    ),
    "GX206": (
        "Code that would have to be run",
        "The block has a flow word, a call, a code that is the value of an expression, or an "
        "assignment to a parameter of the control. Assignments and expressions in programs that "
        "run from top to bottom are computed; this is not. Let the CAM system write plain blocks, "
        "or run the program through the control's own simulation first; the empty pipeline and "
        "passes on text keep such blocks as they are.",
    ),
    "GX207": (
        "An incremental move from an unknown position",
        "In G91 a word adds to where the axis stands, and nothing has said where that is: at "
        "the start of a program, after a change of the work offset, or after a code that moves "
        "axes by itself. Such a block stays as it is, in G91, where it may: not under cutter "
        "compensation, in another dialect, or for a pass that needs to know where axes stand. "
        "Program the axis in G90 first, or give the position at the start: "
        "`start = { X = 0.0 }` in [input], or --start X=0.",
    ),
    "GX208": (
        "An arc or a spline from an unknown position",
        "The circle of an arc follows from its start, its end and its centre, and here the "
        "start or the end is not known in the plane of the arc, or of a spline. Program both "
        "axes of the plane before, or give the position at the start: "
        "`start = { X = 0.0, Y = 0.0 }` in [input], or --start.",
    ),
    "GX209": (
        "Axis words without a motion code",
        "The block names axes while no G0, G1, G2 or G3 is in force: at the start of a program, "
        "or after G80. What a control does here depends on its parameters or is an error. Write "
        "the motion code in the block.",
    ),
    "GX210": (
        "A code that is not resolved",
        "The code moves axes or shifts coordinates in a way which the program alone does not "
        "tell: a canned cycle, a return to reference, tool length or radius compensation, an "
        "offset in the control, a subprogram. A pass that needs positions would work on wrong "
        "ones. Let the CAM system write plain moves for the part that is transformed, or leave "
        "such programs to pipelines that change text only. Of a code with which the control "
        "follows the tip (G43.4, G43.5, G234) `rtcp` does the work, if `tip-codes` says so; for "
        "positions of axes there is nothing to follow.",
    ),
    "GX211": (
        "Block delete depends on a switch",
        "A block that begins with a slash is executed or skipped by a switch on the control "
        "panel. The path after it depends on that switch, and one output cannot be right for "
        "both positions. A block that does nothing but switch, stop or wait stays as it is. Of "
        'others say which it is: `block-delete = "execute"` or `"skip"` in [input], or '
        "--block-delete.",
    ),
    "GX212": (
        "A pass on text cannot edit this program",
        "The pass changes only text, but in this block its edit would change what the program "
        "does: renumbering a program whose jumps name block numbers, for instance. Leave the "
        "pass out for such programs.",
    ),
    "GX213": (
        "Something in this block is not followed",
        "The code is known, but not in this form or not in this state: a word is missing, controls "
        "differ in what they do here, or the position it counts from is not known. The message "
        "says which.",
    ),
    "GX214": (
        "A setting of the control decides",
        "What the code does depends on a parameter or setting of the control which the program "
        "does not tell. Give it in [control] of the machine file.",
    ),
    "GX215": (
        "A canned cycle is not expanded",
        "What the cycle does cannot be told: a word is missing or cannot be, a level is not known, "
        "the control refuses it, or a setting of the control decides. The message says which. "
        "Settings go to [control] of the machine file: peck-return for G73, peck-clearance for "
        "G83, cycle-without-place for blocks that name no place, cycle-levels for R and Z behind a "
        "G91, cycle-repeats for L in the place of K.",
    ),
    "GX216": (
        "A thread, a tap or a probe that the control refuses",
        "G33 and G33.1 need a turning spindle, an axis word and K, and take no F; G76 needs one, "
        "Z, P, I, J and K, and a place to begin at; a probing move needs a target and a feed per "
        "minute. The message says what is missing.",
    ),
    "GX219": (
        "A line or a number beyond what the control takes",
        "The block is longer than the control reads, or has a number that its word cannot have: a "
        "negative speed, tool, time or feed, a sequence number too large. Controls stop here, or "
        "drop the block and go on with the next. Shorten the block, or correct the number.",
    ),
    "GX222": (
        "The program has no end that the control takes",
        "LinuxCNC refuses a file that neither ends with M2 or M30 nor stands between two percent "
        "signs, and a percent sign at the end alone. `gcxform check` says so; a piece of a program "
        "can be read and written all the same.",
    ),
    "GX229": (
        "A way home that leads down first",
        "G28 under G90 goes to the point that its words name, in the coordinates of the part, and "
        "from there home: `G90 G28 Z0` drives the tool to Z0 of the part. The program is read and "
        "written as it says; this is a warning. `G91 G28 Z0` goes home from where the tool "
        "stands.",
    ),
    "GX230": (
        "Cutter compensation that the control refuses",
        "G41, G42 or G40 stands where the control stops with an alarm, or a code stands between "
        "them that it does not take there: another plane, work offset or tool, for instance; or D "
        "says nothing. Lead the tool off the contour and cancel compensation with G40 before such "
        "blocks, and begin and end it with a straight move.",
    ),
    "GX231": (
        "The radius of the tool is not known",
        "The pass computes the path of the tool's centre, and for that it needs the radius of the "
        "tool that G41 or G42 names. Programs give a number; the radius is in the tool table of "
        "the control. Give a machine file with the tool: `[tool.1]` and `radius = 5.0`.",
    ),
    "GX232": (
        "Cutter compensation that cannot be resolved",
        "Between G41 or G42 and G40 the program does what depends on the control, or what leaves "
        "open where the tool is: another side or tool without G40 between, an unknown position, "
        "or an end without G40. Lead the tool off the contour and cancel compensation before such "
        "blocks.",
    ),
    "GX233": (
        "A contour under cutter compensation would be moved",
        "In G41 and G42 the blocks are a contour, which the control offsets by the tool's radius. "
        "Points of it that are moved for another reason would be offset as well, and what begins "
        "and ends it must stay whole. Put the pass `cutter-comp` before, which makes it the path "
        "of the centre; `volumetric` does so if [control] has `cutter-comp-corners` and `-entry`.",
    ),
    "GX234": (
        "A program for a lathe",
        "A block has what only lathes of this control have: G50 or G92 with S, which limits the "
        "spindle; G70 to G76 with U, W or P and Q, which repeat a contour; U or W as a step. On "
        "a lathe X is a diameter, and G90, G92 and G94 may be cycles, so that all the rest would "
        "be misread too. Programs for lathes of this kind are not read.",
    ),
    "GX235": (
        "In which unit the program begins is not known",
        "On this control a setting says whether programs begin in millimetres or in inches, and "
        "this one has lengths before G20 or G21. Where its words stay, that is all the same. For "
        "another control, and with G21 at its head, a guess would make the part 25.4 times as "
        "large or as small: refused. Where an error is taken off positions, or moves are cut, they "
        'are taken for mm, with a warning. Say `units = "mm"` or `units = "in"` in [input], or '
        "write G21 or G20 at the beginning.",
    ),
    "GX236": (
        "A program that may be for a lathe",
        "It has X and Z and no Y, and tools of four digits without M6, or G99, a feed per turn on "
        "lathes. There X is a diameter. Such programs are not read: it is taken for one of a mill.",
    ),
    "GX240": (
        "A program that has been turned into commands already",
        "A comment in the program says that a run has turned its positions into others: into "
        "commands compensated for a machine's errors, or from tips to axes. The chain takes them "
        "for what they were before, and would do the same twice, or to the wrong positions. Take "
        "the program as it was posted. Where the comment is wrong, `--again`, or `again = true` "
        "in [input], runs the chain all the same, and the certificate says so.",
    ),
    "GX241": (
        "A program on which this pipeline has run",
        "The stamp in the program is that of this very pipeline, with the same options, models and "
        "machine, and nothing has been edited since. Nothing is left to be done: `post` leaves the "
        "file as it is and exits with 0; `run` writes nothing. `--again` runs it once more.",
    ),
    "GX242": (
        "A stamped program that has been edited",
        "The seal near the end of a stamped program is a digest of its lines. They are others "
        "now, or some are gone, or the seal itself is. What the stamp says may hold no longer, and "
        "nobody has proved the program as it is. This is a warning where no step depends on what "
        "positions are; otherwise the program is refused (GX240).",
    ),
}

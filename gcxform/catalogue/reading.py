"""Codes of reading a program: 1 its text, 2 its meaning, 3 its geometry."""

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
        "feed that you know.",
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
        "G83, cycle-without-place for blocks that name no place.",
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
        "Points of it that are moved for another reason would be offset as well, and the moves "
        "that begin and end compensation must stay whole. Put the pass `cutter-comp` before: then "
        "there is the path of the centre, and no compensation in the control.",
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
    # --- 3xx: geometry ---
    "GX301": (
        "The end of an arc is off its circle",
        "The distances from the centre to the start and to the end of the arc differ by more "
        "than the control of this dialect accepts, so that it would stop, or cut a spiral "
        "nobody drew. Often I, J, K were written absolute where the control reads them from the "
        "start, or the reverse; or the post-processor gives too few decimals. Correct the "
        "post-processor.",
    ),
    "GX302": (
        "A radius that makes no arc",
        "R is less than half of the way from start to end, so that no circle goes through both; "
        "or start and end are one point, where R leaves the centre open. Give the centre by I, "
        "J, K.",
    ),
    "GX303": (
        "An arc without what makes it one",
        "The arc has neither a centre nor a radius, only half of an absolute centre, or none of "
        "the axis words that this control asks for. Some controls cut a straight line here and "
        "others stop. Write I, J, K or R in the block.",
    ),
    "GX304": (
        "Words of an arc that contradict each other",
        "The arc has both a centre and a radius, or a centre word that is not in its plane. "
        "Controls differ in which of the words they follow. Keep the one that is meant, or select "
        "the plane that was meant with G17, G18 or G19.",
    ),
    "GX305": (
        "The number of turns is not a positive whole number",
        "In this dialect P counts the turns of an arc, the arc itself included. Zero, negative "
        "and broken numbers have no meaning there. Correct the word, or leave it out for less "
        "than a full turn.",
    ),
    "GX306": (
        "A spline that the control refuses, or that is not certain",
        "G5 takes X and Y (at least one), P and Q, and I and J, which may be left out directly "
        "behind another G5; G5.1 takes X and Y, I and J. LinuxCNC refuses other words and other "
        "planes than G17. In G93 it does not time splines, and a series that is interrupted goes "
        "on from the last G5 that it met: both are refused here. Between G5.2 and G5.3 stand "
        "control points alone, in G90: X, Y and the weight P. Correct the block.",
    ),
    "GX309": (
        "The compensated position does not converge",
        "Compensation looks for the command which, together with the error of the machine there, "
        "gives the programmed position; it did not settle. The error model jumps at that place, as "
        'it does at the border of a table with `outside = "zero"`. Choose another policy, or keep '
        "the program away from the border.",
    ),
    "GX310": (
        "Outside the error table",
        "A position lies beyond the range in which the errors of the machine were measured, or "
        "farther beyond it than may be extrapolated. What the error is there is not known. "
        "Check part-origin and table-origin first; otherwise measure a larger volume, or choose "
        '`outside = "clamp"`, `"extrapolate"` or `"zero"` knowing what it means.',
    ),
    "GX311": (
        "The error depends on an axis whose position is not known",
        "The errors of a machine depend on all of its linear axes, and here one of them has not "
        "been programmed yet. Program the axis before the first compensated move, or give its "
        "position at the start: `start = { Z = 100.0 }` in [input], or --start Z=100.",
    ),
    "GX313": (
        "A correction larger than allowed",
        "The compensation would move a point by more than max-correction. Errors of machine "
        "tools are tenths of a millimetre at most, so a larger one mostly means a table in "
        "micrometres read as millimetres, a wrong sign, or a wrong origin. If the values are "
        "right, raise `max-correction`.",
    ),
    "GX314": (
        "Work offsets that are not known",
        "The program changes its work offset and the pass was told only one origin, or the "
        "machine file lacks the offset. The error depends on where the part is in the machine. "
        "Give a machine file with [work-offset.G54] and the others that are used, in place of "
        "part-origin. With a turned head, an error model with angular errors depends on where the "
        "tip is on it as well: on the points of the rotary axes, their angles and the tool.",
    ),
    "GX315": (
        "The tolerance needs shorter pieces than allowed",
        "A move has to be cut so that the machine stays within the tolerance, and some piece would "
        "be shorter than `min-length`. Neither is given up silently. Give a larger tolerance, or "
        "a smaller `min-length`.",
    ),
    "GX316": (
        "A turn whose feed a correction would change",
        "With angular errors the tip is moved while the head turns, and behind a point of the "
        "machine (G53) a correction sets in: it makes the linear axes move, by micrometres. A "
        "control that measures the feed along them would then turn the axis in no time. Write such "
        "moves in inverse time (G93): `rtcp` does, and the pass `feed` before this one.",
    ),
    "GX317": (
        "A feed move that begins or ends where nothing is compensated",
        "A machine errs everywhere: also at the points of the machine that G53 and G28 lead to, "
        "and where it stands before the program. Rapids there are written as they stand, and the "
        "certificate says how far off the machine is. A feed move that began or ended there would "
        "be cut from a wrong place, slanting. Lead a rapid that names X, Y and Z to its "
        "beginning, if the way there is clear: rapids to program positions are compensated.",
    ),
    "GX320": (
        "A feed that cannot be converted",
        "Between G93 and G94 a feed is converted by the length of its move, as the control "
        "measures it. Here that length is not known, or controls do not agree about it, or the "
        "speed is not the program's: G95 depends on the spindle. Let the CAM write this part in "
        "the feed mode that is wanted, or leave the pass out. A feed per minute of X, Y or Z "
        "together with rotary axes is such a feed by itself: LinuxCNC counts it along X Y Z, "
        "others add up millimetres and degrees, or inches and degrees. So it is not taken to "
        "another control, nor, where it may be such a sum, from inches to millimetres; in inverse "
        "time (G93) it can be.",
    ),
    "GX321": (
        "The program has no end at which its feed mode could be restored",
        "The pass feed leaves the control in the feed mode in which the source program leaves it, "
        "and states that mode in the block with M2 or M30. This program has none, and what runs "
        "after it would find another feed mode. End the program with M2 or M30.",
    ),
    "GX330": (
        "A move that is not converted between tip and axes",
        "What is converted are plain lines in one work offset, taken with all rotary axes at 0, "
        "with tool lengths that are known and do not change while axes are turned. Moves to "
        "machine coordinates, rapids that turn axes and axes that the machine file does not have "
        "are refused, because where the tip goes is not known. So are axes that are turned while "
        "it is not known whether the control follows the tip; and on great circles, while it does "
        "not, or where it is switched.",
    ),
    "GX331": (
        "An axis would go beyond its limits",
        "Where the tip shall be, the axes of the machine do not reach. Place the part elsewhere, "
        "take another tool, or let the CAM choose other angles.",
    ),
    "GX332": (
        "A tool axis that the machine cannot reach",
        "No angles of the machine's rotary axes give the tool this direction on the workpiece. "
        "Place the part otherwise, or let the CAM lean the tool less.",
    ),
    "GX333": (
        "The tool axis comes too near to the pole",
        "Where the tool axis lies along the first rotary axis, that axis has no angle of its own; "
        "beside it a small lean of the tool is a long turn. Inside a cut it would have to leap. "
        "Lead the tool through the pole or farther beside it, or lift it off and turn the axis. "
        "With `retract`, `retarget` draws the tool back exactly at the pole, and turns the axis.",
    ),
    "GX334": (
        "The tool axis comes to the border of reach",
        "At the end of what the axes reach both attitudes are one, and behind it there is none; "
        "near it a small lean of the tool is a long turn. Let the CAM stay inside.",
    ),
    "GX335": (
        "The axes would have to flip over inside a cut",
        "The limits of the rotary axes leave no way along this cut, whatever attitude and turn it "
        "begins with. Lift the tool off where it is said, and begin another cut there; or "
        "turn the part on the table; or let `retarget` draw the tool back there and turn the axes "
        "(`retract`).",
    ),
    "GX336": (
        "A tool vector that is not read",
        "Under G43.5 I, J and K of a line in G0 or G1 are the tool axis at its end, from the tip "
        "to the holder, on the workpiece with all rotary axes at 0. A vector needs a length; arcs, "
        "cycles, cutter compensation, words of rotary axes and moves to the machine's own points "
        "have no place beside it. The block of G43.5 itself only adds the tool length.",
    ),
    "GX350": (
        "A contour that the tool cannot follow",
        "The tool is too large for an inside corner, a concave arc or a move between two inside "
        "corners, so that it would cut into the contour; or the move that begins compensation is "
        "not longer than the tool's radius. Use a smaller tool, or change the contour. LinuxCNC "
        "stops at most of these and cuts into the contour at some.",
    ),
    "GX351": (
        "A rounded contour leads the tool elsewhere",
        "Under G41 and G42 the control offsets the contour that it reads. To round a point of it "
        "moves its centre by more: beside an arc in the measure of both radii, and by the slant of "
        "a corner; or the tool no longer fits. Write more decimals, or put `cutter-comp` before.",
    ),
}

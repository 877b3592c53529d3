"""Codes of the geometry of a program."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
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
        "gives the programmed position; it did not settle. Or a move leads over a place at which "
        "the error jumps by more than the tolerance. The error model jumps at that place, as "
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
    "GX318": (
        "A hole that is called as it stands, and leans",
        "The control bores it by itself, from where a corrected move has led the tool. On the way "
        "down the error of the machine changes, so that the ground would be beside where it should "
        "be by more than `lean` allows (10 um if absent). Allow more, or let the CAM write the "
        "hole as plain moves, which are corrected all the way.",
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

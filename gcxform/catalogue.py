"""Every diagnostic code with its explanation: what `gcxform explain GX301` prints.

Codes are never reused. The hundreds say where a thing was found: 1 text, 2 meaning, 3 geometry,
4 machine and error-model files, 5 emission, 6 verification, 7 command line and pipeline,
8 plugins, 9 files.
"""

from __future__ import annotations

CATALOGUE: dict[str, tuple[str, str]] = {
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
        "move an axis or change where one goes. Check the dialect first; if the code is a macro "
        "of your machine, a dialect plugin can add it to the table of codes.",
    ),
    "GX202": (
        "Two codes of one modal group in a block",
        "Codes of one group exclude each other, such as G0 and G1, and the control of this "
        "dialect refuses a block with two of them. Leave the one in the block that is meant.",
    ),
    "GX203": (
        "A word that belongs to nothing",
        "A word stands in a block twice, or no code of the block takes it: I, J, K or R without "
        "an arc, P without a dwell. Controls differ in whether they ignore such words, keep "
        "them for later, or stop, so there is no one meaning to keep. Remove the word, or write "
        "the code that it belongs to.",
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
        "On this control a distance without a point counts in its least increment, so that X10 "
        "may be 10 mm or 10 micrometres. The program does not say which, and a guess is wrong "
        'by a factor of a thousand. Say `increment = "0.001 mm"` in [input], or --increment; 0 '
        "needs neither. A feed without a point is refused where settings of the control decide "
        "on its unit: write the point, or on a Haas say `feed-increment` in [input].",
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
        "axes by itself. Program the axis in G90 first, or give the position at the start: "
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
        "ones. Let the CAM system write plain moves, end the mode before the part that is "
        "transformed, or leave such programs to pipelines that change text only.",
    ),
    "GX211": (
        "Block delete depends on a switch",
        "A block that begins with a slash is executed or skipped by a switch on the control "
        "panel. The path after it depends on that switch, and one output cannot be right for "
        'both positions. Say which it is: `block-delete = "execute"` or `"skip"` in [input], or '
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
        "G33 and G33.1 need a turning spindle, an axis word and K, and take no F; a probing move "
        "needs a target and a feed per minute. The message says what is missing.",
    ),
    "GX219": (
        "A line or a number beyond what the control takes",
        "The block is longer than the control reads, or has a number that its word cannot have: a "
        "negative speed, tool, time or feed, a sequence number too large. Controls stop here, or "
        "drop the block and go on with the next. Shorten the block, or correct the number.",
    ),
    "GX220": (
        "A parameter whose value is not known",
        "An expression reads a parameter (a variable) that nothing in the program has set before. "
        "It has what another program has left in it, or what the control keeps there; to take it "
        "for zero could move a tool to the wrong place. Set it in the program, or say what it is "
        'worth: `parameters = { "100" = 1.5 }` in [input], with a name as `"<depth>"`. What '
        "the control itself changes (positions, offsets, probe results) cannot be given.",
    ),
    "GX221": (
        "An expression without a value",
        "The control would stop here: a division by zero, the root of a negative number, a number "
        "that is not whole where one is asked for. Or controls are known to compute this in two "
        "ways, such as the rounding of a half on Fanuc; then write it so that there is one.",
    ),
    "GX222": (
        "The program has no end that the control takes",
        "LinuxCNC refuses a file that neither ends with M2 or M30 nor stands between two percent "
        "signs, and a percent sign at the end alone. `gcxform check` says so; a piece of a program "
        "can be read and written all the same.",
    ),
    "GX230": (
        "Cutter compensation that the control refuses",
        "G41, G42 or G40 stands where the control stops with an alarm, or a code stands between "
        "them that it does not take there: another plane, work offset or tool, for instance; or "
        "D says nothing. Cancel compensation with G40 before such blocks, and begin and end it "
        "with a straight move.",
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
        "or an end without G40. Cancel compensation before such blocks.",
    ),
    "GX233": (
        "A contour under cutter compensation would be moved",
        "In G41 and G42 the blocks are a contour, which the control offsets by the tool's radius. "
        "Points of it that are moved for another reason would be offset as well, and the moves "
        "that begin and end compensation must stay whole. Put the pass `cutter-comp` before: then "
        "there is the path of the centre, and no compensation in the control.",
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
        "Controls differ in which of the words they follow. Remove one of them, or select the "
        "plane that was meant with G17, G18 or G19.",
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
        "on from the last G5 that it met: both are refused here. Correct the block.",
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
        "part-origin.",
    ),
    "GX315": (
        "The tolerance needs shorter pieces than allowed",
        "A move has to be cut so that the machine stays within the tolerance, and some piece would "
        "be shorter than `min-length`. Neither is given up silently. Give a larger tolerance, or "
        "a smaller `min-length`.",
    ),
    "GX320": (
        "A feed that cannot be converted",
        "Between G93 and G94 a feed is converted by the length of its move, as the control "
        "measures it. Here that length is not known, or controls do not agree about it, or the "
        "speed is not the program's: G95 depends on the spindle. Let the CAM write this part in "
        "the feed mode that is wanted, or leave the pass out.",
    ),
    "GX321": (
        "The program has no end at which its feed mode could be restored",
        "The pass feed leaves the control in the feed mode in which the source program leaves it, "
        "and states that mode in the block with M2 or M30. This program has none, and what runs "
        "after it would find another feed mode. End the program with M2 or M30.",
    ),
    "GX330": (
        "A move that is not converted between tip and axes",
        "`rtcp` converts plain lines in one work offset that is taken with all rotary axes at 0, "
        "with tool lengths that are known and do not change while axes are turned. Moves to "
        "machine coordinates, rapids that turn axes and axes that the machine file does not have "
        "are refused, because where the tip goes is not known.",
    ),
    "GX331": (
        "An axis would go beyond its limits",
        "Where the tip shall be, the axes of the machine do not reach. Place the part elsewhere, "
        "take another tool, or let the CAM choose other angles.",
    ),
    "GX350": (
        "A contour that the tool cannot follow",
        "The tool is too large for an inside corner, a concave arc or a move between two inside "
        "corners, so that it would cut into the contour; or the move that begins compensation is "
        "not longer than the tool's radius. Use a smaller tool, or change the contour. LinuxCNC "
        "stops at most of these and cuts into the contour at some.",
    ),
    # --- 4xx: machine and error-model files ---
    "GX401": (
        "A configuration file cannot be read",
        "A machine or error-model file does not exist, is a directory or may not be read. Relative "
        "paths are relative to the file that names them; correct the path or the permissions.",
    ),
    "GX402": (
        "A configuration file is not TOML",
        "The text breaks the syntax of TOML at the place shown, or is not encoded as UTF-8. "
        "Strings stand in quotes, lists in brackets, decimals are set off by a point.",
    ),
    "GX403": (
        "Unknown key",
        "The table has a key which means nothing there; a misspelt key would otherwise be ignored "
        "without a word. Take the name that is proposed, or remove the key.",
    ),
    "GX404": (
        "A key is missing",
        "The key has no default, because a wrong guess gives a wrong program. Add it.",
    ),
    "GX405": (
        "A value is of the wrong type",
        "A key holds a value of another type than it takes, or a word which is not one of its "
        "choices. Write the value as the message says: numbers without quotes.",
    ),
    "GX406": (
        "Unknown version of the file format",
        "The key `format` names a version which this release does not read. Use a newer release, "
        "or write the file in the version named.",
    ),
    "GX407": (
        "Unknown kind of error model",
        "The key `kind` names a model which this release does not have. Convert the errors to one "
        "of the kinds named.",
    ),
    "GX408": (
        "Positions are not sorted",
        "The positions of a table have to rise. If the table was measured from the far end, turn "
        "the rows around; otherwise look for a slip in the position shown.",
    ),
    "GX409": (
        "A position stands twice",
        "Two rows of a table are for the same position, so the error there is not one value. "
        "Average repeated measurements before they become a table.",
    ),
    "GX410": (
        "Lists of different lengths",
        "Every function of a table needs one value for each position. Look for a value that was "
        "lost or entered twice.",
    ),
    "GX411": (
        "A table has fewer than two rows",
        "Between the positions of a table the error is interpolated, so there must be two at "
        "least. For a constant error give the ends of the travel.",
    ),
    "GX412": (
        "A value is not finite",
        "A table holds nan or inf, often the trace of a missing measurement. Measure it again, or "
        "leave the row out so that the error is interpolated.",
    ),
    "GX413": (
        "Errors of the carriages without the place of the frame",
        'With `convention = "carriage"` the errors are motions of each carriage, and their sign at '
        "the tool depends on which axes carry the workpiece. Put F for the frame into `order`: "
        '`order = "XYFZ"` where X and Y move the table and Z the spindle. Or give the errors of '
        'the tool relative to the workpiece and write `convention = "relative"`.',
    ),
    "GX414": (
        "Angular errors without their lever",
        "The file has roll, pitch or yaw (EA., EB., EC.) which is not zero. Their effect at the "
        "tool grows with the travel of the axes nearer to the tool, so these need a table, and "
        "with the tool, so `tool` has to say which point was measured.",
    ),
    "GX415": (
        "The error changes too fast with the position",
        "A machine tool is wrong by some 0.1 mm per metre; this model changes by 0.1 mm per mm or "
        "more, and compensating it may not converge. Look for values in micrometres or inches, "
        "squareness in degrees, or two positions nearly the same.",
    ),
    "GX416": (
        "No format fits the error-model file",
        "Files ending in .toml are the native form; others are offered to the formats of the "
        "installed plugins, and none of them knows this one. Rename the file to what its format "
        "expects, or install the plugin for it.",
    ),
    "GX417": (
        "Wrong header of a text table",
        "The first line of a text table names its columns, and they have to be those of its axis, "
        "each once. Correct the header; its order is free.",
    ),
    "GX418": (
        "A row of a text table has too many or too few columns",
        "Every row needs one number for each column of the header. Write 0 where there is no "
        "error; do not leave the place empty.",
    ),
    "GX419": (
        "Not a number in a text table",
        "A word in a row of a text table is not a decimal number. Decimals are set off by a point "
        "and thousands are not grouped.",
    ),
    "GX420": (
        "Squareness which cannot be used",
        "Squareness is folded into the table of the axis which is out of square, so that table "
        "has to be there; and its sign is not certain in a file of corrections. Give the table, "
        'or the negated tables with `values = "error"`.',
    ),
    "GX421": (
        "Wrong order of the axes",
        "`order` names X, Y and Z, each once, in the order in which the machine stacks them from "
        "the workpiece to the tool.",
    ),
    "GX422": (
        "An error model without tables",
        "The file has none of the tables of its axes, so it would compensate nothing. Add them, "
        "or leave the compensation out of the pipeline.",
    ),
    "GX424": (
        "Models that cannot be added",
        "The files of a sum name each other, were measured at different points of the tool, or "
        "have no travel in common.",
    ),
    "GX425": (
        "The thermal error is above its limit",
        "Somewhere along the travel the axis is farther off than `limit`. It is never cut off: "
        "half a compensation is a wrong program. Let the machine cool down, look for a wrong "
        "sensor, or raise `limit` if the machine really is so far off.",
    ),
    "GX426": (
        "No state of the machine for this time",
        "The readings have no row at or shortly before the time that is asked for, the time is "
        "written with an offset from UTC and the readings are not, or the model has no "
        "temperatures at all. `max-age` is how old (s) the readings may be.",
    ),
    "GX427": (
        "A sensor without a usable reading",
        "A sensor is not in the file of readings, or has no reading at the time that is used, or "
        "one outside of `sensor-range`. A guess would move the tool, so nothing is put in its "
        "place: choose another time, or leave the sensor out of the model.",
    ),
    "GX428": (
        "The sensors do not reach along the travel",
        "The error at a place is the growth of the rod up to there, so the temperature has to be "
        "known along all of it. Name the nearest sensor a second time at the end of the rod if it "
        "is as warm there; otherwise the travel is shorter.",
    ),
    "GX429": (
        "A thermal model that contradicts itself",
        "A number is out of its range: stiffness, expansion and ages are above 0, and ranges "
        "ascend. Or an axis has not just one of a screw and a scale.",
    ),
    "GX431": (
        "The limits of an axis do not ascend",
        "`limits` is the lower end of the travel and then the upper one, in mm or degrees. "
        "Exchange them, or correct the one that is wrong.",
    ),
    "GX432": (
        "The direction of an axis is missing or zero",
        "A rotary axis turns about a line in space, and `direction` is a vector along that line "
        "in machine coordinates, such as [1.0, 0.0, 0.0] for an A axis. Its length is free.",
    ),
    "GX433": (
        "The sign of an axis is missing or not one",
        "`sign` says whether a positive command turns right-handed about the direction (+1) or "
        "left-handed (-1). By ISO 841 it is +1 for an axis in the head and -1 for one in the "
        "table, but controls are set otherwise, and a guess would turn the part the wrong way. "
        "Try it on the machine and write what you saw.",
    ),
    "GX434": (
        "A number of a machine file is out of its range",
        "Speeds and moduli are above 0, and radii are not negative. Correct the number; leave the "
        "key out if it is not known.",
    ),
    "GX435": (
        "A chain of rotary axes does not fit the axes",
        "`table` and `head` list the rotary axes from the base to the workpiece and to the "
        "spindle; each must have its table [axis.A], [axis.B] or [axis.C], and stand once.",
    ),
    "GX436": (
        "Unknown work offset or home position",
        "Work offsets are called by their codes, G54 to G59, and further ones such as "
        '"G59.1" or "G54.1 P1". A name with a point stands in quotes: [work-offset."G59.1"]. Home '
        "positions are those of G28 and G30.",
    ),
    "GX437": (
        "Not a tool number",
        "The tables of tools are called by whole numbers, [tool.1] for T1, each once.",
    ),
    "GX438": (
        "Not a line of a tool table",
        "A line of a LinuxCNC tool table has a tool number (T1) once in the file, and words with a "
        "number each: P, X, Y, Z, D; I, J and Q are passed over, and offsets of other axes have to "
        "be 0. What follows a semicolon is a comment.",
    ),
    "GX450": (
        "Unknown kinematics",
        "A machine file may name the kind of its kinematics, `gcxform list kinematics` lists them. "
        "A machine of no kind is described without: by `table`, `head` and its axes.",
    ),
    "GX451": (
        "A machine file contradicts its kinematics",
        "`kinematics` says which rotary axes there are, on which side, and about which way they "
        "point. The file may give calibrated directions, signs, points and limits; other axes make "
        "another machine. Name another kind, or describe the machine without one.",
    ),
    "GX452": (
        "An axis cannot be followed",
        "For positions of the tool on the workpiece every rotary axis stands in `table` or `head` "
        "and has a point on its line; X, Y and Z run along the machine's coordinates, and U, V and "
        "W stand still. Squareness of linear axes belongs into the error model.",
    ),
    "GX453": (
        "These axes do not give the tool axis angles",
        "Angles are found for machines with up to two rotary axes, none of which is parallel to "
        "the next on the way from the workpiece to the tool, or to the tool itself. For other "
        "machines programs have to give the angles.",
    ),
    "GX454": (
        "Parameters of a control that are not taken over",
        "The kinematics of LinuxCNC are read from HAL files, those of FANUC from the parameters "
        "19666 and 19680 to 19714, those of Siemens from $TC_CARR or $MC_TRAFO5. Where more "
        "decides where the axes are, write the machine file by hand, and try it: `gcxform machine "
        "jog`.",
    ),
    "GX470": (
        "Not a table of measurements",
        "A file of measurements has a header that names its columns, with a unit in brackets where "
        "there is one, and rows below: `gcxform calibrate diagonal --help` shows it. A column is "
        "missing, stands twice, means nothing, or has no unit that is known. Units are never "
        "guessed, because micrometres look like millimetres.",
    ),
    "GX471": (
        "A reading that is not a number",
        "A cell of a table of measurements is empty or not a finite decimal number, or a row has "
        "too many or too few cells. Decimals are set off by a point, and cells by commas. Where a "
        "reading was lost leave the whole run out, or measure it again.",
    ),
    "GX472": (
        "Stops that are not those of a diagonal",
        "Along a body diagonal the machine steps X, Y, Z in turn, each axis always by its own "
        "step and in the sense of the name of the diagonal: npp goes down in X. On the way back "
        "it is Z, Y, X, and direction is a minus sign. A missing or doubled row shows as a move "
        "of the wrong axis, in the row that is marked or shortly before it.",
    ),
    "GX473": (
        "Diagonals that do not belong together",
        "The four body diagonals are ppp, npp, pnp and ppn, of the same volume and in the same "
        "number of steps; nnn is ppp from its other end. Measure the one that is missing, or the "
        "one that differs, again.",
    ),
    "GX474": (
        "A linear test that does not fit the diagonals",
        "A direct linear test helps where the diagonals were measured, and a run of it needs two "
        "positions at least. Leave out positions beyond the diagonals; its zero may be anywhere.",
    ),
    "GX475": (
        "Measurements that contradict each other",
        "There are more readings than unknowns, and they do not agree within the noise that was "
        "stated; the model they give would be wrong somewhere. Usual reasons are a beam that was "
        "lost or not along its diagonal, a machine that grew warm between the diagonals, and "
        "angular errors, which this method does not know. If the noise is larger than stated, "
        "state it.",
    ),
    "GX476": (
        "Errors that the measurements do not determine",
        "Some errors can change together without any effect on a reading, so that the model would "
        "be a guess. Unless the beams are known to be along their diagonals, the diagonals tell "
        "one combination of the three scale errors and not the scales. Add linear tests of two "
        "axes with --linear; --report without -o writes what is known.",
    ),
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
    "GX501": (
        "The target cannot say this",
        "The control that is written for has no such code, word, comment or plane of arcs, and "
        'there is no other way to say the same in its language. For arcs the pass "plane" or '
        '"segment" makes lines of them; otherwise the source program has to do without.',
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
        'asks for cannot be said in such a block. Resolve it first: the pass "cycles" writes '
        'cycles as plain moves, the pass "offsets" folds shifts into coordinates. Taps are written '
        "again with their ends moved, if the place, which is one for top and bottom, is right for "
        "both within what the passes promise; otherwise give the pass a larger tolerance.",
    ),
    "GX507": (
        "The program grows beyond the budget",
        "The output has more blocks for each one read than `growth` in [budget] allows. Nothing "
        "was written. Passes that cut moves make many blocks of one where their tolerance is small "
        "and the move long. Give them a larger tolerance, or allow more: a control with little "
        "memory, or one that reads blocks slowly, sets the limit.",
    ),
    # --- 6xx: verification ---
    "GX601": (
        "The output does not do what the program does",
        "The written text was read again, taken through the models of the machine and compared "
        "with the input, and differs by more than the budget, or in a feed, an event or a kind "
        "of move. Nothing was written. If the budget was set by hand it may be too small for "
        "what the steps do; otherwise this is a bug of gcxform or of a plugin, and a report "
        "with the program and the pipeline helps.",
    ),
    "GX602": (
        "A pass does not keep what it promises",
        "A pass says that its output has a property, and the path it returned does not have it. "
        "Nothing was written. This is a bug of the pass: report it to the author of the plugin, "
        "see `gcxform list passes`.",
    ),
    "GX603": (
        "A pass on text changed the meaning of a block",
        "A pass that may change comments, blanks and block numbers only has changed a word. "
        "Nothing was written. This is a bug of the pass: report it to the author of the plugin, "
        "see `gcxform list passes`.",
    ),
    # --- 7xx: command line and pipeline ---
    "GX604": (
        "The centre path is not beside the contour",
        "The path that `cutter-comp` made was checked against the contour by other means, and is "
        "not at the tool's radius from it. Nothing was written. This is a bug of gcxform or of a "
        "plugin; please report it with the program.",
    ),
    "GX605": (
        "A table does not read back as it was meant",
        "The table that was to be written was read again, and the errors differ. Nothing was "
        "written. This is a bug of the format: report it to the author of the plugin, see `gcxform "
        "list formats`.",
    ),
    "GX701": (
        "Unknown key in a pipeline",
        "A pipeline file, or an option of a pass, has a key which means nothing there; a misspelt "
        "key would otherwise be ignored without a word. Take the name that is proposed, or see "
        "the options of each pass with `gcxform list passes`.",
    ),
    "GX702": (
        "A value in a pipeline is of the wrong type",
        "The key takes another type of value. In TOML numbers and true or false stand without "
        'quotes, texts and lengths with a unit in quotes: chord-error = "2 um".',
    ),
    "GX703": (
        "Unknown dialect",
        "No installed plugin offers a dialect of this name. Take one of the names listed, or "
        "install the plugin; `gcxform list dialects` shows what there is.",
    ),
    "GX704": (
        "Unknown pass",
        "No installed plugin offers a pass of this name. Take one of the names listed, or install "
        "the plugin; `gcxform list passes` shows what there is.",
    ),
    "GX705": (
        "A mandatory key is missing in a pipeline",
        "The key has no default, because a wrong guess gives a wrong program. Add it.",
    ),
    "GX706": (
        "An option is out of its range",
        "The number is outside what the option can mean. The message gives the range, in mm for "
        "lengths and in degrees for angles.",
    ),
    "GX707": (
        "Not one of the choices of an option",
        "The option takes one of a few words. Take one of those listed.",
    ),
    "GX708": (
        "Not a length or an angle",
        'Lengths are texts with a unit, "5 um", "0.2 mm" or "0.001 in", or plain numbers in mm; '
        'angles are "10 deg", "80 urad", "1 mrad", "0.1 rad", or plain numbers in degrees. A text '
        "without a unit is refused, because nobody can say what it means.",
    ),
    "GX709": (
        "A file of a pipeline cannot be read",
        "A pipeline file, or a file that it names, does not exist, is a directory or may not be "
        "read. Relative paths are relative to the file that names them, on the command line to "
        "the working directory.",
    ),
    "GX710": (
        "A pipeline file is not TOML",
        "The text breaks the syntax of TOML at the place shown, or is not encoded as UTF-8. "
        "Strings stand in quotes, lists in brackets, decimals are set off by a point.",
    ),
    "GX711": (
        "Unknown version of the pipeline file",
        "The key `format` names a version which this release does not read. Use a newer release, "
        "or write the file in the version named.",
    ),
    "GX712": (
        "A chain of passes cannot be read",
        "A chain is passes separated by |, each a name and its options as key=value: "
        "`absolute | segment chord-error=5um`. A value with blanks stands in quotes: "
        'tolerance="1 um".',
    ),
    "GX713": (
        "Options which do not go together",
        "Each option by itself is right, but the pass cannot do what they ask for together. "
        "Change one of them.",
    ),
    "GX720": (
        "segment needs to know how close chords must be",
        "To make lines of arcs the pass has to be told the largest distance between chord and "
        'arc, and there is no value that suits every part. Write `chord-error = "2 um"`, or '
        '`arcs = "split"` to keep arcs as arcs.',
    ),
    "GX721": (
        "volumetric needs to know where the part is",
        "The error depends on the position in the machine, and the program counts from its own "
        "origin. Give `part-origin = [x, y, z]` in machine coordinates, or a machine file with "
        "work offsets.",
    ),
    "GX722": (
        "The dialect of a program is not named",
        "The same words mean different things to different controls, and nothing in a file says "
        "for sure which one it is for, least of all its name. Name the dialect: -f fanuc, or "
        '`dialect = "fanuc"` in [input]; `gcxform list dialects` shows what there is.',
    ),
    "GX723": (
        "A step without a bound needs a budget",
        'One of the steps, or `words = "programmed"`, promises no bound for the deviation, so '
        "that a limit cannot be computed from the steps. Say what is allowed, [budget] "
        'deviation = "20 um"; the certificate states what was measured.',
    ),
    "GX724": (
        "The budget is smaller than what the steps may take",
        "The tolerances of the steps and the rounding of the numbers add up to more than the "
        "budget, so a right run could fail. Raise the budget, lower a tolerance, or write more "
        "decimals.",
    ),
    "GX725": (
        "Steps that do not fit together",
        "A step requires a property of the path that the steps before it do not give, or that "
        "one of them has taken away. Reorder the steps, or add the pass named in the hint; "
        "`gcxform check` shows the properties after each step.",
    ),
    "GX726": (
        "There is no pipeline",
        "Nothing says what is to be done with the program. Give a pipeline file with -p, a "
        "chain with -x, or name a file in the environment variable GCXFORM_PIPELINE. An empty "
        "chain, -x '' with -f DIALECT, is the pipeline that changes nothing.",
    ),
    "GX727": (
        "An output would overwrite an input",
        "The output, the certificate or the map has the name of a file that is read, perhaps by "
        "another path or through a link. Write to another place. To replace the program by the "
        "result on purpose use --in-place, or `gcxform post`.",
    ),
    "GX728": (
        "Options that exclude each other",
        "Two options ask for different things, or name one place for two outputs. Leave one of "
        "them out.",
    ),
    "GX729": (
        "There is no such code",
        "Diagnostic codes are GX and three digits, as they stand in brackets in a message. To "
        "explain a block of a program write FILE:LINE and the dialect with -f.",
    ),
    "GX730": (
        "Nothing installed has this name",
        "No installed plugin offers a thing of this kind and name. `gcxform list` with the kind "
        "alone shows what there is.",
    ),
    "GX731": (
        "The program has no such line",
        "Lines count from 1, as in an editor and in messages. `gcxform info FILE` says how many "
        "there are.",
    ),
    "GX732": (
        "No safe restart at this line",
        "A restart must bring the control into the state in which the program is at that line: "
        "modes, tool, spindle, coolant, and where the axes stand. Something of that is not known, "
        "or cannot be said by blocks. Begin at an earlier line: at the tool change, at the block "
        "that states the arc, before the code that is named.",
    ),
    "GX736": (
        "Pictures need matplotlib",
        "Figures and tables work without it, pictures do not, and it is not installed. Install the "
        "package with its extra: `pip install 'gcxform[plot]'`.",
    ),
    "GX737": (
        "Not a kind of picture",
        "Pictures are written as SVG or PNG, by the ending of the file's name: out.svg, out.png.",
    ),
    "GX738": (
        "A virtual test does not fit the error model",
        "The test would leave the volume in which the errors are known, or has no room in it, so "
        "that its figures would be made up. Choose another place or size; --outside extrapolate "
        "or clamp goes beyond the tables all the same.",
    ),
    # --- 8xx: plugins ---
    "GX740": (
        "How the control compensates the cutter",
        "What joins two moves at an outside corner, and where compensation begins, is a parameter "
        "of some machines and fixed on others. Where it is a parameter, say what it is set to; "
        "where it is fixed, leave the option out.",
    ),
    "GX741": (
        "A step that changes the path stands before one that resolves it",
        "`cutter-comp` is proved against the contour as programmed, so only steps that leave the "
        "contour as it is may come before it: `absolute` and `metric`. Put the other steps after "
        "it.",
    ),
    "GX742": (
        "rtcp needs a machine with rotary axes",
        "Where the axes turn, and whether they turn the table or the head, is in the machine "
        "file: name its `kinematics`, or list its axes in `table` and `head`, and give each axis "
        "a direction and a point.",
    ),
    "GX801": (
        "Two plugins offer the same name",
        "Which one a pipeline means would depend on the order of installation. Uninstall one of "
        "the two distributions, or rename what it offers.",
    ),
    "GX802": (
        "A plugin is broken",
        "A plugin cannot be imported, or one of its hooks fails or returns what it should not; "
        "what it offers is missing and all else works. Update or uninstall the distribution "
        "named, or tell its author.",
    ),
    # --- 9xx: files ---
    "GX901": (
        "A program cannot be read",
        "The file does not exist, is a directory, or may not be read; or its device failed. "
        "Correct the name or the permissions. Nothing was written.",
    ),
    "GX902": (
        "A result cannot be written",
        "The directory does not exist or may not be written to, the disk is full, or a limit on "
        "the size of files was reached. The destination is as it was: results are written to a "
        "temporary file beside it and renamed at the end.",
    ),
    "GX903": (
        "Input or output failed",
        "The operating system refused to read or to write; the message is its own. Results are "
        "renamed into place only when they are complete.",
    ),
}

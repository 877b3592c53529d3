"""Codes of machine and error-model files, and of measurements: 4."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
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
        '"G59.1" or "G54.1 P1", of a SINUMERIK also G505 to G599. A name with a point stands in '
        'quotes: [work-offset."G59.1"]. Home '
        "positions are those of G28 and G30.",
    ),
    "GX437": (
        "Not a tool",
        "The tables of tools are called by whole numbers, [tool.1] for T1, each once. A tool has a "
        "radius, or d as its control shows it: then d-is in [control] says which of the two a "
        "parameter makes of d, the diameter or the radius.",
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
        "axes with --linear; --report without -o writes what is known. Circles in one sense do "
        "not tell squareness from servo mismatch, and circles at one feed not the scales from "
        "what the axes lag behind: measure in both senses, and at two feeds.",
    ),
    "GX477": (
        "A circular test that is no circle",
        "A run of a circular test goes once around a part of a circle, or all of it, at angles of "
        "the place in its plane. Its way in and out is no part of it, and of a clockwise run whose "
        "angles rise nobody can tell whether they are those of the way travelled. `gcxform "
        "calibrate circles --help` shows the table, and --arc and --cw-angles say what it does "
        "not.",
    ),
    "GX478": (
        "A circular test whose place is not known",
        "Squareness and scales hold where they were measured, and the error model that is written "
        "has no error in the middle of the circle and ends where the circle did. Say where that "
        "was in machine coordinates: --centre, or columns in the table.",
    ),
}

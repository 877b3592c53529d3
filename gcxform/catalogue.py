"""Every diagnostic code with its explanation: what `gcxform explain GX301` prints.

Codes are never reused. The hundreds say where a thing was found: 1 text, 2 meaning, 3 geometry,
4 machine and error-model files, 5 emission, 6 verification, 7 command line and pipeline,
8 plugins, 9 files.
"""

from __future__ import annotations

CATALOGUE: dict[str, tuple[str, str]] = {
    # --- 3xx: geometry --------------------------------------------------------------------
    "GX309": (
        "The compensated position does not converge",
        "Compensation looks for the command which, together with the error of the machine there, "
        "gives the programmed position; it did not settle. The error model jumps at that place, as "
        'it does at the border of a table with `outside = "zero"`. Choose another policy, or keep '
        "the program away from the border.",
    ),
    # --- 4xx: machine and error-model files -------------------------------------------------
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
        "Errors of the carriages are not taken",
        'With `convention = "carriage"` the errors are motions of each carriage, and their sign at '
        "the tool depends on which axes carry the workpiece; the model of nine functions does not "
        "know that. Give the errors of the tool relative to the workpiece and write "
        '`convention = "relative"`.',
    ),
    "GX414": (
        "Angular errors in a model of nine functions",
        "The file has roll, pitch or yaw (EA., EB., EC.) which is not zero. Their effect at the "
        "tool grows with the tool offset and with the other axes; leaving them out would "
        "compensate wrongly. Remove them only if the tables were measured at the tool tip and "
        "contain their effect.",
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
}

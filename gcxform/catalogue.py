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
        "Unknown work offset",
        "Work offsets are called by their codes, G54 to G59, and further ones such as "
        '"G59.1" or "G54.1 P1". A name with a point stands in quotes: [work-offset."G59.1"].',
    ),
    "GX437": (
        "Not a tool number",
        "The tables of tools are called by whole numbers, [tool.1] for T1, each once.",
    ),
    # --- 7xx: command line and pipeline -------------------------------------------------------
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
    # --- 8xx: plugins -------------------------------------------------------------------------
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
}

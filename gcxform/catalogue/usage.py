"""Codes of the command line and pipelines, 7, of plugins, 8, and of files, 9."""

from __future__ import annotations

CODES: dict[str, tuple[str, str]] = {
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
    "GX606": (
        "A program for another machine does not keep the tool where it was",
        "The path that a pass made was followed by the forward models of both machines, and tip, "
        "tool axis or time are not those of the program. Nothing was written. This is a bug of "
        "gcxform or of a plugin; please report it with the program.",
    ),
    "GX609": (
        "The output does not have the stamps that it should have",
        "What was written is searched for stamps, as any program is before it is read. There is "
        "another one than was meant to be written, or none, or the seal does not fit; so the same "
        "could be done to the program twice. Nothing was written. This is a bug of gcxform.",
    ),
    "GX700": (
        "The command line is not understood",
        "A verb, an option or an argument is misspelt, is missing, or stands where it has no "
        "meaning. `gcxform --help` lists the verbs, and `gcxform VERB --help` their options.",
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
        "Something that is optional is not installed",
        "Pictures need matplotlib, the language server of editors needs pygls; all else works "
        "without them. Install the package with its extra: `pip install 'gcxform[plot]'`, or "
        "`pip install 'gcxform[lsp]'`.",
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
    "GX739": (
        "A host would not do what the pipeline says",
        "A host is a program that calls gcxform: a control, a CAM system, a slicer. It executes "
        "another dialect than the pipeline writes, or it cuts off what is longer than a line of "
        "its settings. Name the dialect in [output], or give the file a shorter path.",
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
        "The pass needs a machine with rotary axes",
        "Where the axes turn, and whether they turn the table or the head, is in the machine "
        "file: name its `kinematics`, or list its axes in `table` and `head`, and give each axis "
        "a direction and a point.",
    ),
    "GX743": (
        "The calibrated machine is another one",
        "`repost` corrects a program for the measured places of the same rotary axes: both files "
        "name them in the same order on the same sides, with the same gauge point. Take the file "
        "that `gcxform calibrate rotary` has written from the one of [machine].",
    ),
    "GX744": (
        "A program cannot be written for the target machine",
        "Angles are found for machines with two rotary axes that count on, and `retarget` writes "
        "for the tools that the program was read with. Mend the file of the target machine.",
    ),
    "GX745": (
        "A line for where the tool is drawn back is not taken",
        "What stands in `retract-lines` and `return-lines` is written between the moves that "
        "`retarget` adds, so it has to be proved like them: comments, dwells, coolant, M codes "
        "that both machine files call inert, and rapids of X, Y and Z to places of the machine, "
        "each in a line of its own. Leave out what else there is.",
    ),
    "GX746": (
        "The dialect has no tool vectors",
        'With `tip-codes = "vectors"` `rtcp` reads programs that say the tool axis by I, J and K. '
        "Which code announces them is known of few dialects: G43.5 of `fanuc`.",
    ),
    "GX747": (
        "Programs for this control are only read",
        "Its programs are not written in words. They are turned into blocks that are, and what is "
        "written has to be a program of another control: name it in [output], or with -t. A "
        "SINUMERIK, a Fagor or a TNC may be written from itself and from other controls, by passes "
        "that change no text.",
    ),
    "GX748": (
        "A tolerance without a unit, and a large one",
        "A length without a unit is in mm, so `chord-error = 5` allows 5 mm. Above 0.1 mm that is "
        'rarely meant. Write the unit: `chord-error = "5 um"`, or "5 mm" if it is so; this is '
        "a warning, and the pipeline runs as it stands.",
    ),
    "GX749": (
        "Several programs need a place for each result",
        "Several programs, or a folder, were named, and their results cannot all go to stdout or "
        "to one file. Name a folder with -o, replace the programs with --in-place, or look at what "
        "would be done with --check or --diff. Two programs of one name need two folders.",
    ),
    "GX750": (
        "A pipeline file that was found belongs to somebody else",
        "Where no pipeline is named, gcxform.toml is looked for in the folder of the program and "
        "above it. One that another user has put there is not taken by itself: it would decide "
        "what is cut. Look at it, and name it with -p if it is meant.",
    ),
    "GX751": (
        "A folder cannot be watched",
        "Another watcher is at work in this folder, or its results would be dropped into it and be "
        "taken for programs again. End the other one, or name another folder with -o.",
    ),
    "GX752": (
        "Something is needed that is not installed",
        "URLs are read and written by fsspec, a scheduler is asked by Dask, and Parquet is written "
        "by pandas and pyarrow. None of them is needed for programs in folders of this computer. "
        "Install gcxform[dask] or gcxform[batch]; a URL may need the package of its kind as well.",
    ),
    "GX760": (
        "A file names another that lies elsewhere",
        "A pipeline, machine or model file may name files in its own folder and below, or below "
        "the folder in which gcxform is called. What comes with a job could otherwise make it "
        "read any file of the computer. Copy the file there, name it on the command line (-m, or "
        "model=... in -x), or allow it with --allow-outside.",
    ),
    "GX761": (
        "A limit is reached",
        "A line, an expression, a number of moves or the parts of an error model are larger than "
        "any machine has use for; usually a unit is missing or a file is not what it is taken "
        "for. If it is meant, raise the limit: KEY = N in [limits] of the pipeline, or "
        "--limit KEY=N. What is said on the command line replaces [limits].",
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
        "The operating system refused to read or to write, and the message is its own; or it ended "
        "a process that took part in a run, as it does when memory runs out. Results are renamed "
        "into place only when they are complete.",
    ),
    "GX904": (
        "A file changed while it was read",
        "Somebody writes into it at this moment: a CAM system that has not finished, or a copy "
        "that is under way; or it was replaced before its result could be. What was read would be "
        "a mixture, or what is there now would be lost. Nothing was written; run it again when the "
        "file is complete.",
    ),
}

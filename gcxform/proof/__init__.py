"""What was written is read again, undone, and compared.

Every line of the output has a line of the source in the map, so every move has an owner
(`trace.py`). `undo` of all passes, in reverse order, gives what the machine does; deviation, kinds,
feeds, times and events of that are compared with the path as read. A move may stand for a run of
moves (`gcxform/deviations/runs.py`); an event that stood inside the run cannot stand behind it.
What else the files hold is counted on both sides (`inventory.py`): source and rules must give the
output, and only rules that a run can give reasons for are there. Assignments are compared with
their values, what stands behind the end byte for byte. The file as a whole is shown to
`gcxform/modal/program_end.py` on both sides.

A difference is GX601 with both lines, and nothing is written. A block that only the target's reader
refuses is a refusal of the program, with the line of the source and the text that would be written;
in the dialect of the source it is an error of ours as GX601 is. Nothing of `gcxform.emit` is
imported.
"""

"""Toolpath to text of a dialect.

A window is written at once, in five steps.

1. Formatted positions (`positions.py`): what counts is what the control believes, which is the
rounded position. Incremental output is the difference of rounded positions, so it does not drift.
An axis is written where its rounded value changes, also if the source block did not name it.

2. Pieces (`pieces.py`): a line is one piece, a split block several. What acts before the motion
stands in the first, what acts after it in the last. Each piece states what differs from the modes
that the control then has (`needed_modes.py`).

3. Copying (`copying.py`): a line keeps its bytes if they say to this control, in its state there,
what the path says: same move, same modes, same end, no word missing. For arcs and G91 the start
counts as well; while everything so far was copied, positions are those of the source to the last
bit and not the rounded ones.

4. Arcs (`arcs.py`): the centre on the grid that moves the arc least and is accepted by the rule of
the target control. If there is none, or the sweep would be another, the program is refused.

5. Templates (`templates.py`, `codewords.py`): pieces of one shape that are written in one way are
sorted together (`writing.py`) and rendered as a matrix of bytes (`render.py`, `numbers.py`).

What the target cannot say is an error, never a warning.
"""

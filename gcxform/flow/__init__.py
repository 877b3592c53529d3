"""Subprograms, loops and jumps: a program with them becomes the blocks that the control executes.

The rest of the package reads straight programs. Here one with calls and loops is executed line by
line, as far as that needs no machine: its parameters are computed, its blocks are written out in
the order in which they act, and every expression becomes its number. Programs whose lines are not
words at all become blocks in the same way (`translation.py`).

What is executed is the dialect's (`FlowRule`): O-words with M98 and M70 to M73 (`owords.py`,
`constructs.py`, `modes.py`), macro B (`macros.py`). Expressions become numbers here, because the
parameters of a call are its own. Stored modes come back as the codes that say them, and polar words
become X and Y; for both the executed blocks are read as they come (`modes.py`, `places.py`). Source
maps, diagnostics and certificates name the lines of the file. Programs that are only copied are not
executed.

`tests/properties/test_flow.py` holds this against LinuxCNC's interpreter, of which three faults
were found: after `continue` in a `do` loop a later `repeat` runs too often, a `do` loop behind a
loop with `break` runs once, and `M98 L0` inside a construct loses its place. Such programs are
refused.
"""

"""Canned cycles: levels, steps, and the moves that they are.

Cycles are settled on columns: which blocks call one, and with which words
(`gcxform/modal/moves/cycle_calls.py`), at which levels (`stretch.py`), by which steps (the
`CycleRule` of the dialect). Only where a pattern ends has to be known at once, because what follows
begins there (`gcxform/modal/moves/cycle_patterns.py`); the moves of all patterns of a window are
made together (`expansion.py`). Dwells and spindle codes between the moves are events that stand
`within` the line.

A block that calls a cycle is written as it stands, or refused (GX506): nobody guesses how a changed
cycle would be said. The pass `cycles` makes its rows plain, and then each is written as a block.
Tapping alone stays a cycle (`gcxform/emit/tapping.py`).
"""

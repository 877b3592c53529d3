"""Virtual tests: what an instrument would read on a machine with known errors.

This is above the pipeline and uses it as anybody does. A standard program is text with the lines
that are to be read (`programs.py`); the compensated one is what a run wrote, and the source map
says which of its lines belong to which target or circle. Figures (`figures.py`, `circles.py`) know
nothing of programs.
"""

"""A restart at a line: what was before it, and the blocks that restore it.

What is before the line is interpreted as ever. A code of a group for which `memory.py` has no way
to restate it, or with an effect other than to be kept, makes the restart unsafe. The proof reads
the blocks of the preamble with an interpreter of its own, and then the rest of the program with
both.
"""

"""Subprograms, loops and jumps: a program with them becomes the blocks that the control executes.

The rest of the package reads straight programs. Here one with calls and loops is executed line by
line, as far as that needs no machine: its parameters are computed, its blocks are written out in
the order in which they act, and every expression becomes its number. Programs whose lines are not
words at all become blocks in the same way (`translation.py`).
"""

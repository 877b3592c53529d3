"""Canned cycles: calls, levels, steps, and the moves that they are."""

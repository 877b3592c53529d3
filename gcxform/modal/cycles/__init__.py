"""Canned cycles: levels, steps, and the moves that they are."""

"""SINUMERIK: its dialect, and its language as blocks of words."""

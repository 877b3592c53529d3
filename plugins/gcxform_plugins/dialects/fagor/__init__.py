"""Fagor 8065: its dialect, and its language as blocks of words."""

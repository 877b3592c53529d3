"""Errors of axes from body diagonals."""

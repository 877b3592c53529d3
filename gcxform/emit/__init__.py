"""Toolpath to text of a dialect."""

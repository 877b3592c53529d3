"""Kinds of machines, by where their rotary axes are."""

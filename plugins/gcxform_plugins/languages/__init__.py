"""Statements of controls with a language of their own, as blocks of words."""

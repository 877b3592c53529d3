"""Bounds that several passes use."""

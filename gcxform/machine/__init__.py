"""Machines and their errors."""

"""A chain of passes, checked before any program, and its runs."""

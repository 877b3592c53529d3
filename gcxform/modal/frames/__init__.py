"""Which frame is in force, and what codes do to it."""

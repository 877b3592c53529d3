"""A restart at a line: what was before it, and the blocks that restore it."""

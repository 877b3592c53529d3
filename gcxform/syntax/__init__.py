"""What was written: grammars, trees, shapes and columns."""

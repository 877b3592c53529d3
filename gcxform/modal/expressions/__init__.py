"""Values of expressions, and the lines that set parameters."""

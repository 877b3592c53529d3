"""Virtual measurements: the readings that a machine with a known error model would give."""

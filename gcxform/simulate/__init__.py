"""Virtual tests: what an instrument would read on a machine with known errors."""

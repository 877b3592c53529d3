"""Error models of machines: the volumetric error as a function of the position."""

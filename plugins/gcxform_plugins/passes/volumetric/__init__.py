"""`volumetric`: commands for a machine with known errors."""

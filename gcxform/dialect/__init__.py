"""What a controller is: its codes, arithmetic, cycles and limits, as data."""

"""Text of the TOML files that users write, and the units in them."""

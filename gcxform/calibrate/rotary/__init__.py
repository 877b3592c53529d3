"""Where one rotary axis is, from centres of a ball."""

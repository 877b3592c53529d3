"""What the blocks of one shape mean, worked out once."""

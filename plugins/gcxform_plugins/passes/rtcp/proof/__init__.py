"""What proves it: forward models alone, no search."""

"""Foreign error tables, one file each."""

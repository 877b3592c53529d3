"""First-party passes, one file each."""

"""First-party dialects, one controller family a file."""

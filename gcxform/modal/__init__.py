"""What was written, turned into what it means to a control."""

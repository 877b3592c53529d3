"""What was written is read again, undone, and compared."""

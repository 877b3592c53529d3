"""What finds what is written."""

"""What several formats of error tables share."""

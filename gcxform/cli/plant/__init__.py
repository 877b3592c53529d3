"""`gcxform batch`: many programs, pipelines and machines; what is done is not repeated."""

"""Where the machine goes with them: no search shared."""

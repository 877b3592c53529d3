"""The kit for plugin authors: strategies, checks and case files."""

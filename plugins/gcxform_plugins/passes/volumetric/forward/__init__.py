"""The search for commands."""

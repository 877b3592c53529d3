"""The contract of a pass: options, facts, promise, undo."""

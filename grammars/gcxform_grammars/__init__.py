"""The lark grammars: `iso.lark` is the root, each family builds on it."""

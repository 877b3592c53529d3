"""Controls that people have, each a table of what differs from its nearest relative."""

"""What the verbs about measurements share, and their subverbs."""

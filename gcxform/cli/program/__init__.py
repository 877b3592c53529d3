"""What the verbs say of one program."""

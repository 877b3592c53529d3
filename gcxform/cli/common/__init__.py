"""What verbs share: options, files in and out, failures."""

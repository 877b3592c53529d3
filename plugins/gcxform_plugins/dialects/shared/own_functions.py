"""What languages say of M functions that the builder of a machine has put there."""

OF_BUILDER = "what it does is up to the machine's builder"
INERT = "inert-m = [{}] in [control] of the machine file, if it moves nothing; else use `absolute`"

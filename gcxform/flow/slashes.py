"""Blocks with a slash in programs that are written anew: a switch decides on them no more."""

OPEN = "a switch of the control decides whether this block is executed"
SAY = 'block-delete = "execute" in [input], or block-delete = "skip" in [input]'
TOLD = {
    "execute": "blocks with a slash are executed; one that is written without it no switch skips",
    "skip": "blocks with a slash are skipped; one that is left out no switch has executed",
}
"""What is said of them, by what `block-delete` says."""

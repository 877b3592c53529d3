"""`python -m gcxform.cli`."""

from gcxform.cli import main

main()

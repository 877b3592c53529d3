"""Facts that are refused although their control executes them, and why."""

KNOWN = {
    "siemens_mcall": "it names neither a motion code nor a feed, so settings of the control decide "
    "both (MD20150); with G0 and F before, tests/test_siemens.py reads it as the fact says",
}

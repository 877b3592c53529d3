"""Work offsets of a SINUMERIK: settable frames, by their places in the list of them."""

FURTHER = {f"{506 + n}": f"G54.1 P{n}" for n in range(1, 94)}
"""Those beyond the sixth, as blocks have them."""
WORK = {"54": "G54", "55": "G55", "56": "G56", "57": "G57", "505": "G58", "506": "G59", **FURTHER}

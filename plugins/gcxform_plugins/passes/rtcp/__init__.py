"""`rtcp`, `to-tip`, `repost`, `retarget`: between tips and axes, and to other machines.

What they have in common is `conversion.py`; what the parts know of their options is `options.py`,
below all of them.
"""

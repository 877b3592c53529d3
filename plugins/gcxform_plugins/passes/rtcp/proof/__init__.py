"""What proves it: forward models alone, no search.

The angles that a pole has swallowed cannot be found again, so what has other angles than the source
is proved by following both through the forward models of their machines (`proof.py`), and what has
the same is undone (`undoing.py`). Feeds of tips become inverse times. Where an axis would be faster
than the machine file allows, a piece takes the time that the axis needs: the proof accepts a move
that is late if an axis is at its full speed in it (`gcxform/proof/feeds.py`), and the certificate
tells by how much.
"""

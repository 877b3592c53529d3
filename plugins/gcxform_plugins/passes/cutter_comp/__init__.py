"""`cutter-comp`: the contour becomes the path of the centre.

The output follows another path on purpose, so there is no `undo`: the pass resolves. `proof.py`
checks it against the path as read and shares no code with the search in `offsetting.py`. The
verifier compares what was written with the path after this pass, and undoes only the passes after
it; those before it must leave the contour as it is (GX741). Windows end where no compensation is in
force and the tool has left the contour.

What LinuxCNC's interpreter executes is computed, with its oddities: turns below 0.05 rad are no
corner, so that the centre may there be nearer by 0.125 % of the radius; rapids go straight past
outside corners; the speed in G93 is that of the contour. Where LinuxCNC cuts into the contour
without a word (a short move between an inside corner and one of less than 0.05 rad), or takes a
corner of nearly 180 degrees now for an inside, now for an outside, the program is refused. On other
controls corners and the entry depend on parameters, which the pass has to be told.
"""

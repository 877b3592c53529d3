"""`cutter-comp`: the contour becomes the path of the centre."""

"""From measurements to error models, with the covariance of what is found.

    gcxform/calibrate/csv_text.py        tables: units in the header, places of faults
    gcxform/calibrate/diagonal/readings.py   readings along the body diagonals, and linear tests
    gcxform/calibrate/diagonal/file.py   the same from CSV files, and back
    gcxform/calibrate/diagonal/equations.py      what a reading says about the errors of the axes
    gcxform/calibrate/solution.py       weighted least squares that knows what it cannot tell
    gcxform/calibrate/diagonal/step_diagonal.py   sequential step diagonal: the nine functions
    gcxform/calibrate/diagonal/angles.py         whether its residuals show angular errors
    gcxform/calibrate/diagonal/plain_diagonal.py  four lengths: the squareness
    gcxform/calibrate/diagonal/reframe.py        the reference frame of nine functions: end points
    gcxform/calibrate/diagonal/report.py          reports and comments for a person
    gcxform/calibrate/rotary/circle.py         circles through points of space, many at once
    gcxform/calibrate/rotary/ball_file.py       ball centres from CSV files, and back
    gcxform/calibrate/rotary/axis.py         ball centres at angles: where a rotary axis is
    gcxform/calibrate/rotary/machine.py  the same for an axis of a machine file
    gcxform/calibrate/rotary/check.py    the check with RTCP on, warnings, advice
    gcxform/calibrate/rotary/report.py    its report and comments
    gcxform/calibrate/bundle/bundle.py         balls at any poses: all rotary axes, and squareness
    gcxform/calibrate/rotary/predicted_check.py      the check with RTCP on, from the covariance of such unknowns
    gcxform/calibrate/bundle/report.py    its report and comments
    gcxform/calibrate/bundle/plan.py           poses for a bundle, inside the limits and well conditioned
    gcxform/calibrate/bundle/touching.py       the program that probes them, and the centres it found
    gcxform/calibrate/ballbar/ballbar.py        circular tests with RTCP on: the axes of the table
    gcxform/calibrate/ballbar/file.py    their readings from CSV files, and back
    gcxform/calibrate/ballbar/locations.py      the names of location errors, and of those of a trunnion
    gcxform/calibrate/ballbar/report.py   the report and comments of circular tests

Nothing here prints. What is wrong with a measurement is an InputError, with file, line and column
where there is one.
"""

"""From measurements to error models, with the covariance of what is found.

    gcxform/calibrate/csvtext.py        tables: units in the header, places of faults
    gcxform/calibrate/diagonaldata.py   readings along the body diagonals, and linear tests
    gcxform/calibrate/diagonalfile.py   the same from CSV files, and back
    gcxform/calibrate/equations.py      what a reading says about the errors of the axes
    gcxform/calibrate/solution.py       weighted least squares that knows what it cannot tell
    gcxform/calibrate/stepdiagonal.py   sequential step diagonal: the nine functions
    gcxform/calibrate/angles.py         whether its residuals show angular errors
    gcxform/calibrate/plaindiagonal.py  four lengths: the squareness
    gcxform/calibrate/reframe.py        the reference frame of nine functions: end points
    gcxform/calibrate/words.py          reports and comments for a person
    gcxform/calibrate/circle.py         circles through points of space, many at once
    gcxform/calibrate/ballfile.py       ball centres from CSV files, and back
    gcxform/calibrate/rotary.py         ball centres at angles: where a rotary axis is
    gcxform/calibrate/rotarymachine.py  the same for an axis of a machine file
    gcxform/calibrate/rotarycheck.py    the check with RTCP on, warnings, advice
    gcxform/calibrate/rotarywords.py    its report and comments
    gcxform/calibrate/bundle.py         balls at any poses: all rotary axes, and squareness
    gcxform/calibrate/axischeck.py      the check with RTCP on, from the covariance of such unknowns
    gcxform/calibrate/bundlewords.py    its report and comments
    gcxform/calibrate/plan.py           poses for a bundle, inside the limits and well conditioned
    gcxform/calibrate/touching.py       the program that probes them, and the centres it found
    gcxform/calibrate/ballbar.py        circular tests with RTCP on: the axes of the table
    gcxform/calibrate/ballbarfile.py    their readings from CSV files, and back
    gcxform/calibrate/locations.py      the names of location errors, and of those of a trunnion
    gcxform/calibrate/ballbarwords.py   the report and comments of circular tests

Nothing here prints. What is wrong with a measurement is an InputError, with file, line and column
where there is one.
"""

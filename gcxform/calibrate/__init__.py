"""From measurements to error models, with the covariance of what is found.

    csv_text.py                 tables: units in the header, places of faults
    diagonal/readings.py        readings along the body diagonals, and linear tests
    diagonal/file.py            the same from CSV files
    diagonal/equations.py       what a reading says about the errors of the axes
    solution.py                 weighted least squares that knows what it cannot tell
    diagonal/step_diagonal.py   sequential step diagonal: the nine functions
    diagonal/angles.py          whether its residuals show angular errors
    diagonal/slopes.py          the six slopes of the end-point frame, in words
    diagonal/plain_diagonal.py  four lengths: the squareness
    diagonal/reframe.py         the reference frame of nine functions: end points
    diagonal/report.py          reports and comments for a person
    rotary/circle.py            circles through points of space, many at once
    rotary/ball_file.py         ball centres from CSV files, and back
    rotary/axis.py              ball centres at angles: where a rotary axis is
    rotary/machine.py           the same for an axis of a machine file
    rotary/check.py             the check with RTCP on, warnings, advice
    rotary/report.py            its report and comments
    bundle/bundle.py            balls at any poses: all rotary axes, and squareness
    rotary/predicted_check.py   the check with RTCP on, from a covariance
    bundle/report.py            its report and comments
    bundle/clearance.py         where a probe gets to, and how high it has to be to turn
    bundle/plan.py              poses for a bundle: inside the limits, well conditioned
    bundle/touching.py          the program that probes them, and its centres
    ballbar/ballbar.py          circular tests with RTCP on: the axes of the table
    ballbar/file.py             their readings from CSV files, and back
    ballbar/locations.py        the names of location errors, also of a trunnion
    ballbar/report.py           the report and comments of circular tests
    circles/deviations.py       circular tests: G, F, D and H of ISO 230-4
    circles/causes.py           what makes a circle not round, a column for each cause
    circles/circles.py          tests in the planes of the linear axes, and their causes
    circles/machine.py          from several planes to squareness, scales and their model
    circles/file.py             their readings from CSV files, also foreign ones, and back
    circles/report.py           their sheet in words, comments and report

Nothing here prints. What is wrong with a measurement is an InputError, with file, line and column
where there is one.
"""

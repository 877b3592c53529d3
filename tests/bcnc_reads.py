"""What bCNC takes a program for, printed as JSON: run by the Python of the system, not by pytest.

It is loaded by bCNC's own reader, and where its moves end is worked out by what draws them there.
"""

import builtins
import json
import sys

sys.path[:0] = ["/usr/share/bcnc/bCNC", "/usr/share/bcnc/bCNC/lib"]
builtins._ = lambda text: text

sys.stdout = sys.stderr  # it prints when it is imported
from CNC import CNC, GCode  # noqa: E402

program = GCode()
loaded = program.load(sys.argv[1])
program.initPath()
ends, lines = [], []
for block in program.blocks:
    for line in block:
        lines.append(line)
        words = CNC.parseLine(line)
        if words is None or program.cnc.motionStart(words) == "quit":
            continue
        path = program.cnc.motionPath()
        program.cnc.motionEnd()
        if path:
            ends.append([float(value) for value in path[-1][:3]])
json.dump({"loaded": loaded, "lines": lines, "ends": ends}, sys.__stdout__)

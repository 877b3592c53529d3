"""Faults of the commands `info` and `resume`, and of how a dialect tells times."""

from __future__ import annotations

from faults.mutation import Mutation

TIPS = "gcxform/view/tips.py"

MUTATIONS = (
    Mutation(
        "view: tips of axes are without their tool",
        TIPS,
        "x, y, z = (gauge - tool).tolist()",
        "x, y, z = gauge.tolist()",
        "tests/test_view.py::test_axes_are_drawn_where_the_tip_goes",
    ),
    Mutation(
        "view: tips of axes count from the machine",
        TIPS,
        "angles[here])[0] - gauge - zero",
        "angles[here])[0] - gauge - zero + 1.0",
        "tests/test_view.py::test_axes_are_drawn_where_the_tip_goes",
    ),
    Mutation(
        "check --json: what was found before it ended is left out",
        "gcxform/cli/common/failures.py",
        "            found += error.diagnostics\n",
        "            found[:] = error.diagnostics\n",
        "tests/test_hints.py",
    ),
    Mutation(
        "info: the feed per turn forgets the spindle",
        "gcxform/cli/program/times.py",
        "speed[event.row :] = self.spindle",
        "speed[event.row :] = 1.0",
        "tests/test_info.py",
    ),
    Mutation(
        "info: rapids take as long as the fastest axis",
        "gcxform/cli/program/times.py",
        "each.max(axis=1, initial=0.0)",
        "each.min(axis=1)",
        "tests/test_info.py",
    ),
    Mutation(
        "resume: the feed is stated in the wrong unit",
        "gcxform/resume/preamble.py",
        "feed_inch = self.state.feed_unit == INCH",
        "feed_inch = self.state.feed_unit != INCH",
        "tests/test_resume.py",
    ),
    Mutation(
        "resume: the coolant stays on",
        "gcxform/resume/memory.py",
        "off = COOLANT_OFF.get(code)",
        "off = ()",
        "tests/test_resume.py",
    ),
    Mutation(
        "resume: compensation that is over begins again",
        "gcxform/resume/memory.py",
        " or HANDLED.get(code.group) is How.NOTHING:",
        ":",
        "tests/test_resume.py",
    ),
    Mutation(
        "resume: frames are not compared",
        "gcxform/resume/restart.py",
        "[mine != theirs for theirs in other.frames]",
        "[False for theirs in other.frames]",
        "tests/test_machine_reading.py",
    ),
    Mutation(
        "commands: the machine file is forgotten",
        "gcxform/cli/common/request.py",
        "return reading.on(self.loaded_machine) if self.loaded_machine else reading",
        "return reading",
        "tests/test_machine_reading.py",
    ),
    Mutation(
        "check: the machine file is forgotten",
        "gcxform/cli/check.py",
        "pipeline.machine_reading, axes",
        "pipeline.reading, axes",
        "tests/test_machine_reading.py",
    ),
    Mutation(
        "check: a value on trial is kept where it ends nothing",
        "gcxform/cli/program/missing.py",
        "            self._take_back(each)\n",
        "",
        "tests/test_missing.py",
    ),
    Mutation(
        "check: behind a block that is left out the state is taken for known",
        "gcxform/cli/program/missing.py",
        "if left_out and each.code not in STATELESS:",
        "if left_out and each.code in STATELESS:",
        "tests/test_missing.py",
    ),
    Mutation(
        "check: the first of two values on trial counts",
        "gcxform/cli/program/missing.py",
        "min(counts, key=lambda k: counts[k])",
        "0",
        "tests/test_missing.py",
    ),
    Mutation(
        "files: a tool of which one value is open has the others",
        "gcxform/config/to_fill_in.py",
        'WHOLE: Final = ("tool", "work-offset")',
        'WHOLE: Final = ("work-offset",)',
        "tests/test_missing.py",
    ),
    Mutation(
        "machine new: new keys go before the table they belong to",
        "gcxform/cli/program/filled_files.py",
        "lines[end:end] = block(rest, notes, dialect)[1:]",
        "lines[at:at] = block(rest, notes, dialect)[1:]",
        "tests/test_machine_new.py",
    ),
    Mutation(
        "machine new: what is filled in is asked again",
        "gcxform/cli/program/filled_files.py",
        "new = [question for question in group if not _there(before, question)]",
        "new = list(group)",
        "tests/test_machine_new.py",
    ),
    Mutation(
        "machine new: a subprogram counts as a program",
        "gcxform/cli/program/survey.py",
        "if is_subprogram(source, pipelines[0].source):",
        "if False:",
        "tests/test_machine_new.py",
    ),
    Mutation(
        "machine new: what called files use is not seen",
        "gcxform/cli/program/machine_needs.py",
        "source = written_out(source, dialect, reading)",
        "written_out(source, dialect, reading)",
        "tests/test_machine_new.py",
    ),
    Mutation(
        "presets: what the file says itself is replaced",
        "gcxform/machine/presets.py",
        "if isinstance(value, Mapping) or key not in own",
        "if True",
        "tests/test_presets.py",
    ),
    Mutation(
        "presets: what the file says itself is shown as taken",
        "gcxform/machine/presets.py",
        "elif said is None:",
        "else:",
        "tests/test_presets.py",
    ),
    Mutation(
        "haas: a dwell with a point is in milliseconds",
        "gcxform/modal/numbers_without_point.py",
        "self.rule.seconds(address, decimals >= 0)",
        "self.rule.seconds(address, decimals >= 9)",
        "tests/test_info.py",
    ),
)

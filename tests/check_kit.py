"""What `gcxform check` finds in programs: the least that a proved output must live up to."""

from __future__ import annotations

from dataclasses import replace

import gcxform as gx
from gcxform.cli.check import reading_findings
from gcxform.flow.straightened import written_out
from gcxform.syntax.source import Source


def found_by_check(text: bytes, pipeline: gx.Pipeline) -> set[str]:
    """Return the codes of what speaks against reading a program as the source of a pipeline."""
    source = Source.of_bytes(text)
    try:
        read = written_out(source, pipeline.source, pipeline.reading)
    except gx.InputError as error:
        return {each.code for each in error.diagnostics}
    return {each.code for each in reading_findings(pipeline, read)}


def new_in_output(source: bytes, output: bytes, pipeline: gx.Pipeline) -> set[str]:
    """Return the codes of what is found in an output by its target, and not in its source."""
    plain = replace(pipeline, passes=(), budget=1.0, words="changed", again=True)
    before = found_by_check(source, replace(plain, target=pipeline.source))
    there = replace(plain, source=pipeline.target, drop=frozenset(), m_codes={}, inert=frozenset())
    return found_by_check(output, there) - before

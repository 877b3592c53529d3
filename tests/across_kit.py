"""Blocks of one control as they are said for another, by a reading that each test file has."""

from __future__ import annotations

import pytest
from check_kit import new_in_output

import gcxform as gx
from gcxform.plugin.registry import default_registry

DIALECTS = default_registry().dialects
HEAD = "G21 G90 G94 G17 G54\n"


def said(reading, source, target, blocks, **options):
    """Return the lines that blocks become, proved, without those of the head and of the end.

    Nothing speaks against them on their control that does not speak against the blocks on theirs.
    """
    pipeline = gx.Pipeline(DIALECTS[source], DIALECTS[target], (), reading, **options)
    program = f"{HEAD}{blocks}\nM2\n".encode()
    result = pipeline.run(program)
    assert result.certificate.verified
    assert not new_in_output(program, result.text, pipeline)
    return result.text.decode().split("\n")[1:-2]


def refused(reading, source, target, blocks, **options):
    """Return what is said against blocks."""
    with pytest.raises(gx.GcxformError) as error:
        said(reading, source, target, blocks, **options)
    return error.value.diagnostics[0]

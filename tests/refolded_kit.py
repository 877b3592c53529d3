"""Programs in a language of their own, as blocks that are to be written for the same control."""

from __future__ import annotations

import gcxform as gx
from gcxform.flow.straightened import written_out
from gcxform.flow.translated import Translated
from gcxform.plugin.registry import default_registry
from gcxform.syntax.source import Source


def written_blocks(language: str, text: str) -> tuple[gx.Pipeline, Translated]:
    """Return a pipeline that writes programs for their own control anew, and blocks of one."""
    dialect = default_registry().dialect(language)
    target = type("Copy", (dialect,), {"__module__": __name__})
    pipeline = gx.Pipeline(dialect, target, ())
    source = Source.of_bytes(text.encode())
    made = written_out(source, dialect, pipeline.machine_reading, pipeline.target)
    assert isinstance(made, Translated)
    return pipeline, made

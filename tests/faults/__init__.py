"""Small faults in the arithmetic, a file for each topic; `tests/mutations.py` runs them."""

from __future__ import annotations

from faults import (
    arcs,
    ballbar,
    calibrating,
    commands,
    computing,
    cutter,
    cycles,
    flow,
    frames,
    kinematics,
    passes,
    proof,
    reading,
    rotary,
    rtcp,
    simulating,
    splines,
    tables,
    thermal,
    tied,
    turned,
    writing,
)
from faults.mutation import Mutation

MUTATIONS: tuple[Mutation, ...] = (
    *cycles.MUTATIONS,
    *flow.MUTATIONS,
    *commands.MUTATIONS,
    *computing.MUTATIONS,
    *frames.MUTATIONS,
    *cutter.MUTATIONS,
    *passes.MUTATIONS,
    *reading.MUTATIONS,
    *writing.MUTATIONS,
    *arcs.MUTATIONS,
    *splines.MUTATIONS,
    *thermal.MUTATIONS,
    *tied.MUTATIONS,
    *turned.MUTATIONS,
    *tables.MUTATIONS,
    *proof.MUTATIONS,
    *rtcp.MUTATIONS,
    *ballbar.MUTATIONS,
    *calibrating.MUTATIONS,
    *simulating.MUTATIONS,
    *rotary.MUTATIONS,
    *kinematics.MUTATIONS,
)

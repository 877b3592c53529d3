"""Faults of what hosts are told and given."""

from __future__ import annotations

from faults.mutation import Mutation

HOSTS = "tests/test_hosts.py"

MUTATIONS = (
    Mutation(
        "hosts: a filter prints nothing of what was done before",
        "gcxform/cli/common/several.py",
        "put(source.stream.read())",
        "put(source.stream.read(0))",
        HOSTS,
    ),
    Mutation(
        "hosts: a filter says nothing of how far it is",
        "gcxform/cli/common/transform.py",
        "kind = FilterProgress if job.filters else Progress",
        "kind = Progress",
        HOSTS,
    ),
    Mutation(
        "hosts: a blank ends a path",
        "gcxform/cli/host/hosts.py",
        "else shlex.join(words)",
        'else " ".join(words)',
        HOSTS,
    ),
    Mutation(
        "hosts: a pipe is taken for a file that is replaced",
        "gcxform/cli/common/transform.py",
        "if job.out == job.file != STDOUT and not",
        "if job.out == job.file and not",
        HOSTS + "::test_a_pipe_has_both_ends",
    ),
)

"""A process that lacks what another system lacks, and runs command lines of gcxform in it.

    python foreign.py SYSTEM STDIN < [["run", ...], ...]  prints [[code, stdout, stderr], ...]

Taken away before gcxform is imported: modules, which then fail to import, and functions, signals
and flags. What these packages of others import is theirs and comes first. `tests/test_systems.py`
compares what comes out with what comes out here.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import multiprocessing.connection  # noqa: F401
import os
import signal
import sys
from types import SimpleNamespace
from typing import Any

import click.testing
import numpy as np  # noqa: F401
import scipy.linalg
import scipy.optimize
import scipy.sparse.linalg  # noqa: F401

with contextlib.suppress(ImportError):
    import watchdog.observers  # noqa: F401

POSIX_MODULES = (
    *("fcntl", "resource", "pwd", "grp", "spwd", "termios", "tty", "pty", "curses", "readline"),
    *("syslog", "crypt", "nis"),
)
LACKS = {
    "windows": {
        os: (
            *("fork", "forkpty", "memfd_create", "pread", "pwrite", "preadv", "pwritev", "nice"),
            *("getuid", "geteuid", "getgid", "getegid", "getgroups", "setsid", "killpg", "mkfifo"),
            *("O_NONBLOCK", "O_NOFOLLOW", "O_DIRECTORY", "O_SYNC", "fchmod", "fchown", "chown"),
            *("lchown", "wait", "waitid", "wait3", "wait4", "sysconf", "uname", "ttyname"),
            *("sched_getaffinity", "posix_fadvise", "sendfile", "statvfs", "register_at_fork"),
        ),
        signal: (
            *("SIGHUP", "SIGKILL", "SIGIO", "SIGPIPE", "SIGUSR1", "SIGUSR2", "SIGALRM", "SIGCHLD"),
            *("SIGQUIT", "SIGTSTP", "pthread_sigmask", "pthread_kill", "alarm", "setitimer"),
        ),
    },
    "macos": {
        os: ("memfd_create", "sched_getaffinity", "posix_fadvise"),
        signal: ("SIGRTMIN", "SIGRTMAX", "sigtimedwait", "sigwaitinfo"),
    },
}
PLATFORM = {"windows": "win32", "macos": "darwin"}


class NoLibrary:
    """`ctypes.CDLL(None)` of a system: an error, or a library without GNU's functions."""

    def __init__(self, *_: object) -> None:
        if sys.platform == "win32":
            raise TypeError("argument of type 'NoneType' is not iterable")


def become(system: str) -> None:
    """Take away what a system lacks."""
    for module in POSIX_MODULES if system == "windows" else ():
        sys.modules[module] = None  # type: ignore[assignment]
    for module, names in LACKS[system].items():
        for name in names:
            if hasattr(module, name):
                delattr(module, name)
    proxies = SimpleNamespace(_get_proxy_settings=dict, _get_proxies=dict)
    sys.modules["_scproxy"] = proxies  # type: ignore[assignment]
    if system == "windows":
        locks = SimpleNamespace(LK_NBLCK=2, locking=lambda handle, mode, size: None)
        sys.modules["msvcrt"] = locks  # type: ignore[assignment]
    sys.platform = PLATFORM[system]
    ctypes.CDLL = NoLibrary  # type: ignore[misc,assignment]
    opened = open

    def without_proc(file: Any, *given: Any, **more: Any) -> Any:
        if str(file).startswith(("/proc/", "/dev/")):
            raise FileNotFoundError(2, "No such file or directory", file)
        return opened(file, *given, **more)

    __builtins__.open = without_proc


def main() -> None:
    """Run the command lines."""
    commands = json.load(sys.stdin)
    os.dup2(os.open(sys.argv[2], os.O_RDONLY), 0)
    become(sys.argv[1])
    from gcxform.cli import verbs

    found = []
    for words in commands:
        done = click.testing.CliRunner().invoke(verbs, words, prog_name="gcxform")
        found.append([done.exit_code, done.stdout, done.stderr])
    json.dump(found, sys.stdout)


if __name__ == "__main__":
    main()

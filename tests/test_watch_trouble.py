"""The hot folder on disks and shares that fail: a program is done later, never twice or half."""

from __future__ import annotations

import errno
import os
import random
import shutil
import subprocess
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import pytest
from cli_kit import ABSOLUTE, PART, PIPELINE, call
from test_watch import ONCE, Clock, Shop, tree

from gcxform.cli.watching.whole_files import Settling
from gcxform.cli.watching.work import Work

CALLS = ("rename", "replace", "link", "unlink", "open", "mkdir", "fsync")
NUMBERS = {
    "a disk is full": errno.ENOSPC,
    "a disk is broken": errno.EIO,
    "a share has gone": errno.ESTALE,
    "somebody has it open": errno.EACCES,
}


@contextmanager
def failing(number: int, fails: Callable[[], bool], names: tuple[str, ...]) -> Iterator[None]:
    """Let calls of the system fail with an error where `fails` says so."""
    kept = {name: getattr(os, name) for name in names}

    def failing_one(name: str) -> Callable[..., Any]:
        def run(*given: Any, **more: Any) -> Any:
            if fails():
                raise OSError(number, os.strerror(number))
            return kept[name](*given, **more)

        return run

    for name in names:
        setattr(os, name, failing_one(name))
    try:
        yield
    finally:
        for name, function in kept.items():
            setattr(os, name, function)


def round_of(work: Work, folder: Path) -> None:
    """Look and work once, an hour later, as the loop does; what it raises ends the watcher."""
    work.clock.now += 3600.0  # type: ignore[attr-defined]
    names = Settling(folder, 0.0).whole()
    work.again()
    for name in names:
        work.take(name)


@pytest.mark.parametrize("trouble", NUMBERS)
@pytest.mark.parametrize("text", [b"good", b"bad"])
def test_each_call_may_fail_and_each_program_is_done_once(
    trouble: str, text: bytes, tmp_path: Path
) -> None:
    """Every call that changes anything fails once, and half of those behind it now and then."""
    for at in range(120):
        folder = tmp_path / f"{at}"
        folder.mkdir()
        shop, calls, draw = Shop(folder), [0], random.Random(at)
        (folder / "a.nc").write_bytes(text)

        def fails(at: int = at, calls: list[int] = calls, draw: random.Random = draw) -> bool:
            calls[0] += 1
            return calls[0] == at + 1 or (calls[0] > at and draw.random() < 0.3)

        work = shop.work()
        with failing(NUMBERS[trouble], fails, CALLS):
            for _ in range(6):
                with suppress(OSError):  # the watcher ends, and its service starts another
                    round_of(work, folder)
                    continue
                work = shop.work()
                with suppress(OSError):
                    work.recover()
        reached = calls[0] > at
        shop.consume()
        work = shop.work()
        work.recover()
        for _ in range(2):
            round_of(work, folder)
        shop.consume()
        left = {n: t for n, t in tree(folder).items() if not n.startswith(".")}
        if text == b"good":
            assert (shop.seen, left) == (Counter(["a.nc"]), {"done/a.nc": b"good"}), at
        else:
            left.pop(reason := "failed/a.nc.gcxform.txt")
            assert (shop.seen, left) == (Counter(), {"failed/a.nc": b"bad"}), (at, reason)
        if not reached:
            break
    assert 5 < at < 119


def test_a_clock_of_two_seconds_hides_nothing(tmp_path: Path) -> None:
    """FAT and some shares keep times in steps of 2 s; a file that grows meanwhile is not whole."""
    clock, file = Clock(), tmp_path / "a.nc"
    settling = Settling(tmp_path, 2.0, clock)
    for later, size, whole in ((0.0, 4, False), (1.5, 8, False), (1.9, 8, False), (0.2, 8, True)):
        clock.now += later
        file.write_bytes(b"G" * size)
        os.utime(file, (1_000_000, 1_000_000))
        assert bool(settling.whole()) == whole


# --- file systems that are really so ---


def ready(program: str) -> str:
    found = shutil.which(program)
    if found is None or not hasattr(os, "geteuid") or os.geteuid() != 0:
        pytest.skip(f"{program} is not here, or nothing can be mounted")
    return found


@contextmanager
def mounted(folder: Path, *command: str) -> Iterator[Path]:
    """Mount a file system on a folder; skip where that is not allowed."""
    folder.mkdir()
    done = subprocess.run([*command, str(folder)], capture_output=True, text=True, check=False)
    if done.returncode:
        pytest.skip(f"nothing can be mounted here: {done.stderr.strip()}")
    try:
        yield folder
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=False)


@pytest.fixture
def small(tmp_path: Path) -> Iterator[Path]:
    """Return a folder on another device, which takes 48 kB."""
    mount = ready("mount")
    with mounted(tmp_path / "other", mount, "-t", "tmpfs", "-o", "size=48k", "none") as folder:
        yield folder


def test_results_may_go_to_another_device(small: Path, tmp_path: Path) -> None:
    """What is moved from one folder to another stays on its device."""
    hot = tmp_path / "hot"
    hot.mkdir()
    (hot / "part.nc").write_bytes(PART)
    (hot / "gcxform.toml").write_text(PIPELINE)
    found = call("watch", *ONCE, "-o", str(small / "out"), str(hot))
    assert found.exit_code == 0, found.output
    assert (small / "out" / "part.nc").read_bytes() == ABSOLUTE
    assert (hot / "done" / "part.nc").read_bytes() == PART


def test_a_disk_that_is_full_has_nothing_half(small: Path, tmp_path: Path) -> None:
    """The result appears when there is room again; until then the program waits."""
    hot = tmp_path / "hot"
    hot.mkdir()
    (hot / "part.nc").write_bytes(PART)
    (hot / "gcxform.toml").write_text(PIPELINE)
    words = ("watch", *ONCE, "-o", str(small / "out"), str(hot))
    (small / "out").mkdir()
    (small / "fill").write_bytes(b"")
    with suppress(OSError), (small / "fill").open("wb", buffering=0) as stream:
        while stream.write(b"x" * 4096):
            pass
    full = call(*words)
    assert full.exit_code == 5
    assert "No space left on device" in full.output
    assert [p for p in (small / "out").rglob("*") if p.is_file()] == []
    (small / "fill").unlink()
    again = call(*words)
    assert again.exit_code == 0, again.output
    assert (small / "out" / "part.nc").read_bytes() == ABSOLUTE
    assert (hot / "done" / "part.nc").read_bytes() == PART


@pytest.fixture
def exfat(tmp_path: Path) -> Iterator[Path]:
    """Return a folder that takes no notice of case and has no links: a memory stick, a share."""
    make, mount = ready("mkfs.exfat"), ready("mount.exfat-fuse")
    with (tmp_path / "image").open("wb") as image:
        image.truncate(8 << 20)
    show = ["losetup", "-f", "--show", str(tmp_path / "image")]
    found = subprocess.run(show, capture_output=True, text=True, check=False)
    if found.returncode:
        pytest.skip("there are no loop devices")
    device = found.stdout.strip()
    try:
        subprocess.run([make, device], capture_output=True, check=True)
        with mounted(tmp_path / "stick", mount, device) as folder:
            yield folder
    finally:
        subprocess.run(["losetup", "-d", device], check=False)


def test_a_folder_without_links_and_case(exfat: Path) -> None:
    (exfat / "gcxform.toml").write_text(PIPELINE)
    assert (exfat / "GCXFORM.toml").exists()
    (exfat / "Subs").mkdir()
    (exfat / "Subs" / "O7.NC").write_bytes(b"O7\nG91 X1.\nM99\n")
    for number in range(3):
        (exfat / "Part.nc").write_bytes(PART.replace(b"X10", b"X1%d" % number))
        found = call("watch", *ONCE, str(exfat))
        assert found.exit_code == 0, found.output
        assert b"X1%d." % number in (exfat / "out" / "Part.nc").read_bytes()
    done = {name for name in os.listdir(exfat / "done") if name.endswith(".nc")}
    assert done == {"Part.nc", "Part.2.nc", "Part.3.nc"}
    main = exfat / "main.nc"
    main.write_bytes(b"O1\nG21 G90 G94\nG0 X0. Y0. Z0.\nM98 P7\nM30\n")
    words = ("run", "-q", "-f", "fanuc", "-x", "absolute", "--subprograms")
    for name in ("Subs", "SUBS"):
        done_ = call(*words, str(exfat / name), str(main))
        assert done_.exit_code == 0, done_.output
        assert b"X1." in done_.stdout_bytes
    same = call(*words, str(exfat / "Subs"), str(main), "-o", str(exfat / "MAIN.NC"))
    assert (same.exit_code, "GX7" in same.stderr) == (2, True), same.output


def test_a_program_that_cannot_be_read_is_called_by_its_name(tmp_path: Path) -> None:
    """Where it lies while it is worked on is no matter of who dropped it."""
    (tmp_path / "part.nc").write_bytes("G21 G90\r\nM2\r\n".encode("utf-16"))
    (tmp_path / "gcxform.toml").write_text(PIPELINE)
    found = call("watch", *ONCE, str(tmp_path))
    assert found.stdout == "part.nc: failed   error[GX901]: part.nc is not a program of bytes\n"
    said = (tmp_path / "failed" / "part.nc.gcxform.txt").read_text()
    assert ".gcxform" not in said

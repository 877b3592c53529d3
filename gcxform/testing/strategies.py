"""Hypothesis strategies for plugin authors: whole programs, and lines of arbitrary bytes.

Needs hypothesis, which is not a dependency of the package.
"""

from collections.abc import Callable
from functools import cache

from hypothesis import strategies as st
from hypothesis.strategies import DrawFn, SearchStrategy

from gcxform.testing.generate import Options, program

TEXTS = (
    "G0|G1 X10 Y-2.5 F100|G2 X1 Y0 I.5 J0|g03x1y1r5|G90|G91|G93|G95|G20|G21|G17|M3 S1000|T1 M6|"
    "M30|M2|%|O1234|N10|/|/2|(comment)|(open|close)|((nested))|; to the end|X|X.|X--5|X1e3|X1.2.3|"
    "X 1 . 5|#1=2|X#1|X[1+2]|G4 P1|G999|M999|*12|$H|"
    "\xef\xbb\xbf|\xe4\xf6\xfc|\x00|\r|\t| |\x0b|\x1a|\x7f"
)
FRAGMENTS = tuple(TEXTS.encode("latin-1").split(b"|"))
ENDINGS = (b"\n", b"\r\n", b"\r", b"\n\r", b"", b"\x00\n")


@cache
def _integers(low: int, high: int) -> SearchStrategy[int]:
    return st.integers(low, high)


def programs(
    dialect: str = "linuxcnc",
    *,
    arcs: bool = True,
    incremental: bool = True,
    inches: bool = True,
    rotary: bool = True,
    feed_modes: bool = True,
    planes: bool = True,
    max_blocks: int = 30,
) -> SearchStrategy[bytes]:
    """Draw whole programs that a control accepts, as bytes.

    The control is "linuxcnc", "fanuc", "haas" or "grbl". The programs use lines, rapids, arcs in
    every form the dialect has, dwell, spindle, coolant, tools, comments and many spellings; every
    mode and, absolutely, every axis used is programmed first. Each keyword set to False leaves that
    part of the language out. GRBL has no rotary axes.
    """
    options = Options(
        dialect, arcs, incremental, inches, rotary, feed_modes, planes, max_blocks=max_blocks
    )
    return _programs(options)


@st.composite
def _programs(draw: DrawFn, options: Options) -> bytes:
    def pick(low: int, high: int) -> int:
        return draw(_integers(low, high))

    return program(pick, options)


def lines_of_bytes(max_lines: int = 20) -> SearchStrategy[bytes]:
    """Draw arbitrary bytes that look like programs here and there.

    Fragments of blocks and random bytes, with NUL, byte-order mark, Latin-1, all line endings
    and none.
    """
    piece = st.one_of(
        st.sampled_from(FRAGMENTS),
        st.binary(max_size=8),
        st.text("GMXYZIJKRFNSTP0123456789.-+ ", max_size=12).map(str.encode),
    )
    line = st.tuples(st.lists(piece, max_size=6).map(b" ".join), st.sampled_from(ENDINGS))
    joined: Callable[[tuple[bytes, bytes]], bytes] = b"".join
    return st.lists(line.map(joined), max_size=max_lines).map(b"".join)

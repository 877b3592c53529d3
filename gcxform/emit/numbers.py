"""Numbers to text, a column at a time.

A coordinate is first rounded to a whole number of its last decimal, half away from zero: that
integer is what the control believes. Its text is put together from tables of ready-made digits.
Fields are padded with NUL, which the emitter drops when it puts the lines together.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from gcxform.system.arrays import Bytes, Flags, Floats

TIE = 1e-6  # of the last decimal: what is so close to a half is a half
MOST_DECIMALS = 6
LARGEST = 10**8  # a number has at most eight digits before the point


def quantise(value: Floats, decimals: int) -> Floats:
    """Return value * 10**decimals rounded to whole numbers, half away from zero; nan stays."""
    scaled = value * 10.0**decimals
    whole = np.floor(np.abs(scaled) + (0.5 + TIE))
    return np.copysign(whole, scaled)


def decimals_for(value: Floats, usual: int) -> int:
    """Return as many decimals as keep values to a ten thousandth: small feeds need more."""
    for decimals in range(usual, MOST_DECIMALS):
        error = np.abs(quantise(value, decimals) / 10.0**decimals - value)
        if (error <= 1e-4 * np.abs(value)).all():
            return decimals
    return MOST_DECIMALS


def decimals_of(value: Floats) -> int:
    """Return the least number of decimals with which values are written to the last bit."""
    few = range(MOST_DECIMALS)
    exact = (d for d in few if (quantise(value, d) / 10.0**d == value).all())
    return next(exact, MOST_DECIMALS)


@cache
def _whole_digits() -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Return the text of 0 ... 9999, without and with leading zeros, as four bytes each."""
    number = np.arange(10_000)
    digits = np.stack([number // 1000, number // 100 % 10, number // 10 % 10, number % 10], axis=1)
    padded = (digits + 48).astype(np.uint8)
    leading = np.cumsum(digits, axis=1) == 0
    leading[:, -1] = False
    bare = np.where(leading, 0, padded).astype(np.uint8)
    return bare.view(np.uint32)[:, 0], padded.view(np.uint32)[:, 0]


@cache
def _fractions(decimals: int, zeros: bool, point: bool) -> NDArray[np.uint32] | NDArray[np.uint64]:
    """Return the texts `.000` ... `.999`, trailing zeros cut unless `zeros`, as 4 or 8 bytes."""
    number = np.arange(10**decimals)
    text = np.zeros((len(number), 4 if decimals < 4 else 8), np.uint8)
    text[:, 0] = 46
    keep = np.full(len(number), zeros)
    for place in range(decimals, 0, -1):
        digit = number // 10 ** (decimals - place) % 10
        keep |= digit > 0
        text[:, place] = np.where(keep, digit + 48, 0)
    if not point:
        text[~keep, 0] = 0
    return text.view(np.uint32)[:, 0] if decimals < 4 else text.view(np.uint64)[:, 0]


def number_field(
    whole: Floats, decimals: int, zeros: bool, present: Flags, point: bool = True
) -> Bytes:
    """Return the texts (n, width) of whole / 10**decimals, padded with NUL; empty if not present.

    `point`: the point stays when no decimal follows it. |whole| is below LARGEST * 10**decimals.
    """
    everywhere = bool(present.all())
    magnitude = np.abs(whole) if everywhere else np.where(present, np.abs(whole), 0.0)
    number = magnitude.astype(np.int64)
    integer = number // 10**decimals
    fraction = _fractions(decimals, zeros, point)
    bare, padded = _whole_digits()
    words = [fraction[number - integer * 10**decimals]]
    if (integer > 9999).any():
        high = integer // 10_000
        low = integer - high * 10_000
        words = [np.where(high > 0, padded[low], bare[low]), *words]
        words = [np.where(high > 0, bare[high], np.uint32(0)), *words]
    else:
        words = [bare[integer], *words]
    if not everywhere:
        words = [np.where(present, word, word.dtype.type(0)) for word in words]
    field = np.empty((len(whole), 1 + sum(word.dtype.itemsize for word in words)), np.uint8)
    field[:, 0] = np.where(present & (whole < 0), 45, 0)
    column = 1
    for word in words:
        np.ndarray(len(whole), word.dtype, field, column, field.strides[:1])[:] = word
        column += word.dtype.itemsize
    return field


def text_of(value: float, decimals: int, zeros: bool = False, point: bool = True) -> str:
    """Return the text of one number."""
    whole = quantise(np.array([value]), decimals)
    field = number_field(whole, decimals, zeros, np.array([True]), point)
    return field.tobytes().replace(b"\0", b"").decode()

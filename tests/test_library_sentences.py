"""Sentences of other libraries that are taken apart, because the libraries give nothing better.

Where one of these fails after an update, what takes the sentence apart is to be mended; else users
would be told the right thing at no place, or in the words of Python.
"""

from __future__ import annotations

import re
import tomllib
from enum import StrEnum
from typing import Literal

import msgspec
import numpy as np
import pytest

from gcxform.config import toml_text


class Colour(StrEnum):
    RED = "red"


class Part(msgspec.Struct, forbid_unknown_fields=True):
    size: float
    colour: Colour | None = None
    kind: Literal["a", "b"] | None = None


class Whole(msgspec.Struct, forbid_unknown_fields=True):
    parts: list[Part] = []
    named: dict[str, Part] = {}


def refusal(values: object) -> str:
    with pytest.raises(msgspec.ValidationError) as caught:
        msgspec.convert(values, Whole)
    return str(caught.value)


@pytest.mark.parametrize(
    ("values", "sentence"),
    [
        ({"x": 1}, "Object contains unknown field `x`"),
        ({"parts": [{}]}, "Object missing required field `size` - at `$.parts[0]`"),
        ({"parts": [{"size": "1"}]}, "Expected `float`, got `str` - at `$.parts[0].size`"),
        ({"named": {"n": {"size": True}}}, "Expected `float`, got `bool` - at `$.named[...].size`"),
        ({"parts": {}}, "Expected `array`, got `object` - at `$.parts`"),
        (
            {"parts": [{"size": 1, "colour": "blue"}]},
            "Invalid enum value 'blue' - at `$.parts[0].colour`",
        ),
        (
            {"parts": [{"size": 1, "kind": "c"}]},
            "Invalid enum value 'c' - at `$.parts[0].kind`",
        ),
        (
            {"parts": [{"size": 1, "kind": 2}]},
            "Expected `str | null`, got `int` - at `$.parts[0].kind`",
        ),
    ],
)
def test_msgspec(values, sentence):
    assert refusal(values) == sentence


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("a = [1,\nb", "Invalid value (at line 2, column 1)"),
        ("a = 1\na = 2\n", "Cannot overwrite a value (at line 2, column 6)"),
        ("a = [1,", "Invalid value (at end of document)"),
    ],
)
def test_tomllib(text, sentence):
    with pytest.raises(tomllib.TOMLDecodeError) as caught:
        tomllib.loads(text)
    assert str(caught.value) == sentence
    assert toml_text._AT.fullmatch(sentence)


def test_numpy():
    locked = np.zeros(1)
    locked.flags.writeable = False
    with pytest.raises(ValueError, match=re.escape("read-only")):
        locked[0] = 1.0

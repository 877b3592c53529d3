"""How generated blocks look: spelling of numbers, order and spacing of words, comments."""

from collections.abc import Callable

Words = list[tuple[str, str]]
GRBL_LINE = 79  # characters without blanks and comments
REMARKS = ("ROUGHING", "tool 3: 10 mm", "G1 X99 F5", "", "50% ; done", "a, b + c")


def number(value: float, places: int) -> str:
    """Return a number with at most `places` decimals, without exponent and without -0."""
    text = f"{value:.{places}f}"
    if "." in text:
        text = text.rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


class Layout:
    """Draws spellings which the control reads alike."""

    def __init__(self, pick: Callable[[int, int], int], dialect: str) -> None:
        self.pick = pick
        self.dialect = dialect
        self.pointed = dialect in ("fanuc", "haas")
        self.sequence = 0
        self.numbered = self.chance(25)
        self.lower = dialect != "fanuc" and self.chance(15)
        self.gap = (" ", "", "  ", "\t")[self.pick(0, 2 if self.pointed else 3)]
        self.padded = self.chance(20)

    def chance(self, percent: int) -> bool:
        """Return True in about that many of a hundred cases; shrinks to False."""
        return self.pick(0, 99) >= 100 - percent

    def number(self, text: str) -> str:
        """Respell a number: `5.`, `5.00`, `.5`, `+5`, `05`; where it matters with a point."""
        style = self.pick(0, 11)
        if "." not in text and (style == 1 or self.pointed):
            text += "."
        elif "." in text and style == 2:
            text += "0"
        elif "." not in text and style == 2:
            text += ".00"
        sign, digits = ("-", text[1:]) if text.startswith("-") else ("", text)
        if style == 3 and not sign:
            sign = "+"
        elif style == 4:
            digits = "0" + digits
        elif style <= 6 and digits.startswith("0."):
            digits = digits[1:] if len(digits) > 2 else digits
        return sign + digits

    def remark(self) -> str:
        """Return a line without words: a comment or nothing."""
        text = REMARKS[self.pick(0, len(REMARKS) - 1)]
        if self.pointed:
            return f"({text.upper()})"
        return (f"({text})", f"; {text}", "")[self.pick(0, 2)]


def write(words: Words, layout: Layout, *, plain: bool = False) -> str:
    """Return the line of a block; `plain` keeps the order and adds nothing but a number."""
    items = list(words)
    if not plain and layout.chance(20):
        items = _shuffled(items, layout)
    texts = [letter + _code(letter, text, layout) for letter, text in items]
    if layout.numbered:
        layout.sequence += 10
        texts.insert(0, f"N{layout.sequence}")
    if layout.dialect == "grbl" and len("".join(texts)) > GRBL_LINE:
        raise AssertionError("a drawn block is longer than GRBL's line")
    if not plain and layout.chance(6):
        texts = _commented(texts, layout)
    line = layout.gap.join(texts)
    if not plain and not layout.pointed and layout.chance(3):
        line = _loosened(line)
    return line.lower() if layout.lower else line


def _shuffled(items: Words, layout: Layout) -> Words:
    """Return the words in another order."""
    rest, out = list(items), []
    while rest:
        out.append(rest.pop(layout.pick(0, len(rest) - 1)))
    return out


def _code(letter: str, text: str, layout: Layout) -> str:
    """Return the digits of a G or M code, with a leading zero at times."""
    padded = layout.padded and letter in "GM" and len(text) == 1
    return "0" + text if padded else text


def _commented(texts: list[str], layout: Layout) -> list[str]:
    """Put a comment at the end of the block, or between two words."""
    at = layout.pick(0, 1)
    if layout.pointed or at:
        return [*texts, "(CUT)"]
    return [texts[0], "(cut)", *texts[1:]] if layout.pick(0, 1) else [*texts, "; cut"]


def _loosened(line: str) -> str:
    """Put blanks inside the words, which the control takes out again."""
    return line if "(" in line or ";" in line else " ".join(line)

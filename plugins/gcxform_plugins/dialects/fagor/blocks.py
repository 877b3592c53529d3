"""Blocks of a Fagor 8065 as blocks of words; the table of facts is in `dialect.py`."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence

import gcxform as gx
from gcxform_plugins.dialects.fagor import tables as tables
from gcxform_plugins.dialects.fagor.places import Places, code_of
from gcxform_plugins.dialects.shared.own_functions import INERT, OF_BUILDER
from gcxform_plugins.dialects.shared.tips_left import goes_along
from gcxform_plugins.dialects.shared.ways import IN_SPINDLE

PLANES = frozenset({"G17", "G18", "G19"})
NO_EDGE = "which D is in force after a tool change that names none is the control's choice"
EDGE_EARLY = "whether a D acts before the tool that it is for is changed is not certain"
ACROSS = "in G18 and G19 the length of the tool may be across the plane, and not along Z"
ALONG = 'write G17 before; or say tool-length-axis = "Z" in [control], if it stays there'
NO_OFFSET = "G53 has cancelled the work offset, and where the zero is then only the control knows"
IN_MACHINE = frozenset(("", "G0", "G1", "G90", "M3", "M4", "M5", "M7", "M8", "M9"))
"""Codes that are read in lines to places of the machine."""
NO_TOOL = "write T and M6 before"
WHOLE = re.compile(r"[0-9]+\Z")
SHIFTS = "another work offset or tool length: whether it makes up for the difference is not certain"


class Blocks(gx.Translator):
    """Turns blocks of a Fagor into blocks of words.

    `bars` are the reasons for which nothing may move at present, and what lifts them. `bare`: D0 is
    in force; `machine`: coordinates are those of the machine; `comp`: G41 or G42 is in force.
    """

    grammar = ("gcxform_grammars", "fagor")
    number = gx.NUMBER_OF_WORD
    signs = re.compile(
        rb"(?im)^[^(;\n]*(?:#(?:RTCP|TLC|CS|ACS|MCS|KIN|HSC|P?CALL|MCALL|RET)\b"
        rb"|\$(?:IF|FOR|WHILE|GOTO|SWITCH)\b|[XYZ]-?[0-9.]+I(?![-+.0-9 \t=\[]))"
        rb"|^%(?!O[0-9])[A-Z][A-Z0-9_]{0,13}[ \t]*$"
    )

    def __init__(self, *given: object) -> None:
        super().__init__(*given)  # type: ignore[arg-type]
        self.places = Places(self)
        self.bars: dict[str, tuple[str, str]] = {}
        self.incremental = self.following = self.taken_away = False
        self.corners = self.kinematics = ""
        self.tool = self.edge = ""
        self.in_spindle = "" if self.reading.tool is None else str(self.reading.tool)
        self.changing = self.across = self.long = False
        self.bare = self.machine = self.comp = False
        self.work, self.shifted = "", set[str]()
        """The work offset in force, and the axes that have not been told since where they count
        from has changed."""

    def plain(self, items: Sequence[gx.Item]) -> bool:
        """Whether a block has plain codes and words only, its number before them."""
        names = [code_of(item) or item.name for item in items]
        rest = names[1:] if names[0] == "N" else names
        kinds = {item.kind for item in items}
        if "R" in rest and not {*rest} & {*"XYZ"}:
            return False
        return kinds <= {"code", "word"} and {*rest} <= (tables.PLAIN - PLANES) | tables.PLAIN_WORDS

    def blocks(self, items: Sequence[gx.Item]) -> Iterable[str]:
        """Return the blocks of a line. Raises InputError for what is not read."""
        self.places.arrive()
        named = [each for each in items if each.kind == "header" and self.reading.asides]
        head = [gx.Speller.along(each.name.strip()) for each in named]
        number, items = self._without_marks(items)
        items = self.cartesian(items)
        preset = self.preset(items)
        if preset is not None:
            blocks = preset
        elif any(item.kind == "statement" for item in items):
            blocks = [*self._statement(items)]
        else:
            blocks = [*self._block(items)]
        self.plainly = not (self.bars or self.machine or self.shifted)
        self.places.note(items)
        return [*head, f"{number}{blocks[0]}", *blocks[1:]] if blocks else head

    def _without_marks(self, items: Sequence[gx.Item]) -> tuple[str, list[gx.Item]]:
        """Return the sequence number, and what stands behind it and the labels."""
        rest, number = list(items), ""
        if rest and rest[0].kind == "header":
            return "", self._without_header(rest)
        if rest and rest[0].name == "N" and rest[0].kind == "word":
            number = f"N{rest.pop(0).numbers[0]} "
            rest = rest[1:] if rest and rest[0].kind == "colon" else rest
        while rest and rest[0].kind == "label":
            rest.pop(0)
        return number, rest

    def _without_header(self, items: list[gx.Item]) -> list[gx.Item]:
        """Leave the name of the program out. Raises InputError where it is none."""
        name = items.pop(0)
        before = (item for line in range(self.line) for item in self.items(line))
        if re.match(r"%[ \t]*L", name.name) or any(item.kind != "comment" for item in before):
            self.refuse("here another program begins, or a subroutine", name)
        return items

    def cartesian(self, items: Sequence[gx.Item]) -> Sequence[gx.Item]:
        """Return the items of a block without polar words. Raises InputError."""
        return items

    def preset(self, items: Sequence[gx.Item]) -> list[str] | None:
        """Return the blocks of what sets a pole or turns, None for other blocks."""
        del items
        return None

    # --- blocks of words ---

    def _block(self, items: Sequence[gx.Item]) -> Iterator[str]:
        """Yield the blocks of a line of words."""
        for item in items:
            self._check(item)
        codes = {code_of(item): item for item in items if item.kind == "code"}
        if self.machine:
            yield self._in_machine(items)
            return
        if "G4" in codes:
            yield self._dwell(items)
            return
        self._note(codes, items)
        self._compensates(codes, items)
        moved = [item for item in items if item.name in tables.AXES | {*"IJKR"}]
        change = [item for item in items if item.name in ("T", "D") or code_of(item) == "M6"]
        length = self._changed(change, moved) if change else ""
        self._turned(codes, length)
        if moved:
            self._move(moved[0])
        self._shift(items, length)
        words = [word for item in items for word in self._said(item)]
        words, after = self._relative(items, words)
        if "G6" in codes:
            if sum(item.name in {*"IJK"} for item in items) != 2:
                self.refuse("G6 is read with both words of a centre", codes["G6"])
            words, after = ["G90.1", *words], ["G91.1", *after]
        if "G50" in codes and self.reading.asides:
            words.append(gx.Speller.along("G50"))
        if "G60" in codes:
            after += self._corner_again(codes["G60"])
        yield from [" ".join(words)] if words else []
        yield from [length] if length else []
        yield from after
        if {"M2", "M30"} & codes.keys():
            self.at = len(self.lines)

    def _check(self, item: gx.Item) -> None:
        """Refuse an item that is not read in a block of words."""
        code = code_of(item)
        if item.kind in tables.KINDS:
            hint = tables.HINTS.get(item.kind, "let the CAM write plain blocks")
            shown = item.name if item.kind != "ambiguous" else f"{item.name}{item.numbers[0]}I"
            self.refuse(f"{shown.strip()} is not resolved: {tables.KINDS[item.kind]}", item, hint)
        if item.kind in ("header", "label", "colon") or item.name == "N":
            raise self.refusal("GX101", "this stands only at the head of a block", item)
        if code == "G70" and self.reading.control.get("inch-feeds") is None:
            self.refuse(f"G70 is not resolved: {tables.INCHES}", item, tables.SAY_INCHES)
        if code in tables.REFUSED:
            self.refuse(f"{code} is not resolved: {tables.REFUSED[code]}", item)
        own = tables.own_m(code)
        if own is not None and own not in self.reading.inert_m:
            self.refuse(f"{code}: {OF_BUILDER}", item, INERT.format(own))
        if code and own is None and code not in tables.CODES | tables.M_CODES:
            raise self.refusal("GX201", f"what {code} does on a fagor is not known here", item)
        words = tables.AXES if item.kind == "incremental" else tables.WORDS
        if item.kind in ("word", "incremental") and item.name not in words:
            what = tables.LACKING.get(item.name, "it is not read")
            self.refuse(f"{item.name} is not resolved: {what}", item)
        if item.kind == "numbered" and (code != "G159" or not self._work(item)):
            self.refuse(f"{code}={item.numbers[0]} is not resolved: only G159=1 to 6 are", item)

    def _work(self, item: gx.Item) -> str:
        """Return the work offset that G159 names, nothing if it is none."""
        return {f"{k + 1}": f"G{54 + k}" for k in range(6)}.get(item.numbers[0], "")

    def _note(self, codes: dict[str, gx.Item], items: Sequence[gx.Item]) -> None:
        """Take notice of modes."""
        if "G61" in codes and not self.reading.stays:
            self._check_rounded(codes["G61"])
        if "G90" in codes or "G91" in codes:
            self.incremental = "G91" in codes
        self.corners = next((tables.CORNERS[c] for c in codes if c in tables.CORNERS), self.corners)
        if tables.WORK & {*codes} or any(item.kind == "numbered" for item in items):
            self.bars.pop("offset", None)
        if "G53" in codes:
            self.bars["offset"] = NO_OFFSET, "write G54 to G59 before the move"

    def _compensates(self, codes: Mapping[str, gx.Item], items: Sequence[gx.Item]) -> None:
        """Take G41 and G42, with the radius of the tool whose D1 is in force."""
        item = next((codes[code] for code in tables.COMP & codes.keys()), None)
        self.comp = (self.comp or item is not None) and "G40" not in codes
        if item is None:
            return
        if not self.long or self.following or any(other.name in ("T", "D") for other in items):
            what = "compensation needs D1 of the tool in the spindle, said before, and no #RTCP"
            self.refuse(what, item, "write T, M6 and D1 before")

    def _shift(self, items: Sequence[gx.Item], length: str) -> None:
        """Take another zero, or another length. Raises InputError for steps behind it.

        On the same control they are the same steps.
        """
        if self.reading.stays:
            return
        work = next((w for item in items for w in self._said(item) if w in tables.WORK), self.work)
        self.shifted |= tables.AXES if self.work and work != self.work else set()
        self.work = work
        for item in items if self.shifted else ():
            if item.name in self.shifted and (item.kind == "incremental" or self.incremental):
                self.refuse(f"a step of {item.name} behind {SHIFTS}", item, tables.TOLD)
            self.shifted.discard(item.name)
        self.shifted |= {"Z"} if length else set()

    def _in_machine(self, items: Sequence[gx.Item]) -> str:
        """Return the block of a move in the coordinates of the machine."""
        for item in items:
            code = code_of(item)
            if code not in IN_MACHINE or item.kind not in ("code", "word"):
                self.refuse("between #MCS ON and #MCS OFF lines to axis words are read", item)
            if item.name in {*"IJKRSTD"} and not code:
                self.refuse("between #MCS ON and #MCS OFF lines to axis words are read", item)
        said = " ".join(word for item in items for word in self._said(item))
        return f"G53 {said}" if any(item.name in tables.AXES for item in items) else said

    def _move(self, item: gx.Item) -> None:
        """Refuse a move while there is a reason for that."""
        for message, hint in self.bars.values():
            self.refuse(message, item, hint)

    def _said(self, item: gx.Item) -> list[str]:
        """Return the words that an item becomes."""
        code = code_of(item)
        if item.kind == "numbered":
            return [self._work(item)]
        if not code:
            return [item.name + item.numbers[0]] if item.name != "D" else []
        if code in tables.UNSAID or code == "G6":
            return []
        if code in tables.COMP:
            return [code, f"D{self.in_spindle}"]
        return [tables.OTHER.get(code, code)]

    def _relative(self, items: Sequence[gx.Item], words: list[str]) -> tuple[list[str], list[str]]:
        """Return the words of a block with what is incremental, and what stands behind it."""
        marked = [item for item in items if item.kind == "incremental"]
        if not marked or self.incremental:
            return words, []
        known = self.places.of(marked, items)
        if known:
            self.count_on()
            return [known.get(word[0], word) for word in words], []
        absolute = [item for item in items if item.kind == "word" and item.name in tables.AXES]
        if absolute:
            what = f"{marked[0].name} counts from a place that the blocks before do not give"
            hint = "write an I behind all coordinates of the block, or behind none"
            self.refuse(what, marked[0], hint)
        return ["G91", *(word for word in words if word != "G90")], ["G90"]

    def _corner_again(self, item: gx.Item) -> list[str]:
        """Return how corners are taken behind a block with G60."""
        if not self.corners:
            what = "G60 is for one block, and how corners are taken behind it is not known"
            self.refuse(what, item, "write G5, G7 or G50 before")
        return [self.corners] if self.corners != "G61" else []

    def _check_rounded(self, item: gx.Item) -> None:
        """Refuse G61 where it counts whether it is for one block, as G60, and how near it goes."""
        if self.corners != "G64" or self.reading.asides:
            what = "whether G61 is for one block alone, and how near to the corner it goes,"
            self.refuse(f"{what} is not known", item, "write G5, G7 or G50")

    def _dwell(self, items: Sequence[gx.Item]) -> str:
        """Return the block of a dwell in seconds."""
        names = sorted(code_of(item) or item.name for item in items)
        if names != ["G4", "K"] or items[-1].name != "K":
            self.refuse("G4 is read with its time in seconds, K, and nothing else", items[0])
        return f"G4 P{items[-1].numbers[0]}"

    # --- tools ---

    def _changed(self, items: Sequence[gx.Item], moved: Sequence[gx.Item]) -> str:
        """Take notice of T, D and M6, and return the block of the length that is in force then."""
        words = {code_of(item) or item.name: item for item in items}
        if len(words) < len(items):
            raise self.refusal("GX203", "T, D or M6 stands here twice", items[-1])
        for name in {"D", "M6"} & words.keys() if moved else ():
            what = f"{name} beside a move: which is first is not certain"
            self.refuse(what, words[name], tables.ALONE)
        if "T" in words:
            self.tool, self.edge, self.changing = self._whole(words["T"]), "", True
        if "D" in words:
            self.edge = self._whole(words["D"])
            if int(self.edge) > 1:
                what = "a tool of the machine file has one length, that of D1"
                self.refuse(f"D{self.edge} is not resolved: {what}", words["D"])
        if "M6" in words:
            self.in_spindle, self.tool, self.changing = self.tool, "", False
            self.bare = False
            edge, self.edge = self.edge, ""
            if not edge:
                self.bars["length"] = NO_EDGE, "write D1 behind the tool change"
            return self._length(edge, words["M6"]) if edge else ""
        if "D" in words and self.changing:
            self.bars["length"] = EDGE_EARLY, "write D beside M6 or behind it"
        elif "D" in words:
            return self._length(self.edge, words["D"])
        return ""

    def _turned(self, codes: Mapping[str, gx.Item], length: str) -> None:
        """Take notice of planes in which the length of the tool may not be along Z."""
        self.across = bool({"G18", "G19"} & {*codes}) if PLANES & {*codes} else self.across
        self.long = length.startswith("G43") if length else self.long
        self.bare = length == "G49" if length else self.bare
        if self.across and self.long and self.reading.control.get("tool-length-axis") != "Z":
            self.bars["plane"] = ACROSS, ALONG
        else:
            self.bars.pop("plane", None)

    def _whole(self, item: gx.Item) -> str:
        """Return a number that is whole. Raises InputError."""
        if not WHOLE.match(item.numbers[0]):
            self.refuse(f"{item.name} has a number that is not whole", item)
        return str(int(item.numbers[0]))

    def _length(self, edge: str, item: gx.Item) -> str:
        """Return the block that takes the length of the tool in the spindle, or none."""
        self.bars.pop("length", None)
        if edge == "0":
            return "G49"
        if self.in_spindle in ("", "0"):
            what = "D is about the tool in the spindle, and which that is is not known"
            self.refuse(what, item, NO_TOOL if self.in_spindle else IN_SPINDLE)
        return f"G43 H{self.in_spindle}"

    # --- statements ---

    def _statement(self, items: Sequence[gx.Item]) -> list[str]:
        """Return the blocks of a statement. Raises InputError."""
        item = next(item for item in items if item.kind == "statement")
        head, *rest = item.name.split()
        name = " ".join((head, *rest))
        inside = item.names[1:]
        if len(items) > 1:
            self.refuse(f"{name} is read in a block of its own", item, tables.ALONE)
        off = rest == ["OFF"] and (goes_along(self) if head == "#RTCP" else not self.machine)
        along = self._along(item) if off or head not in ("#RTCP", "#MCS") else []
        if head == "#RTCP" and rest in (["ON"], ["OFF"]) and not inside:
            return along or [self._tips(item, rest == ["ON"])]
        if head == "#MCS" and rest in (["ON"], ["OFF"]) and not inside:
            self._machine(item, rest == ["ON"])
            return along
        if head == "#KIN" and rest == ["ID"]:
            self._kinematics(item, inside)
            return along
        if head in tables.INERT or (head in tables.OFF and rest[:1] == ["OFF"]):
            return along
        form = "this form of it is not known here" if head in ("#RTCP", "#KIN") else ""
        what = form or tables.STATEMENTS.get(head, "it is not known here")
        self.refuse(f"{name} is not resolved: {what}", item)

    def _along(self, item: gx.Item) -> list[str]:
        """Return the block of a statement that goes along where all is written anew; or none."""
        raise NotImplementedError

    def _machine(self, item: gx.Item, on: bool) -> None:
        """Take coordinates of the machine, or those of the program again. Raises InputError."""
        if on and (not self.bare or self.incremental or self.following or self.comp):
            what = f"#MCS is not resolved: {tables.STATEMENTS['#MCS']}"
            self.refuse(what, item, "write D0 and G90 before")
        self.machine = on
        self.places.lose()

    def _tips(self, item: gx.Item, on: bool) -> str:
        """Return the code that follows the tip, or leaves it."""
        if on:
            self._move(item)
            if self.taken_away:
                self.refuse("#RTCP ON without kinematics: #KIN ID[0] has taken them away", item)
        self.following = on
        return "M128" if on else "M129"

    def _kinematics(self, item: gx.Item, inside: Sequence[str]) -> None:
        """Take notice of the kinematics that are chosen: those of the machine file are one."""
        chosen = "".join(inside).strip("[] \t")
        if len(inside) != 1 or not WHOLE.match(chosen):
            self.refuse("#KIN ID is read with the number of the kinematics", item, "#KIN ID[1]")
        if self.following:
            self.refuse("#KIN ID while the control follows the tip", item, "write #RTCP OFF before")
        if int(chosen) and self.kinematics not in ("", chosen):
            what = f"#KIN ID[{chosen}] behind #KIN ID[{self.kinematics}]"
            self.refuse(f"{what}: a machine file has one kinematics", item)
        self.taken_away = not int(chosen)
        self.kinematics = self.kinematics if self.taken_away else chosen

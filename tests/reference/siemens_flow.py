"""A SINUMERIK 840D that computes, decides, calls, turns frames and drills: one line at a time.

It is written from manuals and shares nothing with the package: texts are taken apart by hand,
numbers are floats, points are lists. It knows only programs that are right, and gives where the
tool goes in the coordinates outside of the programmable frame.
"""

import math
import re

TOKEN = re.compile(
    r"\s*(\d+\.?\d*|\.\d+|==|<>|>=|<=|[-+*/()\[\],<>]|[A-Z_][A-Z0-9_]*)", re.IGNORECASE
)
LEVELS = [
    {"==", "<>", ">", "<", ">=", "<="},
    {"OR"},
    {"XOR"},
    {"AND"},
    {"+", "-"},
    {"*", "/", "DIV", "MOD"},
]
FUNCTIONS = {
    "SIN": lambda a: math.sin(math.radians(a)),
    "COS": lambda a: math.cos(math.radians(a)),
    "SQRT": math.sqrt,
    "ABS": abs,
    "POT": lambda a: a * a,
    "TRUNC": math.trunc,
    "ROUND": lambda a: math.floor(a + 0.5),
    "ROUNDUP": math.ceil,
    "MINVAL": min,
    "MAXVAL": max,
    "ATAN2": lambda y, x: math.degrees(math.atan2(y, x)),
}
WORD = re.compile(r"(RPL|AP|RP|[A-Z])\s*(=)?\s*", re.IGNORECASE)
NEXT = re.compile(r"\s+(?=(?:AP|RP|[A-Z])\s*=|[A-Z][-+.\d]|[A-Z]+$)", re.IGNORECASE)
CYCLE = re.compile(r"(MCALL\s+)?(CYCLE8[1-9]|HOLES2)\s*\((.*)\)", re.IGNORECASE)
UNITS = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]


def times(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def parted(text):
    """Return what stands between the commas of a text that are in no brackets."""
    found, depth = [""], 0
    for letter in text:
        depth += (letter == "(") - (letter == ")")
        found[-1] += letter
        if letter == "," and not depth:
            found[-1] = found[-1][:-1].strip()
            found.append("")
    return [*found[:-1], found[-1].strip()]


class Machine:
    """What a control has while it executes a program, and the moves that it made."""

    def __init__(self, text, files=None):
        self.lines = text.splitlines()
        self.files = files or {}
        self.r, self.names, self.types = {}, {}, {}
        self.left = {}  # how often each REPEAT of a label goes back yet
        self.at = [0.0, 0.0, 0.0]  # outside
        self.matrix, self.shift = UNITS, [0.0, 0.0, 0.0]
        self.motion, self.steps = "0", False
        self.pole, self.polar = [0.0, 0.0], {}
        self.hole, self.moves = None, []

    # --- values ---

    def value(self, text):
        self.tokens = [m[1] for m in TOKEN.finditer(text)]
        self.k = 0
        return self.level(0)

    def peek(self):
        return self.tokens[self.k].upper() if self.k < len(self.tokens) else ""

    def level(self, n):
        if n == len(LEVELS):
            return self.operand()
        left = self.level(n + 1)
        while self.peek() in LEVELS[n]:
            sign = self.tokens[self.k].upper()
            self.k += 1
            left = self.operated(sign, left, self.level(n + 1))
        return left

    @staticmethod
    def operated(sign, a, b):
        near = abs(a - b) <= 1e-12 * max(abs(a), abs(b))
        return {
            "+": lambda: a + b,
            "-": lambda: a - b,
            "*": lambda: a * b,
            "/": lambda: a / b,
            "DIV": lambda: math.trunc(a / b),
            "MOD": lambda: a - b * math.floor(a / b),
            "AND": lambda: float(bool(a) and bool(b)),
            "OR": lambda: float(bool(a) or bool(b)),
            "XOR": lambda: float(bool(a) != bool(b)),
            "==": lambda: float(near),
            "<>": lambda: float(not near),
            ">": lambda: float(a > b),
            "<": lambda: float(a < b),
            ">=": lambda: float(a > b or near),
            "<=": lambda: float(a < b or near),
        }[sign]()

    def operand(self):
        token = self.tokens[self.k].upper()
        self.k += 1
        if token == "-":
            return -self.operand()
        if token == "NOT":
            return float(not self.operand())
        if token == "(":
            found = self.level(0)
            self.k += 1
            return found
        if token[0].isdigit() or token[0] == ".":
            return float(token)
        if self.peek() in ("(", "["):
            return self.with_brackets(token)
        if re.fullmatch(r"R\d+", token):
            return self.r[int(token[1:])]
        return {"TRUE": 1.0, "FALSE": 0.0}.get(token, self.names.get(token))

    def with_brackets(self, name):
        self.k += 1
        given = [self.level(0)]
        while self.peek() == ",":
            self.k += 1
            given.append(self.level(0))
        self.k += 1
        if name == "R":
            return self.r[int(given[0])]
        return FUNCTIONS[name](*given) if name in FUNCTIONS else self.names[name][int(given[0])]

    def put(self, target, value):
        name, _, index = target.upper().replace(" ", "").partition("[")
        if re.fullmatch(r"R\d+", name):
            self.r[int(name[1:])] = value
        elif name == "R":
            self.r[int(self.value(index[:-1]))] = value
        else:
            value = float(math.floor(value + 0.5)) if self.types[name] == "INT" else value
            if index:
                self.names[name][int(self.value(index[:-1]))] = value
            else:
                self.names[name] = value

    # --- flow ---

    def run(self):
        self.section(self.lines)
        return self.moves

    def section(self, lines):
        """Execute a program; texts without comments and labels."""
        codes = [line.split(";")[0].strip() for line in lines]
        labels = {m[1].upper(): k for k, c in enumerate(codes) if (m := re.match(r"(\w+):", c))}
        codes = [re.sub(r"^\w+:\s*", "", re.sub(r"^N\d+\s+", "", c)) for c in codes]
        ends, loops = self.matched(codes)
        k = 0
        while k < len(codes):
            code = codes[k]
            word = code.split("(")[0].split()[0].upper() if code else ""
            if word in ("M30", "M17", "RET"):
                return
            k = self.step(code, word, k, labels, ends, loops, codes)

    @staticmethod
    def matched(codes):
        """Return where what opens ends (ELSE first), and where loops begin by their ends."""
        ends, loops, open_ = {}, {}, []
        for k, code in enumerate(codes):
            word = code.split("(")[0].split()[0].upper() if code else ""
            opens = word in ("WHILE", "FOR", "LOOP") or code.upper() == "REPEAT"
            if opens or (word == "IF" and "GOTO" not in code):
                open_.append(k)
            elif word == "ELSE":
                ends[open_.pop()] = k
                open_.append(k)
            elif word in ("ENDIF", "ENDWHILE", "ENDFOR", "ENDLOOP", "UNTIL"):
                head = open_.pop()
                ends[head], loops[k] = k, head
        return ends, loops

    def step(self, code, word, k, labels, ends, loops, codes):
        """Execute a line; return the next."""
        rest = code[len(word) :].strip()
        jump = re.match(r"(?:IF(.*?))?GOTO[BF]?\s+(\w+)$", code, re.IGNORECASE)
        if jump:
            holds = jump[1] is None or self.value(jump[1])
            return labels[jump[2].upper()] if holds else k + 1
        if word == "IF" or word == "WHILE":
            return k + 1 if self.value(rest) else ends[k] + 1
        if word == "ELSE":
            return ends[k] + 1
        if word in ("FOR", "ENDFOR"):
            return self.counted(rest, word, k, ends, loops, codes)
        if word in ("ENDWHILE", "ENDLOOP"):
            return loops[k]
        if word == "REPEAT" and rest:
            return self.again(rest, k, labels)
        if word == "UNTIL":
            return k + 1 if self.value(rest) else loops[k]
        if word == "CASE":
            return self.chosen(rest, k, labels)
        if word not in ("", "LOOP", "REPEAT", "ENDIF"):
            self.one(code, word)
        return k + 1

    def again(self, rest, k, labels):
        """Execute REPEAT of a label, of which P counts the further times; return the next line."""
        label, _, times = rest.partition("P=")
        left = self.left.pop(k, None)
        left = (self.value(times) if times else 1) if left is None else left
        if not left:
            return k + 1
        self.left[k] = left - 1
        return labels[label.strip().upper()]

    def counted(self, rest, word, k, ends, loops, codes):
        """Execute FOR or ENDFOR; return the next line."""
        if word == "FOR":
            name, first, last = re.match(r"(\S+?)\s*=(.*) TO (.*)", rest, re.IGNORECASE).groups()
            self.put(name, self.value(first))
            return k + 1 if self.value(name) <= self.value(last) else ends[k] + 1
        head = re.match(r"FOR\s+(\S+?)\s*=(.*) TO (.*)", codes[loops[k]], re.IGNORECASE)
        name, _, last = head.groups()
        self.put(name, self.value(name) + 1)
        return loops[k] + 1 if self.value(name) <= self.value(last) else k + 1

    def chosen(self, rest, k, labels):
        """Return the line that CASE goes on at."""
        value, choices = re.match(r"\((.*?)\)\s*OF\s*(.*)", rest, re.IGNORECASE).groups()
        for one, label in re.findall(r"(\w+)\s+GOTO[FB]?\s+(\w+)", choices, re.IGNORECASE):
            if one.upper() == "DEFAULT" or self.value(one) == self.value(value):
                return labels[label.upper()]
        return k + 1

    def one(self, code, word):
        """Execute a line that does not decide."""
        if word == "DEF":
            kind, rest = re.match(r"DEF\s+(\w+)\s+(.*)", code, re.IGNORECASE).groups()
            for each in rest.split(","):
                name, _, value = each.partition("=")
                name, _, size = name.strip().upper().partition("[")
                self.types[name] = kind.upper()
                self.names[name] = [0.0] * int(size[:-1]) if size else 0.0
                if value:
                    self.put(name, self.value(value))
        elif word in self.files:
            self.call(word, re.search(r"\((.*)\)", code), code)
        elif (found := CYCLE.fullmatch(code)) is not None:
            self.cycle(found)
        elif word == "MCALL":
            self.hole = None
        elif re.fullmatch(r"A?(TRANS|ROT|SCALE|MIRROR)", word):
            self.framed(word, code[len(word) :])
        elif not re.match(r"(AP|RP)\s*=", code, re.IGNORECASE) and all(
            re.match(r"(R\d+|R\[[^]]*\]|\w\w+\s*(\[[^]]*\])?)\s*=", p) for p in self.parts(code)
        ):
            for part in self.parts(code):
                target, _, value = part.partition("=")
                self.put(target, self.value(value))
        else:
            self.move(code)

    @staticmethod
    def parts(code):
        return [p for p in re.split(r"\s+(?=[A-Z_]\w*(?:\[[^]]*\])?\s*=(?!=))", code) if p]

    def call(self, name, given, code):
        lines = self.files[name].splitlines()
        head = re.match(r"PROC\s+\w+\s*(?:\((.*)\))?", lines[0], re.IGNORECASE)
        inner = given[1] if given else ""
        values = parted(inner) if inner.strip() else []
        names, types, back = {}, {}, {}
        for k, each in enumerate((head[1] or "").split(",") if head[1] else []):
            shared, kind, known, default = re.match(
                r"\s*(VAR\s+)?(\w+)\s+(\w+)\s*(?:=\s*(.*))?$", each, re.IGNORECASE
            ).groups()
            text = values[k] if k < len(values) and values[k] else default
            value = self.value(text) if text else 0.0
            types[known.upper()] = kind.upper()
            names[known.upper()] = math.floor(value + 0.5) if kind.upper() == "INT" else value
            if shared:
                back[known.upper()] = values[k]
        count = re.search(r"[)\s]P\s*=?\s*(\d+)$", code, re.IGNORECASE)
        for _ in range(int(count[1]) if count else 1):
            before = self.names, self.types
            self.names, self.types = dict(names), dict(types)
            self.section(lines[1:])
            inner, (self.names, self.types) = self.names, before
            for known, target in back.items():
                names[known] = inner[known]
                self.put(target, inner[known])

    # --- moves ---

    def words(self, text):
        """Yield letters, ways and values of words."""
        k = 0
        text = text.strip()
        while k < len(text):
            found = WORD.match(text, k)
            k = found.end()
            if found[2]:
                stop = re.compile(r"\s+(?=(?:AP|RP|[A-Z])\s*=|[A-Z][-+.\d]|[A-Z]+$)", re.I).search(
                    text, k
                )
                end = stop.start() if stop else len(text)
                body = text[k:end].strip()
                way = re.fullmatch(r"(AC|IC)\s*\((.*)\)", body, re.IGNORECASE)
                yield (
                    found[1].upper(),
                    way[1].upper() if way else "",
                    self.value(way[2] if way else body),
                )
                k = stop.end() if stop else len(text)
            else:
                number = re.compile(r"[-+.\d]+\s*").match(text, k)
                yield found[1].upper(), "", float(number[0])
                k = number.end()

    def here(self):
        """Return the position in the frame: its matrix is a turn, grown and mirrored."""
        m, v = self.matrix, [a - b for a, b in zip(self.at, self.shift, strict=True)]
        det = lambda a: (  # noqa: E731
            a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1])
            - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0])
            + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0])
        )
        whole = det(m)
        return [
            det([[v[i] if j == k else m[i][j] for j in range(3)] for i in range(3)]) / whole
            for k in range(3)
        ]

    def go(self, kind, point):
        self.at = [a + b for a, b in zip(applied(self.matrix, point), self.shift, strict=True)]
        self.moves.append((kind, *self.at))

    def set_pole(self, code, words):
        """G110 counts from the tool, G111 from zero, G112 from the pole before."""
        base = {110: self.here()[:2], 111: [0.0, 0.0], 112: self.pole}[code]
        given = [words.get(axis, 0.0) for axis in "XY"]
        if "RP" in words:
            given = self.turned(words)
        self.pole, self.polar = [a + b for a, b in zip(base, given, strict=True)], {}

    @staticmethod
    def turned(polar):
        angle = math.radians(polar["AP"])
        return [polar["RP"] * math.cos(angle), polar["RP"] * math.sin(angle)]

    def move(self, code):
        ends, given = {}, [*self.words(code)]
        poles = [value for letter, _, value in given if letter == "G" and 110 <= value <= 112]
        if poles:
            self.set_pole(int(poles[0]), {letter: value for letter, _, value in given})
            return
        about = {
            letter: value + (self.polar["AP"] if way == "IC" else 0.0)
            for letter, way, value in given
            if letter in ("AP", "RP")
        }
        if about:
            self.polar |= about
            place = self.turned(self.polar)
            ends = {x: ("AC", a + b) for x, a, b in zip("XY", self.pole, place, strict=True)}
        for letter, way, value in given:
            if letter == "G" and value in (0, 1):
                self.motion = str(int(value))
            if letter == "G" and value in (90, 91):
                self.steps = value == 91
            if letter in "XYZ":
                ends[letter] = way, value
        if not ends:
            return
        point = self.here()
        for axis, (way, value) in ends.items():
            k = "XYZ".index(axis)
            point[k] = point[k] + value if way == "IC" or (not way and self.steps) else value
        self.go(self.motion, point)
        if self.hole:
            self.drill(self.hole)

    def framed(self, word, rest):
        words = {letter: value for letter, _, value in self.words(rest)}
        name = word.upper().removeprefix("A") if word.upper() != "A" else word
        at = [words.get(axis, 0.0) for axis in "XYZ"]
        matrix, shift = UNITS, [0.0, 0.0, 0.0]
        if name == "TRANS":
            shift = at
        elif name == "ROT":
            x, y, z = (math.radians(a) for a in at)
            z = math.radians(words["RPL"]) if "RPL" in words else z
            matrix = times(
                [[math.cos(z), -math.sin(z), 0], [math.sin(z), math.cos(z), 0], [0, 0, 1]],
                times(
                    [[math.cos(y), 0, math.sin(y)], [0, 1, 0], [-math.sin(y), 0, math.cos(y)]],
                    [[1, 0, 0], [0, math.cos(x), -math.sin(x)], [0, math.sin(x), math.cos(x)]],
                ),
            )
        elif name == "SCALE":
            matrix = [[words.get("XYZ"[i], 1.0) * (i == j) for j in range(3)] for i in range(3)]
        else:
            matrix = [
                [(-1.0 if "XYZ"[i] in words else 1.0) * (i == j) for j in range(3)]
                for i in range(3)
            ]
        if word.upper().startswith("A"):
            moved = applied(self.matrix, shift)
            self.shift = [a + b for a, b in zip(moved, self.shift, strict=True)]
            self.matrix = times(self.matrix, matrix)
        else:
            self.matrix, self.shift = matrix, shift

    # --- cycles ---

    def cycle(self, found):
        modal, name, text = found.groups()
        given = [self.value(p) if p.strip() else None for p in text.split(",")]
        if name.upper() == "HOLES2":
            a, b, radius, start, step, count = given
            for k in range(int(count)):
                angle = math.radians(start + k * (step or 360.0 / count))
                x, y = a + radius * math.cos(angle), b + radius * math.sin(angle)
                self.go("0", [x, y, self.here()[2]])
                self.drill(self.hole)
        elif modal:
            self.hole = name.upper(), given
        else:
            self.drill((name.upper(), given))

    def drill(self, hole):
        name, given = hole
        back, level, gap, depth, relative = (*given, *[None] * 5)[:5]
        start = level + gap
        bottom = level - relative if relative else depth
        point = self.here()

        def to(kind, z):
            self.go(kind, [point[0], point[1], z])

        to("0", start)
        if name == "CYCLE83":
            self.pecked(given, start, bottom, to)
        else:
            to("1", bottom)
        if name in ("CYCLE85", "CYCLE89"):
            to("1", start)
        to("0", back)

    def pecked(self, given, start, bottom, to):
        """Deep holes with constant strokes, out of the hole or with VRT in it (DIS1 is given)."""
        level, first, less = given[1], given[5], given[6]
        depth = level - less if less else first
        stroke, clear = level - depth, given[11]
        back, again = given[14], given[16]
        while True:
            to("1", depth)
            if depth <= bottom:
                return
            if clear:
                to("0", start)
                to("0", depth + again)
            else:
                to("1", depth + back)
            depth = max(depth - stroke, bottom)


def moves(text, files=None):
    """Return what a program does: kind, and where the tool is then."""
    return Machine(text, files).run()

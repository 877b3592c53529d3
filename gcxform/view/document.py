"""The page: one HTML file with our modules, three.js and the data, that loads nothing.

Modules of `page/` import one another by name, one import a line; here they become one script in an
order in which each stands behind what it imports. A policy in the page allows this script and this
style by their hashes, and no connection: whatever a program says, the browser runs nothing else.
"""

from __future__ import annotations

import base64
import hashlib
import html
import json
import re
from functools import cache
from pathlib import Path
from typing import Any, Final

from gcxform.version import VERSION
from gcxform.view.packing import Store

HERE: Final = Path(__file__).parent
FIRST: Final = "main"
_IMPORT: Final = re.compile(r'^import \{([^}]*)\} from "\./(\w+)\.js";', re.M)
_EXPORT: Final = re.compile(r"^export (?:(?:async )?function|const) (\w+)", re.M)


def written(title: str, head: dict[str, Any], store: Store) -> str:
    """Return the page."""
    script = f'"use strict";\n{_part("three/three.min.js")}\n{linked(FIRST)}'
    style = _part("page/view.css")
    holes = {
        "title": html.escape(title),
        "version": html.escape(VERSION),
        "policy": _policy(script, style),
        "style": style,
        "head": _harmless(json.dumps(head, separators=(",", ":"))),
        "data": store.text(),
        "script": script,
        "licence": html.escape(_part("three/LICENSE")),
    }
    return re.sub(r"\{\{(\w+)\}\}", lambda hole: holes[hole[1]], _part("page/view.html"))


def _policy(script: str, style: str) -> str:
    """Return the content security policy: nothing but this script and this style."""
    return (
        f"default-src 'none'; script-src {_hash(script)}; style-src {_hash(style)}; "
        "img-src data: blob:; base-uri 'none'; form-action 'none'"
    )


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _harmless(text: str) -> str:
    """Return JSON of which no part can be taken for markup."""
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


@cache
def _part(name: str) -> str:
    return (HERE / name).read_text("utf-8")


@cache
def linked(first: str) -> str:
    """Return a module of the page and all that it imports as one script."""
    order: list[str] = []
    _visit(first, order, ())
    return "\n".join(map(_scoped, order))


def _visit(name: str, order: list[str], above: tuple[str, ...]) -> None:
    """Put what a module imports, and then the module, behind what is there."""
    assert name not in above, f"{name} imports itself by {above}"
    if name not in order:
        for _, other in _IMPORT.findall(_part(f"page/{name}.js")):
            _visit(other, order, (*above, name))
        order.append(name)


def _scoped(name: str) -> str:
    """Return a module as a function that is called at once, and returns what it exports."""
    text = _part(f"page/{name}.js")
    names = ", ".join(_EXPORT.findall(text))
    text = _EXPORT.sub(lambda found: found[0].removeprefix("export "), text)
    text = _IMPORT.sub(r"const {\1} = $\2;", text)
    return f"const ${name} = (() => {{\n{text}\nreturn {{ {names} }};\n}})();"

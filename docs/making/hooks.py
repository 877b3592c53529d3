"""What mkdocs does with these pages: the reference is put in, and links out of `docs/` lead on.

The pages are read in the repository as well, so their links are those of the repository. On the
site, what they name outside of `docs/` is there too: other pages as pages, files as files. The
reference is 4,700 lines that every change of the code would change again, so that the pages of the
repository do not have them, and name the command that prints them.

The site is made with MkDocs and its theme Material, which announces to be maintained until May
2027. Pages are plain Markdown, and all that is made is made here: another builder needs
`on_page_markdown`, `outside` and `console`.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import Any

from public_api import api
from reference import MADE

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = ("ARCHITECTURE.md", "CONTRIBUTING.md", "benchmarks/README.md", "tests/hazards.md")
SHIM = "https://unpkg.com/iframe-worker/shim"  # which the plugin `offline` would load from there
LINK = re.compile(r"(\]\()([^)#:\s]+)((?:#[^)\s]*)?\))")
MARK = re.compile(
    r"^<!-- made: (\w+) -->\n\*Made from the code on the site; here `(.+)` prints it\.\*$", re.M
)
"""Where the reference is put in: who reads the repository is told what prints it."""


def on_config(config: Any) -> Any:
    """Show consoles in a way of our own: Pygments takes some of what is printed for a prompt."""
    fence = {"name": "console", "class": "console", "format": console}
    config.mdx_configs["pymdownx.superfences"] = {"custom_fences": [fence]}
    return config


def console(source: str, *_: Any, **__: Any) -> str:
    """Return a console as HTML: prompts, commands, and what they print, to be told apart."""
    lines = [_line(escape(line, quote=False)) for line in source.splitlines()]
    return (
        '<div class="language-console highlight"><pre><span></span><code>'
        + "".join(lines)
        + "</code></pre></div>"
    )


def _line(line: str) -> str:
    if line.startswith("$ "):
        return f'<span class="gp">$ </span>{line[2:]}\n'
    return f'<span class="go">{line}\n</span>'


def on_files(files: Any, config: Any) -> Any:
    """Add the pages and files outside of `docs/` that pages name."""
    from mkdocs.structure.files import File

    for path in outside():
        name = path.relative_to(ROOT).as_posix()
        files.append(File.generated(config, name, abs_src_path=str(path)))
    return files


def outside() -> list[Path]:
    """Return what the site shows of the repository besides `docs/`."""
    pages = [ROOT / name for name in PAGES] + sorted(ROOT.glob("examples/*/README.md"))
    named = {path for page in [*sorted(DOCS.rglob("*.md")), *pages] for path in _linked(page)}
    files = {p for p in named if p.is_file() and p != ROOT / "README.md"}
    return sorted({*pages, *(p for p in files if DOCS not in p.parents)})


def _linked(page: Path) -> Iterator[Path]:
    for link in LINK.finditer(page.read_text("utf-8")):
        yield (page.parent / link[2]).resolve()


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Put in what is made, and turn links of the repository into those of the site."""
    made = MARK.sub(lambda mark: "\n".join({**MADE, "api": api}[mark[1]]()), markdown)
    source = Path(page.file.abs_src_path)
    return LINK.sub(lambda link: f"{link[1]}{_on_site(link[2], source)}{link[3]}", made)


def on_post_page(output: str, page: Any, config: Any) -> str:
    """Let pages opened from disk take the worker of their search from beside them."""
    own = os.path.relpath("assets/iframe-worker.js", Path(page.file.dest_uri).parent)
    return output.replace(SHIM, own)


def on_post_template(output_content: str, template_name: str, config: Any) -> str:
    """Do the same for the page that says that there is none."""
    return output_content.replace(SHIM, "/assets/iframe-worker.js")


def _on_site(target: str, page: Path) -> str:
    """Return a link of a page in the repository as one between pages of the site."""
    path = (page.parent / target).resolve()
    if path == ROOT / "README.md":
        path = DOCS / "index.md"
    return os.path.relpath(_place(path), _place(page).parent)


def _place(path: Path) -> Path:
    base = DOCS if DOCS in path.parents else ROOT
    return Path("/") / path.relative_to(base)

"""Our values as those of the protocol: places, findings, parts, edits."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from lsprotocol import types as lsp
from pygls.uris import from_fs_path

from gcxform.cli.editing.changes import Action
from gcxform.cli.editing.mentions import Kind, Symbol
from gcxform.cli.editing.navigation import Target
from gcxform.cli.editing.program import Program
from gcxform.cli.editing.text import Edit, Place, Span
from gcxform.diagnostics import Diagnostic, Severity

SEVERITIES: Final = {
    Severity.ERROR: lsp.DiagnosticSeverity.Error,
    Severity.WARNING: lsp.DiagnosticSeverity.Warning,
    Severity.NOTE: lsp.DiagnosticSeverity.Information,
}
SYMBOLS: Final = {
    Kind.PROGRAM: lsp.SymbolKind.Function,
    Kind.TOOL: lsp.SymbolKind.Object,
    Kind.LABEL: lsp.SymbolKind.Key,
    Kind.SECTION: lsp.SymbolKind.String,
}
SHOWN: Final = 80  # characters of a line beside the name of a part


def edit_of(span: lsp.Range, text: str) -> Edit:
    """Return a change of an editor."""
    start, end = (Place(at.line, at.character) for at in (span.start, span.end))
    return Edit(Span(start, end), text)


def text_edit(edit: Edit) -> lsp.TextEdit:
    """Return an edit."""
    return lsp.TextEdit(_range(edit.span), edit.text)


def bytes_at(program: Program, position: lsp.Position) -> tuple[int, int]:
    """Return a line, and a byte of it, from 0."""
    text = program.text
    start = text.offset(Place(position.line, 0))
    column = text.offset(Place(position.line, position.character)) - start
    head = text.line(position.line)[:column]
    return position.line, len(head.encode("utf-8", "surrogatepass"))


def first_line(found: Diagnostic) -> int:
    """Return the line at which a finding stands, from 0."""
    return max((found.where.line if found.where else 0) - 1, 0)


def diagnostic(program: Program, found: Diagnostic) -> lsp.Diagnostic:
    """Return a finding; one about another file stands at the first line, and names its place."""
    where, message = found.where, found.message
    own = where is None or where.file in ("", "-", program.path)
    if where is not None and own and where.line:
        first = where.column - 1
        span = _span(program, where.line - 1, first, first + max(where.width, 1))
    else:
        span = _line(program, 0)
        message = message if own else f"{where}: {message}"
    message += f"\n{found.hint}" if found.hint else ""
    severity = SEVERITIES[found.severity]
    return lsp.Diagnostic(_range(span), message, severity, found.code, source="gcxform")


def hover(program: Program, line: int, words: Sequence[str]) -> lsp.Hover:
    """Return what a line does, in words."""
    text = "\n".join(words).replace("```", "` ` `")
    body = lsp.MarkupContent(lsp.MarkupKind.Markdown, f"```text\n{text}\n```")
    return lsp.Hover(body, _range(_line(program, line)))


def symbol(program: Program, part: Symbol) -> lsp.DocumentSymbol:
    """Return a part of a program with those in it."""
    first, last = part.lines
    return lsp.DocumentSymbol(
        part.title or "?",
        SYMBOLS[part.kind],
        _range(Span(Place(first, 0), _line(program, last).end)),
        _range(_span(program, first, *part.at)),
        program.text.line(first).strip()[:SHOWN],
        children=[symbol(program, each) for each in part.inside],
    )


def folds(parts: Sequence[Symbol]) -> Iterator[lsp.FoldingRange]:
    """Yield the parts that have more than one line."""
    for each in parts:
        if each.lines[1] > each.lines[0]:
            yield lsp.FoldingRange(*each.lines)
        yield from folds(each.inside)


def target(program: Program, uri: str, found: Target) -> lsp.Location:
    """Return a place with a name, in the program or in another file."""
    if found.file is not None:
        place = lsp.Position(found.line, 0)
        return lsp.Location(_uri(str(found.file)), lsp.Range(place, place))
    return lsp.Location(uri, _range(_span(program, found.line, found.start, found.end)))


def action(program: Program, uri: str, found: Action) -> lsp.CodeAction:
    """Return what a hint offers."""
    changes = {
        uri if path == program.path else _uri(path): [text_edit(each) for each in edits]
        for path, edits in found.edits.items()
    }
    return lsp.CodeAction(
        found.title,
        kind=lsp.CodeActionKind.QuickFix,
        diagnostics=[diagnostic(program, found.of)],
        edit=lsp.WorkspaceEdit(changes=changes),
    )


def _uri(path: str) -> str:
    return from_fs_path(str(Path(path).absolute())) or path


def _position(place: Place) -> lsp.Position:
    return lsp.Position(place.line, place.column)


def _range(span: Span) -> lsp.Range:
    return lsp.Range(_position(span.start), _position(span.end))


def _span(program: Program, line: int, start: int, end: int) -> Span:
    return Span(program.text.of_bytes(line, start), program.text.of_bytes(line, end))


def _line(program: Program, number: int) -> Span:
    size = len(program.text.line(number).encode("utf-8", "surrogatepass"))
    return _span(program, number, 0, size)

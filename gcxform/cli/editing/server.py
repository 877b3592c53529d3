"""The language server: what the protocol asks and tells, answered by `Program`.

Findings of reading are published a moment after a change, those of the whole `check` when nothing
has changed for longer; that runs beside, and what came too late is dropped. Everything else is
answered when it is asked, of the text as it is then. A program whose calls and loops take long to
execute is read beside as well, so that nothing else waits for it.
"""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Sequence
from dataclasses import field
from time import process_time
from typing import Any, Final

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer
from pygls.uris import to_fs_path

from gcxform.cli.editing import navigation, our_files
from gcxform.cli.editing import protocol as said
from gcxform.cli.editing.changes import actions, formatted
from gcxform.cli.editing.program import Program
from gcxform.cli.editing.shop import Shop, Wishes
from gcxform.cli.editing.text import Text
from gcxform.cli.editing.worker import Worker
from gcxform.diagnostics import Diagnostic, GcxformError
from gcxform.values import dataclass
from gcxform.version import VERSION

SOON: Final = 0.005  # s from a change to the findings of reading
LATER: Final = 0.7  # s from the last change to those of the whole check
LONG: Final = 0.25  # s of the processor for reading a program, which is read beside from then on
TOML: Final = ".toml"


@dataclass
class Document:
    """What is open: a program, or one of our files; its version, and what is to come for it.

    `is_slow` is one that is read beside; the first reading of all is no measure of that.
    """

    uri: str
    program: Program
    version: int | None
    found: list[Diagnostic] = field(default_factory=list)
    waiting: list[asyncio.TimerHandle] = field(default_factory=list)
    is_slow: bool = False
    found_once: bool = False

    @property
    def is_ours(self) -> bool:
        """Whether it is TOML."""
        return self.program.path.lower().endswith(TOML)

    def cancel(self) -> None:
        """Let nothing come that was to come."""
        for each in self.waiting:
            each.cancel()


@dataclass
class Desk:
    """The open documents, and how they are answered about."""

    server: LanguageServer
    shop: Shop = field(default_factory=Shop)
    open: dict[str, Document] = field(default_factory=dict)
    reading: Worker = field(default_factory=Worker)
    checking: Worker = field(default_factory=Worker)

    # --- what an editor tells ---

    def begin(self, params: lsp.InitializeParams) -> None:
        """Take the wishes of an editor."""
        self.shop.wishes = Wishes.of(params.initialization_options)

    def opened(self, params: lsp.DidOpenTextDocumentParams) -> None:
        """Take a document."""
        given = params.text_document
        encoding = self.server.workspace.position_encoding
        counts = str(getattr(encoding, "value", encoding))
        path = to_fs_path(given.uri) or given.uri
        program = Program(path, Text(given.text, counts), self.shop)
        self.open[given.uri] = Document(given.uri, program, given.version)
        self._look(self.open[given.uri], 0.0)

    def changed(self, params: lsp.DidChangeTextDocumentParams) -> None:
        """Change a document."""
        document = self.open.get(params.text_document.uri)
        if document is None:
            return
        text = document.program.text
        for change in params.content_changes:
            span = getattr(change, "range", None)
            edit = None if span is None else said.edit_of(span, change.text)
            text = text.of(change.text) if edit is None else text.changed(edit)
        document.program = document.program.changed(text)
        document.version = params.text_document.version
        if not document.is_ours:
            self._look(document, SOON)

    def saved(self, params: lsp.DidSaveTextDocumentParams) -> None:
        """Look at everything again: a pipeline or a machine may be another one now."""
        for document in self.open.values():
            self.shop.forget(document.program.path)
            self._look(document, 0.0)

    def closed(self, params: lsp.DidCloseTextDocumentParams) -> None:
        """Forget a document."""
        document = self.open.pop(params.text_document.uri, None)
        if document is not None:
            document.cancel()
            self._publish(document, [])

    # --- what it is told ---

    def _look(self, document: Document, soon: float) -> None:
        """Look at a document soon, and at all of it later."""
        document.cancel()
        loop = asyncio.get_running_loop()
        document.waiting = [loop.call_later(soon, self._read, document)]
        if not document.is_ours:
            document.waiting.append(loop.call_later(soon + LATER, self._check, document))

    def _read(self, document: Document) -> None:
        program = document.program
        if document.is_ours:
            self._publish(document, our_files.findings(program.path))
        elif document.is_slow:
            self._beside(document, self.reading, program.findings)
        else:
            start = process_time()
            self._publish(document, program.findings())
            document.is_slow = process_time() - start > LONG and document.found_once
            document.found_once = True

    def _check(self, document: Document) -> None:
        self._beside(document, self.checking, document.program.checked)

    def _beside(
        self, document: Document, worker: Worker, look: Callable[[], list[Diagnostic] | None]
    ) -> None:
        """Look at a program beside, and publish what was found if it is still the same."""
        program = document.program

        def is_still() -> bool:
            return document.program is program and self.open.get(document.uri) is document

        def done(future: asyncio.Future[list[Diagnostic] | None]) -> None:
            found = None if future.exception() else future.result()
            if found is not None and is_still():
                self._publish(document, found)

        worker.do(lambda: look() if is_still() else None).add_done_callback(done)

    def _publish(self, document: Document, found: list[Diagnostic]) -> None:
        document.found = found
        given = [said.diagnostic(document.program, each) for each in found]
        self.server.text_document_publish_diagnostics(
            lsp.PublishDiagnosticsParams(document.uri, given, document.version)
        )

    # --- what it asks ---

    def _program(self, asked: Any) -> Program | None:
        document = self.open.get(asked.text_document.uri)
        return None if document is None or document.is_ours else document.program

    async def hover(self, params: lsp.HoverParams) -> lsp.Hover | None:
        """Say what a block does."""
        document, line = self.open.get(params.text_document.uri), params.position.line
        if document is None or document.is_ours:
            return None
        program = document.program
        slow = document.is_slow
        words = (
            await self.reading.do(lambda: program.explained(line))
            if slow
            else program.explained(line)
        )
        return said.hover(program, line, words) if words else None

    def symbols(self, params: lsp.DocumentSymbolParams) -> Sequence[lsp.DocumentSymbol]:
        """Say what is where."""
        program = self._program(params)
        return [said.symbol(program, each) for each in program.symbols()] if program else []

    def folds(self, params: lsp.FoldingRangeParams) -> Sequence[lsp.FoldingRange]:
        """Say which lines belong together."""
        program = self._program(params)
        return list(said.folds(program.symbols())) if program else []

    def definition(self, params: lsp.DefinitionParams) -> lsp.Location | None:
        """Say where a name is defined."""
        program = self._program(params)
        if program is None:
            return None
        found = navigation.definition(program, *said.bytes_at(program, params.position))
        return said.target(program, params.text_document.uri, found) if found else None

    def references(self, params: lsp.ReferenceParams) -> Sequence[lsp.Location]:
        """Say where a name stands."""
        program = self._program(params)
        if program is None:
            return []
        found = navigation.references(program, *said.bytes_at(program, params.position))
        return [said.target(program, params.text_document.uri, each) for each in found]

    def actions(self, params: lsp.CodeActionParams) -> Sequence[lsp.CodeAction]:
        """Say what can be done about findings in some lines."""
        document = self.open.get(params.text_document.uri)
        if document is None or document.is_ours:
            return []
        first, last = params.range.start.line, params.range.end.line
        here = [d for d in document.found if first <= said.first_line(d) <= last]
        program = document.program
        return [said.action(program, document.uri, each) for each in actions(program, here)]

    def formatting(self, params: lsp.DocumentFormattingParams) -> Sequence[lsp.TextEdit] | None:
        """Format a program."""
        return self._formatted(params, None)

    def range_formatting(
        self, params: lsp.DocumentRangeFormattingParams
    ) -> Sequence[lsp.TextEdit] | None:
        """Format some lines of a program."""
        start, end = params.range.start, params.range.end
        last = end.line - (end.character == 0 and end.line > start.line)
        return self._formatted(params, (start.line, last))

    def _formatted(
        self, params: Any, lines: tuple[int, int] | None
    ) -> Sequence[lsp.TextEdit] | None:
        """Return edits, or say why there are none."""
        program = self._program(params)
        if program is None:
            return None
        try:
            return [said.text_edit(each) for each in formatted(program, lines)]
        except GcxformError as error:
            why = "; ".join(each.message for each in error.diagnostics[:3])
            message = lsp.ShowMessageParams(lsp.MessageType.Warning, f"not formatted: {why}")
            self.server.window_show_message(message)
            return None


def new_server() -> LanguageServer:
    """Return a server that answers, not yet started."""
    server = LanguageServer("gcxform", VERSION)
    desk = Desk(server)
    told: dict[str, Callable[[Any], Any]] = {
        lsp.INITIALIZE: desk.begin,
        lsp.TEXT_DOCUMENT_DID_OPEN: desk.opened,
        lsp.TEXT_DOCUMENT_DID_CHANGE: desk.changed,
        lsp.TEXT_DOCUMENT_DID_SAVE: desk.saved,
        lsp.TEXT_DOCUMENT_DID_CLOSE: desk.closed,
        lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL: desk.symbols,
        lsp.TEXT_DOCUMENT_FOLDING_RANGE: desk.folds,
        lsp.TEXT_DOCUMENT_DEFINITION: desk.definition,
        lsp.TEXT_DOCUMENT_REFERENCES: desk.references,
        lsp.TEXT_DOCUMENT_CODE_ACTION: desk.actions,
        lsp.TEXT_DOCUMENT_FORMATTING: desk.formatting,
        lsp.TEXT_DOCUMENT_RANGE_FORMATTING: desk.range_formatting,
    }
    for name, answer in told.items():
        server.feature(name)(_plain(answer))
    server.feature(lsp.TEXT_DOCUMENT_HOVER)(_awaited(desk.hover))
    return server


def _plain(answer: Callable[[Any], Any]) -> Callable[[Any], Any]:
    """Return a method as a function, whose arguments the library counts."""

    def asked(params: Any) -> Any:
        return answer(params)

    return asked


def _awaited(answer: Callable[[Any], Awaitable[Any]]) -> Callable[[Any], Awaitable[Any]]:
    """Return a method that is waited for as a function."""

    async def asked(params: Any) -> Any:
        return await answer(params)

    return asked

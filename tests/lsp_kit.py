"""A small editor: it speaks JSON-RPC with `gcxform lsp` over pipes."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from queue import Empty, Queue
from typing import Any

WAIT = 120.0  # s; a machine that is busy is no failure


class Editor:
    """An editor with a server of its own."""

    def __init__(self, folder: Path, **options: Any) -> None:
        command = [sys.executable, "-m", "gcxform.cli", "lsp"]
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, cwd=folder, stdin=pipe, stdout=pipe, stderr=pipe)
        self.folder = folder
        self.told: Queue[dict[str, Any]] = Queue()
        self.kept: list[dict[str, Any]] = []
        self.asked = 0
        self.listener = threading.Thread(target=self._listen, daemon=True)
        self.listener.start()
        capabilities = options.pop("capabilities", {})
        self.answer = self.ask(
            "initialize",
            processId=None,
            rootUri=folder.as_uri(),
            capabilities=capabilities,
            initializationOptions=options,
        )
        self.tell("initialized")

    def _listen(self) -> None:
        assert self.process.stdout is not None
        while head := self.process.stdout.readline():
            size = int(head.split(b":")[1])
            while self.process.stdout.readline().strip():
                pass
            self.told.put(json.loads(self.process.stdout.read(size)))

    def _send(self, message: dict[str, Any]) -> None:
        assert self.process.stdin is not None
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def tell(self, method: str, **params: Any) -> None:
        self._send({"method": method, "params": params})

    def ask(self, method: str, **params: Any) -> Any:
        self.asked += 1
        number = self.asked
        self._send({"id": number, "method": method, "params": params})
        message = self._wait(lambda each: each.get("id") == number and "method" not in each)
        assert "error" not in message, message
        return message["result"]

    def _wait(self, wanted: Callable[[dict[str, Any]], bool]) -> dict[str, Any]:
        for each in self.kept:
            if wanted(each):
                self.kept.remove(each)
                return each
        while True:
            try:
                message = self.told.get(timeout=WAIT)
            except Empty:
                raise AssertionError("the server does not answer") from None
            if wanted(message):
                return message
            self.kept.append(message)

    # --- documents ---

    def uri(self, name: str) -> str:
        return (self.folder / name).as_uri()

    def open(self, name: str, text: str | None = None, version: int = 1) -> str:
        path = self.folder / name
        text = path.read_bytes().decode() if text is None else text
        uri = self.uri(name)
        document = {"uri": uri, "languageId": "gcode", "version": version, "text": text}
        self.tell("textDocument/didOpen", textDocument=document)
        return uri

    def change(self, uri: str, version: int, *changes: dict[str, Any]) -> None:
        named = {"uri": uri, "version": version}
        self.tell("textDocument/didChange", textDocument=named, contentChanges=list(changes))

    def findings(self, uri: str, version: int | None = 1) -> list[dict[str, Any]]:
        """Return the next findings of a version."""

        def wanted(each: dict[str, Any]) -> bool:
            params = each.get("params") or {}
            named = each.get("method") == "textDocument/publishDiagnostics"
            return named and (params["uri"], params.get("version")) == (uri, version)

        found: list[dict[str, Any]] = self._wait(wanted)["params"]["diagnostics"]
        return found

    def at(self, method: str, uri: str, line: int, column: int = 0, **more: Any) -> Any:
        position = {"line": line, "character": column}
        named = {"textDocument": {"uri": uri}, "position": position}
        return self.ask(f"textDocument/{method}", **named, **more)

    def about(self, method: str, uri: str, **more: Any) -> Any:
        return self.ask(f"textDocument/{method}", textDocument={"uri": uri}, **more)

    def close(self) -> int:
        self.ask("shutdown")
        self.tell("exit")
        code = self.process.wait(WAIT)
        self.listener.join(WAIT)
        for each in (self.process.stdin, self.process.stdout, self.process.stderr):
            assert each is not None
            each.close()
        return code


def put(line: int, column: int, text: str, until: tuple[int, int] | None = None) -> dict[str, Any]:
    """Return a change of an editor."""
    start = {"line": line, "character": column}
    last = start if until is None else {"line": until[0], "character": until[1]}
    return {"range": {"start": start, "end": last}, "text": text}

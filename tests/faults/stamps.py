"""Faults of stamps: what is written, what is read, what is refused."""

from __future__ import annotations

from faults.mutation import Mutation

STAMPS = "tests/test_stamps.py"


def _fault(name: str, file: str, old: str, new: str) -> Mutation:
    return Mutation(f"stamps: {name}", file, old, new, STAMPS)


MUTATIONS = (
    Mutation(
        "stamps: those of called files are not looked at",
        "gcxform/pipeline/called_files.py",
        "for each in files:",
        "for each in files[:0]:",
        "tests/test_called_stamps.py",
    ),
    _fault(
        "none is read",
        "gcxform/stamps/comment.py",
        'return b"CXFORM" in text or b"cxform" in text',
        "return False",
    ),
    _fault(
        "small letters are not read",
        "gcxform/stamps/comment.py",
        'return b"CXFORM" in text or b"cxform" in text',
        'return b"CXFORM" in text',
    ),
    _fault(
        "none is written",
        "gcxform/stamps/writing.py",
        "self.waits = bool(self.lines)",
        "self.waits = False",
    ),
    _fault(
        "the seal is about its own line",
        "gcxform/stamps/comment.py",
        'sealed(without_lines(text, ("SEAL",)))',
        "sealed(text)",
    ),
    _fault(
        "the seal forgets what closes the program",
        "gcxform/stamps/writing.py",
        "digest.update(sealed(before + self.held))",
        "digest.update(sealed(before))",
    ),
    _fault(
        "the seal counts carriage returns",
        "gcxform/stamps/comment.py",
        'return text.replace(b"\\r", b"")',
        "return text",
    ),
    _fault(
        "any stamp is that of the very pipeline",
        "gcxform/stamps/chain.py",
        "if ours is not None and stamp.digest == ours.digest]",
        "if ours is not None]",
    ),
    _fault(
        "edited is as good as done",
        "gcxform/stamps/chain.py",
        "if done and stamps.fits and (",
        "if done and (",
    ),
    _fault(
        "options are not in the digest",
        "gcxform/stamps/chain.py",
        'return {"use": step.name, **raw}',
        'return {"use": step.name}',
    ),
    _fault(
        "models are not in the digest",
        "gcxform/stamps/chain.py",
        "            raw[key] = value.sha256\n",
        "            raw.pop(key)\n",
    ),
    _fault(
        "the machine is not in the digest",
        "gcxform/stamps/chain.py",
        '"machine": _content(context.machine),',
        "",
    ),
    _fault(
        "axes of any machine are corrected",
        "gcxform/stamps/chain.py",
        "bool(stamp.axes) and here != stamp.axes",
        "False",
    ),
    _fault(
        "the oldest stamp holds",
        "gcxform/stamps/comment.py",
        "for stamp in self.stamps:\n            for fact",
        "for stamp in reversed(self.stamps):\n            for fact",
    ),
    _fault(
        "a broken stamp is none",
        "gcxform/stamps/chain.py",
        "if not stamps.readable:",
        "if False:",
    ),
    _fault(
        "old stamps are not carried",
        "gcxform/stamps/chain.py",
        "return (self.new, *self.read.stamps)",
        "return (self.new,)",
    ),
    _fault(
        "what was edited is sealed anew",
        "gcxform/stamps/chain.py",
        "return None if self.new or self.read.fits else",
        "return None if True else",
    ),
    _fault(
        "strip takes the stamp",
        "gcxform/pipeline/text_passes.py",
        "or is_stamp(block.text)",
        "",
    ),
    _fault(
        "the head stands before the percent sign",
        "gcxform/stamps/writing.py",
        "at = place.end() if place else 0",
        "at = 0",
    ),
    _fault(
        "stamps are not proved",
        "gcxform/pipeline/run.py",
        "check_stamps(out.proof.found, self.marks)",
        "pass",
    ),
)

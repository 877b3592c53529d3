"""Faults of the passes `volumetric`, `segment` and `feed`."""

from __future__ import annotations

from faults.mutation import CORPUS, FIGURES, KIT, PASSES, VERIFY, Mutation

MUTATIONS = (
    # the error model and the search for commands
    Mutation(
        "compensate: the sign of the error is swapped",
        "gcxform/machine/errors.py",
        "np.subtract(target, command, out=command)",
        "np.add(target, command, out=command)",
        FIGURES,
    ),
    Mutation(
        "undo: the sign of the error is swapped",
        f"{PASSES}/undoing.py",
        "actual = point + self.step.error(point + offset)",
        "actual = point - self.step.error(point + offset)",
        VERIFY,
    ),
    Mutation(
        "E: an axis is dropped",
        "gcxform/machine/errors.py",
        'for k in range(3):\n            # "clip" spares',
        'for k in range(2):\n            # "clip" spares',
        FIGURES,
    ),
    Mutation(
        "E: one cell farther",
        "gcxform/machine/errors.py",
        "return cell.astype(np.intp), part",
        "return cell.astype(np.intp), part + 1.0",
        FIGURES,
    ),
    Mutation(
        "volumetric: the first node is skipped",
        f"{PASSES}/volumetric.py",
        "(n if bends else n[1:-1] for n in",
        "(n if bends else n[2:-1] for n in",
        FIGURES,
    ),
    Mutation(
        "volumetric: the last node of a move is skipped",
        "gcxform/toolpath/crossings.py",
        "np.maximum(high - low, 0)",
        "np.maximum(high - low - 1, 0)",
        FIGURES,
    ),
    Mutation(
        "volumetric: cuts are not made where the command crosses",
        f"{PASSES}/splitting.py",
        "part = part + np.where(",
        "part = part + 3.0 * np.where(",
        FIGURES,
    ),
    Mutation(
        "volumetric: the tolerance is doubled",
        f"{PASSES}/splitting.py",
        "limit = residual * (1 - 1e-6)",
        "limit = 2 * residual * (1 - 1e-6)",
        FIGURES,
    ),
    Mutation(
        "volumetric: pieces in inverse time keep the feed",
        f"{PASSES}/compensation.py",
        "path.feed[row] / share, path.feed[row]",
        "path.feed[row], path.feed[row]",
        VERIFY,
    ),
    # segment
    Mutation(
        "segment: the chord error is doubled",
        f"{PASSES}/segment.py",
        "chords(path, self.chord_error))",
        "chords(path, 2 * self.chord_error))",
        f"{KIT}[segment]",
    ),
    Mutation(
        "segment: pieces in inverse time keep the feed",
        f"{PASSES}/segment.py",
        "path.feed[row] * pieces[row], path.feed[row]",
        "path.feed[row], path.feed[row]",
        VERIFY,
    ),
    Mutation(
        "segment: pieces of arcs keep the sweep",
        f"{PASSES}/segment.py",
        "(path.sweep / pieces)[row]",
        "path.sweep[row]",
        f"{KIT}[segment]",
    ),
    Mutation(
        "undo: pieces in inverse time keep the feed",
        f"{PASSES}/undoing.py",
        "feed / (part - before), feed)",
        "feed, feed)",
        f"{KIT}[volumetric]",
    ),
    # feed
    Mutation(
        "feed: an arc is as long as its chord",
        f"{PASSES}/feed.py",
        "size[arcs] = self._arc_lengths(arcs)",
        "pass",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: a helix does not rise",
        f"{PASSES}/feed.py",
        "np.hypot(first * self.path.sweep[rows], self.way[arcs, normal])",
        "first * self.path.sweep[rows]",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: length over feed for feed over length",
        f"{PASSES}/feed.py",
        "factor = 1 / way if",
        "factor = way if",
        f"{KIT}[feed]",
    ),
    Mutation(
        "feed: degrees count beside millimetres",
        f"{PASSES}/feed.py",
        "self.way[:, self.linear] ** 2",
        "self.way**2",
        f"{CORPUS}[feed/rotary]",
    ),
    Mutation(
        "feed: the mode of a tool change is not restored",
        f"{PASSES}/feed.py",
        "kept = path.blocks.leaves",
        "kept = np.zeros_like(path.blocks.leaves)",
        f"{CORPUS}[feed/macro]",
    ),
    Mutation(
        "feed: the slowest rate of the control is ignored",
        f"{PASSES}/feed.py",
        "if slow.any():",
        "if False:",
        f"{CORPUS}[bad/gx320-too-slow]",
    ),
    Mutation(
        "writing: a feed mode that has changed is not stated",
        "gcxform/emit/pieces.py",
        'self._mode("feed-mode", wanted, self.believed.feed_mode, needs)',
        'self._mode("feed-mode", wanted, self.believed.feed_mode, needs & False)',
        f"{CORPUS}[feed/to-inverse-time]",
    ),
    Mutation(
        "writing: the end of a circle in inverse time is written",
        "gcxform/emit/centres.py",
        "silent |= full & (self.path.feed_mode[rows] == FeedMode.INVERSE_TIME)",
        "silent |= False",
        f"{CORPUS}[feed/full-circle]",
    ),
    Mutation(
        "a program without end leaves its feed mode behind",
        "gcxform/run.py",
        "if feed_modes:",
        "if False:",
        f"{CORPUS}[bad/gx321-no-end]",
    ),
)

"""From lines to rows: plain moves, arcs, splines, threads, probes, G28 and G53."""

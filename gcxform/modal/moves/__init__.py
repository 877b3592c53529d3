"""From lines to rows: plain moves, arcs, splines, calls of cycles, threads, probes, G28 and G53."""

"""`arcs`: runs of short lines become arcs."""

"""Pictures: what instruments print, error models, errors along a path, residuals (extra `plot`).

matplotlib is imported where a picture is drawn, never before.
"""

from gcxform.plot.canvas import check as check
from gcxform.plot.canvas import rendered as rendered
from gcxform.plot.chains import chain as chain
from gcxform.plot.diagrams import circles as circles
from gcxform.plot.diagrams import diagonals as diagonals
from gcxform.plot.diagrams import positioning as positioning
from gcxform.plot.models import model as model
from gcxform.plot.paths import heat as heat
from gcxform.plot.residuals import bundled as bundled
from gcxform.plot.residuals import circled as circled
from gcxform.plot.residuals import placed as placed
from gcxform.plot.sheets import sheets as sheets

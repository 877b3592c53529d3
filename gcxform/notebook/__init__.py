"""What a notebook shows of a program, a certificate or a model: small, whole, and never markup."""

from gcxform.notebook.drawing import Stroke as Stroke
from gcxform.notebook.drawing import drawn as drawn
from gcxform.notebook.page import shown as shown

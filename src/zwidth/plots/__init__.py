"""Pictures of a verdict: what is asked for, what is there, what the hand does.

Import it by name, `import zwidth.plots`: nothing else in the package does, so
that a verdict never waits for matplotlib.  `criterion`, `plane`, `budget`,
`witness`, `worst_case` and `check_figure` return a `matplotlib.figure.Figure`
that belongs to no window; the `draw_…` functions draw on axes of your own, in
the look of `LOOK` if your axes have it.
"""

from zwidth.plots.budget import budget, draw_damping, draw_friction
from zwidth.plots.criterion import criterion, draw_criterion
from zwidth.plots.plane import draw_plane, plane
from zwidth.plots.report import check_figure, save_check
from zwidth.plots.style import LOOK
from zwidth.plots.witness import draw_witness, witness
from zwidth.plots.worst_case import draw_worst_case, worst_case

__all__ = [
    "LOOK",
    "budget",
    "check_figure",
    "criterion",
    "draw_criterion",
    "draw_damping",
    "draw_friction",
    "draw_plane",
    "draw_witness",
    "draw_worst_case",
    "plane",
    "save_check",
    "witness",
    "worst_case",
]

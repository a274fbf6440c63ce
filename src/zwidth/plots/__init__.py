"""Pictures of a verdict: what is asked for, what is there, what the hand does.

Import it by name, `import zwidth.plots`: nothing else in the package does, so
that a verdict never waits for matplotlib.  Every function returns a
`matplotlib.figure.Figure` that belongs to no window; show it in a notebook or
write it with `figure.savefig`.
"""

from zwidth.plots.budget import budget
from zwidth.plots.criterion import criterion
from zwidth.plots.plane import plane
from zwidth.plots.report import check_figure, save_check
from zwidth.plots.witness import witness
from zwidth.plots.worst_case import worst_case

__all__ = ["budget", "check_figure", "criterion", "plane", "save_check", "witness", "worst_case"]

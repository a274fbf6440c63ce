"""Pictures of a verdict: what is asked for, what is there, what the hand does.

Import it by name, `import zwidth.plots`: nothing else in the package does, so
that a verdict never waits for matplotlib.  `criterion`, `plane`, `budget`,
`witness`, `worst_case`, `storage`, `cycle`, `indices`, `check_figure`,
`limit_figure`, `plot_held_pair`, `plot_lateness`, `plot_links`, `plot_pair`, `plot_scene`, `postures_figure`,
`sample_table_figure`, `sweep_figure`, `workspace_figure` and `z_width_figure` return a
`matplotlib.figure.Figure` that belongs to no window; the `draw_…` functions draw on axes of your own,
in the look of `LOOK` if your axes have it.
"""

from zwidth.plots.budget import budget, draw_damping, draw_friction
from zwidth.plots.criterion import criterion, draw_criterion
from zwidth.plots.cycle import cycle, draw_cycle
from zwidth.plots.held_pair import draw_held_damping, draw_held_stiffness, plot_held_pair
from zwidth.plots.indices import draw_index, indices
from zwidth.plots.lateness import draw_lateness, plot_lateness
from zwidth.plots.limit import limit_figure
from zwidth.plots.links import draw_links, plot_links
from zwidth.plots.null_space import null_space_figure
from zwidth.plots.pair import draw_pair_damping, draw_pair_link, plot_pair
from zwidth.plots.pair_motion import draw_pair_energy, draw_pair_motion
from zwidth.plots.plane import draw_plane, plane
from zwidth.plots.postures import postures_figure
from zwidth.plots.report import check_figure
from zwidth.plots.sample_table import draw_sample_table, sample_table_figure
from zwidth.plots.scene import draw_scene, plot_scene
from zwidth.plots.storage import draw_storage, storage
from zwidth.plots.style import LOOK
from zwidth.plots.sweep import save_sweep, sweep_figure
from zwidth.plots.witness import draw_witness, witness
from zwidth.plots.workspace import draw_workspace, workspace_figure
from zwidth.plots.worst_case import draw_worst_case, worst_case
from zwidth.plots.z_width import draw_z_width, save_z_width, z_width_figure

__all__ = [
    "LOOK",
    "budget",
    "check_figure",
    "criterion",
    "cycle",
    "draw_criterion",
    "draw_cycle",
    "draw_damping",
    "draw_friction",
    "draw_held_damping",
    "draw_held_stiffness",
    "draw_index",
    "draw_lateness",
    "draw_links",
    "draw_pair_damping",
    "draw_pair_energy",
    "draw_pair_link",
    "draw_pair_motion",
    "draw_plane",
    "draw_sample_table",
    "draw_scene",
    "draw_storage",
    "draw_witness",
    "draw_workspace",
    "draw_worst_case",
    "draw_z_width",
    "indices",
    "limit_figure",
    "null_space_figure",
    "plane",
    "plot_held_pair",
    "plot_lateness",
    "plot_links",
    "plot_pair",
    "plot_scene",
    "postures_figure",
    "sample_table_figure",
    "save_sweep",
    "save_z_width",
    "storage",
    "sweep_figure",
    "witness",
    "workspace_figure",
    "worst_case",
    "z_width_figure",
]

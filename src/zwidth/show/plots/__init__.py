"""Pictures of a verdict: what is asked for, what is there, what the hand does.

Import it by name, `import zwidth.plots`: nothing else in the package does, so that a verdict never waits for
matplotlib.  `criterion`, `plane`, `budget`, `witness`, `worst_case`, `storage`, `cycle`, `indices`,
`check_figure`, `limit_figure`, `plot_held_pair`, `plot_lateness`, `plot_links`, `plot_pair`, `plot_scene`,
`postures_figure`, `sample_table_figure`, `sweep_figure`, `workspace_figure` and `z_width_figure` return a
`matplotlib.figure.Figure` that belongs to no window; the `draw_…` functions draw on axes of your own, in the
look of `LOOK` if your axes have it.
"""

from zwidth.lazy import attach

__getattr__, __dir__, __all__ = attach(__name__)

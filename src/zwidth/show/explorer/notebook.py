"""The explorer in a notebook, or in an application of one's own with Panel."""

from __future__ import annotations

from importlib.util import find_spec
from typing import Any

from zwidth import installing
from zwidth.model.device import Device
from zwidth.model.environment import Environment


def explore(device: Device | None = None, environment: Environment | None = None) -> Any:
    """A loop with every parameter on a slider, and the verdict beside it; shows itself in a notebook.

    `zwidth explore` opens the same in a browser.  It takes Panel, the extra `explore`.

    Parameters
    ----------
    device
        The device to begin with; by default one of the catalogue.
    environment
        What it renders, with the laws in its chain; by default a wall.

    Returns
    -------
    zwidth.show.explorer.shown.Explorer
        A `panel.viewable.Viewer`: show it as the last line of a cell, or `.servable()` it.  Its `device`,
        `environment` and `verdict` are those of the sliders.

    Raises
    ------
    InputError
        If Panel is not installed, or a specification has no words for the environment.
    """
    need_libraries()
    from zwidth.show.explorer.shown import Explorer

    return Explorer.of(device, environment)


def need_libraries() -> None:
    """Nothing, if they are."""
    for module, name in (("panel", "Panel"), ("bokeh", "Bokeh")):
        if find_spec(module) is None:
            raise installing.needed(f"{name}, which draws the explorer page,", "explore")

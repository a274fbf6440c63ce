"""A session that shows itself, without the page around it."""

from __future__ import annotations

import sys
from weakref import finalize

import panel as pn
from panel.viewable import Viewer

from zwidth.errors import InputError
from zwidth.model.device import Device
from zwidth.model.environment import Environment, Wall
from zwidth.passivity.verdict import Verdict
from zwidth.show.explorer.session import Session
from zwidth.show.explorer.starts import first
from zwidth.show.explorer.state import State
from zwidth.show.explorer.working import Workers


class Explorer(Viewer):  # type: ignore[misc]  # Panel has no types
    """Sliders, verdict and pictures of one loop.

    `device`, `environment`, `verdict`: as the sliders stand.
    """

    def __init__(self, state: State) -> None:
        super().__init__()
        _need_extension()
        pn.extension(inline=True)
        workers = Workers()
        finalize(self, workers.close)
        self._session = Session(state, workers, _soon, in_page=False)
        views = self._session.views
        self._tabs = pn.Tabs(
            *((view.name, pn.Column(*view.parts, sizing_mode="stretch_width")) for view in views),
            dynamic=True,
        )
        self._tabs.param.watch(lambda change: self._session.see(views[change.new].key), "active")

    @staticmethod
    def of(device: Device | None, environment: Environment | None) -> Explorer:
        """Of a loop, or of what is not given of it the first one."""
        if device is None and environment is None:
            return Explorer(first())
        begun = first().loop()
        return Explorer(State.of(device or begun.device, environment or Wall(stiffness="200")))

    @property
    def device(self) -> Device:
        """The device, as its sliders stand."""
        return self._session.state.loop().device

    @property
    def environment(self) -> Environment:
        """What it renders."""
        return self._session.state.loop().environment

    @property
    def verdict(self) -> Verdict | None:
        """What is known of them; None while it is being worked out."""
        return self._session.verdict

    def __panel__(self) -> pn.Row:
        session = self._session
        answers = pn.Column(session.head, session.details, self._tabs, sizing_mode="stretch_width")
        return pn.Row(pn.Column(session.form, width=380), answers, sizing_mode="stretch_width")


def _need_extension() -> None:
    """In Jupyter Panel's scripts come with a cell before: sliders that are shown with them are not heard."""
    shell = sys.modules.get("IPython")
    if shell is not None and hasattr(shell.get_ipython(), "kernel") and not pn.extension._loaded:
        raise InputError(
            "Panel must be loaded before, in a cell of its own: import panel; panel.extension(inline=True)"
        )


def _soon(work: object) -> None:
    """In the thread of the document, where there is a server; else now."""
    document = pn.state.curdoc
    if document is not None and document.session_context:
        document.add_next_tick_callback(work)
    else:
        work()  # type: ignore[operator]

"""The command `explore`: a loop on a page, every parameter on a slider, the verdict beside it."""

from __future__ import annotations

import argparse
import sys
import webbrowser
from threading import Event

from zwidth.cli.options import LAW, PARAMETERS, overrides
from zwidth.cli.output import quiet_pipe
from zwidth.errors import InputError
from zwidth.model.specification.table import quoted

HOST = "127.0.0.1"
USUAL_PORT = 5007
"""Where the page is if nothing else is there."""

_PIECE = 0.2
"""How long Ctrl-C may go unheard [s]."""


USAGE = (
    "[SOURCE ...] [--law NAMES] [--PARAMETER VALUE ...] [--port N] [--address ADDRESS] "
    "[--token TOKEN] [--no-browser]"
)
OPTIONS = (
    {
        "sources=SOURCE*": "device of the catalogue, or TOML file with tables [device], [environment], "
        "[[law]]",
        **LAW,
    },
    "page",
    {
        "--port N": "port of the page (default: 5007, or a free one)",
        "--address ADDRESS": "address to listen to (default: 127.0.0.1, this machine alone); another asks "
        "for a token",
        "--token TOKEN": "that a browser must have, 16 characters or more",
        "--no-browser": "say the address, and open no browser",
    },
    *PARAMETERS,
)


def run(arguments: argparse.Namespace) -> int:
    """`zwidth explore`: until Ctrl-C."""
    from zwidth.show.explorer.notebook import need_libraries

    port = _port(arguments.port)
    need_libraries()
    from zwidth.show.explorer.starts import from_sources

    state = from_sources(arguments.sources, overrides(arguments), arguments.law)
    from zwidth.show.explorer.serving import serve_explorer  # seconds: after what was typed was read

    given = {"address": arguments.address or HOST, "token": arguments.token}
    try:
        page = serve_explorer(state, USUAL_PORT if port is None else port, **given)
    except InputError:
        if port is not None:
            raise
        page = serve_explorer(state, 0, **given)
    with page:
        with quiet_pipe(sys.stderr):
            print(f"exploring at {page.address} ; Ctrl-C ends it", file=sys.stderr, flush=True)
        if not arguments.no_browser:
            webbrowser.open(page.address)
        until_ctrl_c()
    return 0


def until_ctrl_c() -> None:
    """Wait for KeyboardInterrupt.

    In pieces: the system may hand a signal to any thread of a process, and one that waits without end in the
    main thread is not woken where another takes it.
    """
    never = Event()
    while not never.wait(_PIECE):
        pass


def _port(typed: str | None) -> int | None:
    if typed is None:
        return None
    if not typed.isdecimal() or not 0 <= int(typed) < 65536:
        raise InputError(f"--port is a port from 1 to 65535, or 0 for any that is free, got {quoted(typed)}")
    return int(typed)

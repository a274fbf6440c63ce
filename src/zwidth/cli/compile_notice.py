"""A word to people who wait for the compiler."""

from __future__ import annotations

import sys


def warn_of_compiling() -> None:
    """Say that the simulator is being compiled, where it has not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("loop"):
        _say("compiling the simulator")


def warn_of_compiling_the_iteration() -> None:
    """Say that value iteration is being compiled, where it has not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("passivity/storage"):
        _say("compiling the value iteration")


def warn_of_compiling_the_map() -> None:
    """Say that the kernel of the map is being compiled, where it has not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("maps"):
        _say("compiling the map")


def warn_of_compiling_the_estimates() -> None:
    """Say that the identification of devices is being compiled, where it has not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("identification/device"):
        _say("compiling the estimates")


def warn_of_compiling_the_links() -> None:
    """Say that ports and links are being compiled, where they have not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("links"):
        _say("compiling the ports")


def warn_of_compiling_the_servo() -> None:
    """Say that the served loop is being compiled, where it has not been yet."""
    from zwidth.compiled import is_compiled

    if not is_compiled("servo"):
        _say("compiling the loop")


def _say(what: str) -> None:
    if sys.stderr is not None:
        print(f"zwidth: {what}, once; this takes some seconds", file=sys.stderr)

"""Several logs of one device as one log."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import isclose

from zwidth.errors import InputError
from zwidth.identification.logs.log import Block, Log

SAME = 1e-3
"""Relative difference below which two sample periods, or two resolutions, are one that was measured twice."""


def join_logs(logs: Sequence[Log]) -> Log:
    """One log of the runs of all, one after the other; none is read before it is wanted.

    Parameters
    ----------
    logs
        Of the same device: as often sampled, with the same encoder and the same forces.

    Raises
    ------
    InputError
        If there is none, or they differ in that.
    """
    if not logs:
        raise InputError("there is no log to join; give one at least")
    first = logs[0]
    for log in logs[1:]:
        _same(first, log)

    def blocks() -> Iterator[Block]:
        before = 0
        for log in logs:
            for block in log.blocks():
                yield block._replace(run=block.run + before)
            before += log.runs

    return replace(
        first,
        source=", ".join(log.source for log in logs),
        samples=sum(log.samples for log in logs),
        runs=sum(log.runs for log in logs),
        findings=tuple(
            replace(finding, text=f"{log.source}: {finding.text}") for log in logs for finding in log.findings
        ),
        stops=(max(log.stops[0] for log in logs), min(log.stops[1] for log in logs)),
        _blocks=blocks,
    )


def _same(first: Log, log: Log) -> None:
    if not isclose(log.sample_period, first.sample_period, rel_tol=SAME):
        raise InputError(
            f"{first.source} has a sample period of {first.sample_period:g} s and {log.source} of "
            f"{log.sample_period:g} s: the limit 2b/T is another for each; identify them one by one"
        )
    for what in ("motion", "resolution", "channels"):
        one, other = getattr(first, what), getattr(log, what)
        if one != other and not (what == "resolution" and isclose(one, other, rel_tol=SAME)):
            raise InputError(
                f"{first.source} and {log.source} differ in their {what}, {one!r} and {other!r}: "
                "only logs of one device, recorded alike, can be joined"
            )

"""The kernels of the graphics card: a thread per group gathers its points, one per group and node moves."""

from __future__ import annotations

from numba import cuda

from zwidth.passivity.storage.losses import Integers
from zwidth.passivity.storage.solve.hull import extremes, improve, worthwhile


@cuda.jit  # type: ignore[untyped-decorator]
def gather(
    values: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    steps: int,
    reach: int,
    ranges: Integers,
    height: Integers,
    place: Integers,
    there: Integers,
) -> None:
    """A column of points per group; ranges are its least and greatest force and how many points there are."""
    group = cuda.grid(1)  # type: ignore[attr-defined]
    if group < ranges.shape[1]:
        least, most = extremes(forces, group, reach)
        points = 0
        if least <= most:
            columns = height[:, group], place[:, group], there[:, group]
            points = worthwhile(values, forces, costs, nodes, steps, group, reach, least, most, *columns)
        ranges[0, group], ranges[1, group], ranges[2, group] = least, most, points


@cuda.jit  # type: ignore[untyped-decorator]
def improve_all(
    values: Integers,
    choices: Integers,
    forces: Integers,
    costs: Integers,
    nodes: Integers,
    reach: int,
    ranges: Integers,
    place: Integers,
    there: Integers,
    gain: Integers,
    move: Integers,
    goal: Integers,
    improved: Integers,
) -> None:
    """Every thread takes a group and a node, and the next one as many further on as there are threads."""
    thread = cuda.grid(1)  # type: ignore[attr-defined]
    if thread < improved.size:
        count = 0
        for item in range(thread, ranges.shape[1] * nodes.size, improved.size):
            group = item // nodes.size
            if ranges[2, group] > 0:
                count += improve(
                    values,
                    choices,
                    forces,
                    costs,
                    nodes,
                    group,
                    reach,
                    ranges[0, group],
                    ranges[1, group],
                    ranges[2, group],
                    values,
                    there[:, group],
                    place[:, group],
                    there[:, group],
                    item % nodes.size,
                    gain[:, thread],
                    move[:, thread],
                    goal[:, thread],
                )
        improved[thread] = count

"""Sample files to try every command with: `zw.samples.path("session.csv")`, `zwidth examples FOLDER`.

`EXAMPLES` is the registry: which files belong together, what they are, and a command that takes them.
Each file says in its head where its numbers come from.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from zwidth.errors import InputError


class Example(NamedTuple):
    """Files that belong together: what they are, and what to type beside them."""

    files: tuple[str, ...]
    meaning: str
    command: str


EXAMPLES = (
    Example(
        ("wheel.toml", "bumpstop.toml"),
        "a steering wheel and the stop at the end of its way",
        "zwidth check wheel.toml bumpstop.toml",
    ),
    Example(
        ("paddle.toml", "wall.toml"),
        "a paddle and a wall that is too stiff: the motion, and what to change",
        "zwidth check paddle.toml wall.toml",
    ),
    Example(
        ("knob.toml", "turn.toml"),
        "a knob with three detents, and two fingers that turn it",
        "zwidth simulate knob.toml turn.toml --plot turn.png",
    ),
    Example(
        ("session.csv",),
        "a log of a hand that moves a paddle: what are its numbers?",
        "zwidth identify session.csv -o my-device.toml",
    ),
    Example(
        ("shaking.csv", "wheel.toml"),
        "a log of a wheel that shakes when it is let go: why, and what to change?",
        "zwidth diagnose shaking.csv wheel.toml",
    ),
    Example(
        ("relaxation.csv", "fit_tissue.py"),
        "a probe held in soft tissue: which tissue, and may it be rendered?",
        "zwidth tissue relaxation.csv phantom",
    ),
    Example(
        ("hapkit.toml",),
        "a Hapkit and its wall, as C for the board",
        'zwidth emit hapkit.toml --target arduino --travel "-60 .. 60 mm" -o hapkit',
    ),
    Example(
        ("arm.urdf",),
        "an arm of three joints: where does it render a wall?",
        "zwidth workspace arm.urdf --stiffness 500",
    ),
    Example(
        ("leader.toml", "follower.toml"),
        "two arms that follow each other over a link",
        'zwidth pair leader.toml follower.toml --stiffness 100 --link-delay "2 ms"',
    ),
    Example(
        ("arms.toml",),
        "the same two arms and what joins them, in one file",
        'zwidth pair arms.toml --link-delay "5 ms"',
    ),
    Example(
        ("leader.yaml", "follower.yaml"),
        "gain files of two arms: which joints are passive?",
        'zwidth gains leader.yaml follower.yaml --link-delay "2 ms"',
    ),
    Example(("room.toml",), "a scene cut into two processes and a device", "zwidth network room.toml --plan"),
    Example(
        (
            "firmware/device.toml",
            "firmware/walls/bump-stop.toml",
            "firmware/walls/soft-lock.toml",
            "firmware/.github/workflows/passivity.yml",
        ),
        "a repository of firmware: its build fails once a gain makes a wall active",
        "zwidth check firmware/device.toml firmware/walls/bump-stop.toml",
    ),
    Example(
        ("lesson-1-sampling.ipynb", "lesson-2-friction.ipynb", "lesson-3-laws.ipynb", "lesson-answers.ipynb"),
        "three lessons for a class, and their answers; the package jupyterlab opens them",
        "jupyter lab lesson-1-sampling.ipynb",
    ),
)
"""In the order of a first hour."""


def names() -> tuple[str, ...]:
    """The names of all sample files."""
    return tuple(name for example in EXAMPLES for name in example.files)


def path(name: str) -> Path:
    """Where a sample file is, to be read: ``zw.read_log(zw.samples.path("session.csv"))``.

    Parameters
    ----------
    name
        One of `names()`.
    """
    if name not in names():
        raise InputError(f"there is no sample {name[:60]!r}; there are: {', '.join(names())}")
    return Path(__file__).parent / name

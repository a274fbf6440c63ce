"""Scenes of elements at random, for tests: every node held by a mass, springs and contacts anywhere."""

from __future__ import annotations

import random
from fractions import Fraction

from zwidth import Scene
from zwidth.model.scene import Contact, CoulombFriction, Damper, Element, Lever, Mass, NonlinearSpring, Spring

LINEAR = ("spring", "damper", "mass", "lever")
ALL = (*LINEAR, "contact", "friction", "points")


def number(draw: random.Random, low: float, high: float) -> Fraction:
    """Between two magnitudes, of three digits, evenly over the decades."""
    return Fraction(f"{low * (high / low) ** draw.random():.3g}")


def random_scene(seed: int, size: int, kinds: tuple[str, ...] = ALL) -> Scene:
    """So many elements, drawn anew for each seed; the port is a node without mass on a spring."""
    draw = random.Random(seed)
    elements: list[Element] = [
        Spring("port", "body 0", number(draw, 10, 3000)),
        Mass("body 0", number(draw, 0.001, 1)),
    ]
    bodies = 1
    while len(elements) < size:
        kind = draw.choice(kinds)
        if kind in ("mass", "lever"):
            tied = kind == "lever"
            elements.append(Mass(f"body {bodies}", number(draw, 0.001, 1)))
            near = f"body {draw.randrange(bodies)}"
            if tied:
                ratio = draw.choice((-1, 1)) * number(draw, 0.2, 5)
                elements.append(Lever(near, f"body {bodies}", ratio))
            else:
                elements.append(Spring(near, f"body {bodies}", number(draw, 10, 3000)))
            bodies += 1
        else:
            first, second = draw.sample([*(f"body {i}" for i in range(bodies)), "ground", "port"], 2)
            elements.append(_between(draw, kind, first, second))
    return Scene(elements, port="port")


def _between(draw: random.Random, kind: str, first: str, second: str) -> Element:
    if kind == "spring":
        return Spring(first, second, number(draw, 10, 3000))
    if kind == "damper":
        return Damper(first, second, number(draw, 0.01, 10))
    if kind == "contact":
        gap = draw.choice((0, 1)) * number(draw, 1e-4, 1e-2)
        damping = draw.choice((0, 1)) * number(draw, 0.01, 10)
        return Contact(first, second, number(draw, 100, 30_000), damping, gap)
    if kind == "friction":
        return CoulombFriction(first, second, number(draw, 0.001, 1))
    places = sorted({number(draw, 1e-5, 1e-2) * draw.choice((-1, 1)) for _ in range(6)})
    forces = sorted(number(draw, 0.01, 5) * draw.choice((-1, 1)) for _ in range(len(places) - 2))
    return NonlinearSpring(first, second, places, [-5, *forces, 5])

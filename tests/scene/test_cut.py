"""A scene in parts: what the lines add, which cut adds least, and what is refused."""

import itertools
import random
from fractions import Fraction

import numpy as np
import pytest

from zwidth.errors import InputError
from zwidth.model.scene import Contact, Damper, Lever, Mass, Scene, SceneRun, Spring
from zwidth.model.scene.parts import best_parts, cut_scene


def chain(stiffnesses, handle=300):
    elements = [Spring("handle", "m0", handle)]
    for i, k in enumerate(stiffnesses):
        elements += [Mass(f"m{i}", 0.1), Spring(f"m{i}", f"m{i + 1}", k)]
    return Scene([*elements, Mass(f"m{len(stiffnesses)}", 0.1)])


def test_a_spring_becomes_a_line_as_stiff_that_brings_its_mass():
    made = cut_scene(chain([500, 100]), {"near": ["handle", "m0", "m1"], "far": ["m2"]}, "2 ms")
    (line,) = made.lines
    assert (line.parts, line.nodes, line.in_place_of) == (("near", "far"), ("m1", "m2"), "spring m1–m2")
    assert line.stiffness == pytest.approx(100)
    assert line.mass == pytest.approx(100 * 0.002**2)
    near, far = made.parts
    assert (near.scene.port, far.scene.port) == ("handle", "")
    assert [e.title for e in near.ends] == [e.title for e in far.ends] == ["spring m1–m2"]
    assert len(near.scene.elements) + len(far.scene.elements) == len(chain([500, 100]).elements) - 1 + 2
    assert "400 mg" in repr(made)
    assert "100 N/m" in repr(made)


def test_a_body_in_two_parts_becomes_a_line_as_heavy_that_gives_way():
    made = cut_scene(chain([500, 100]), {"near": ["handle", "m0", "m1"], "far": ["m1", "m2"]}, "2 ms")
    (line,) = made.lines
    assert (line.parts, line.nodes, line.in_place_of) == (("near", "far"), ("m1", "m1 in far"), "mass m1")
    assert line.mass == pytest.approx(0.1)
    assert line.adds() == f"{1e6 * 0.002**2 / 0.1:.4g} µm/N"
    near, far = made.parts
    assert [e.title for e in near.scene.elements] == [
        "mass m1",
        "spring handle–m0",
        "mass m0",
        "spring m0–m1",
    ]
    assert [e.title for e in far.scene.elements] == ["mass m1", "spring m1 in far–m2", "mass m2"]


def together(made, x, period):
    """The parts side by side, each step with the waves of the step before."""
    runs = {part.name: SceneRun(part.scene, period) for part in made.parts}
    comes = {(line.name, part): 0.0 for line in made.lines for part in line.parts}
    forces = []
    for move in np.diff(x, prepend=0):
        leaves = {}
        for part in made.parts:
            own = {name: wave for (name, where), wave in comes.items() if where == part.name}
            felt = runs[part.name].step(float(move) if part.scene.port else 0.0, own)
            if part.scene.port:
                forces.append(felt)
            for line in made.lines:
                if part.name in line.parts:
                    speed = runs[part.name].moved(line.name) / period
                    leaves[line.name, part.name] = 2 * float(line.impedance) * speed - own[line.name]
        comes = {(n, p): leaves[n, q] for n, p in comes for q in lines_of(made)[n] if q != p}
    return np.array(forces)


def lines_of(made):
    return {line.name: line.parts for line in made.lines}


@pytest.mark.parametrize(
    "parts",
    [
        {"near": ["handle", "m0", "m1"], "far": ["m2"]},
        {"near": ["handle", "m0", "m1"], "far": ["m1", "m2"]},
        {"near": ["handle", "m0"], "middle": ["m0", "m1"], "far": ["m2"]},
    ],
)
def test_parts_are_near_to_the_whole_and_nearer_with_shorter_steps(parts):
    scene = chain([500, 100])
    errors = []
    for n in (1, 4):
        x = 0.01 * np.sin(np.arange(1, 800 * n + 1) * 0.004 / n)
        period = Fraction(1, 1000 * n)
        whole = SceneRun(scene, period).follow(x)
        apart = np.abs(together(cut_scene(scene, parts, period), x, float(period)) - whole).max()
        errors.append(apart / np.abs(whole).max())
    assert errors[0] < 0.1
    assert errors[1] < 0.4 * errors[0]


def test_what_is_no_spring_stays_whole_and_a_line_leads_to_its_far_end():
    scene = Scene(
        [
            Spring("handle", "a", 100),
            Mass("a", 0.1),
            Mass("b", 0.1),
            Damper("a", "b", 0.5),
            Contact("a", "b", 900, gap=0.01, name="bump"),
            Lever("a", "c", 2),
            Mass("c", 0.1),
        ]
    )
    made = cut_scene(scene, {"near": ["handle", "a", "c"], "far": ["b"]}, 0.001, {"bump": 3})
    assert [(line.name, float(line.impedance), line.in_place_of) for line in made.lines] == [
        ("damper a–b", 0.5, ""),
        ("bump", 3.0, ""),
    ]
    near = made.parts[0].scene
    assert "b of bump" in near.nodes
    assert sum(e.title == "bump" for e in near.elements) == 2  # the contact, and the end of its line
    with pytest.raises(InputError, match="give impedances="):
        cut_scene(scene, {"near": ["handle", "a", "c"], "far": ["b"]}, 0.001)


def test_the_best_parts_cut_no_stiffer_spring_than_any_others_do():
    draw = random.Random(3)
    for _ in range(60):
        n = draw.randrange(3, 7)
        elements = [Mass(f"m{i}", 0.1) for i in range(n)] + [Spring("handle", "m0", 1e6)]
        pairs = list(itertools.combinations(range(n), 2))
        for i, j in draw.sample(pairs, draw.randrange(n - 1, len(pairs) + 1)):
            elements.append(Spring(f"m{i}", f"m{j}", draw.randrange(1, 1000)))
        scene = Scene(elements)
        count = draw.randrange(1, 4)
        try:
            found = best_parts(scene, count)
        except InputError:
            continue

        def stiffest(home, springs=elements[n + 1 :]):
            crossing = [float(e.stiffness) for e in springs if home[e.first] != home[e.second]]
            return max(crossing, default=0.0)

        ours = stiffest({node: name for name, nodes in found.items() for node in nodes})
        others = [
            stiffest({f"m{i}": c for i, c in enumerate(choice)})
            for choice in itertools.product(range(len(found)), repeat=n)
            if len(set(choice)) == len(found)
        ]
        assert ours == min(others)
        assert len(found) >= count


def test_a_node_without_mass_stays_with_its_stiffest_neighbour():
    assert best_parts(chain([500, 400], handle=1), 2) == {"part 1": ("handle", "m0", "m1"), "part 2": ("m2",)}

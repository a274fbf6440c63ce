"""Parts of the checker one by one, where a document shows only what all of them come to."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from importlib import import_module
from itertools import combinations, permutations, product
from math import comb, isqrt
from random import Random
from types import SimpleNamespace
from typing import Any

from . import Case


def part(name: str) -> Any:
    """Of the checker, as it is loaded now."""
    return import_module(f"zwidth.checker.{name}")


def refuses(function: Callable[..., Any], *values: Any, **more: Any) -> bool:
    """True where that is refused."""
    try:
        function(*values, **more)
    except part("document.refusal").Invalid:
        return True
    return False


def what_is_spent_adds_up() -> str:
    """In one document, and not from one to the next; what is too much at once is refused anywhere."""
    effort = part("document.refusal")
    most = effort.MOST * 10  # a product of no bits costs a tenth
    for _ in range(2):
        with effort.one_document():
            if refuses(effort.spend, 0.6 * most):
                return "refused too soon"
            if not refuses(effort.spend, 0.6 * most):
                return "two parts are not added"
    if refuses(effort.spend, 0.6 * most) or refuses(effort.spend, 0.6 * most):
        return "added where there is no document"
    if not refuses(effort.spend, 1.1 * most) or not refuses(effort.reserve, 2 * effort.MOST_ROOM):
        return "too much at once is let through"
    return "room is refused" if refuses(effort.reserve, effort.MOST_ROOM / 2) else ""


def numbers_are_read_and_told() -> str:
    """What is no number; how many digits are shown, and to which side they are rounded."""
    number = part("document.number")
    for value in (True, False, None, [], {}, "1_000", " 1", "1/0", "0x1", "nan", "1e5001", complex(1)):
        if not refuses(number.number, value):
            return f"{value!r} is read"
    for value, right in (
        ("1/3", Fraction(1, 3)),
        (0.1, Fraction(1, 10)),
        ("-.5e-1", Fraction(-1, 20)),
        ("7.", 7),
    ):
        if number.number(value) != right:
            return f"{value!r} is read as {number.number(value)}"
    for value, told in (
        (Fraction(0), "0"), (Fraction(1, 3), "0.333333"), (Fraction(1, 10**5), "0.00001"),
        (Fraction(10**8), "100000000"),
        (Fraction(1, 10**6), "1e-6"), (Fraction(3, 10**7), "3e-7"),
        (Fraction(10**9), "1e+9"), (Fraction(-5, 2), "-2.5"),
        (Fraction(123456789), "123457000"),
    ):  # fmt: skip
        if number.about(value) != told:
            return f"{value} is told as {number.about(value)}"
    if (number.down(Fraction(2, 3)), number.up(Fraction(2, 3))) != ("0.666666", "0.666667"):
        return "rounded to the wrong side"
    if number.common_scale([Fraction(1, 6), Fraction(3, 4)]) != 12:
        return "no common scale"
    if number.common_scale([Fraction(1, 3), Fraction(2)]) != 3 or number.common_scale([Fraction(5)]) != 1:
        return "a common scale larger than need be"
    large = 1 << 70
    if refuses(number.common_scale, [Fraction(1, large), Fraction(large)], 100) or not (
        refuses(number.common_scale, [Fraction(1, large), Fraction(1, large + 1)], 100)
        and refuses(number.common_scale, [Fraction(large**3)], 100)
    ):
        return "the number of digits"
    return ""


def polynomials_are_multiplied() -> str:
    """As many coefficients as there must be, none of an empty one."""
    polynomial = part("exact.polynomial")
    if polynomial.multiply([1, 2], [0, 3, 4]) != [0, 3, 10, 8] or polynomial.multiply([5], [7]) != [35]:
        return "a product"
    if polynomial.multiply([], [1]) or polynomial.multiply([1], []) or polynomial.multiply([], []):
        return "a product with nothing"
    return "" if polynomial.add([1, 2], [3]) == [4, 2] == polynomial.add([3], [1, 2]) else "a sum"


def _is_read_by(field: Any, value: Any) -> bool:
    """True where it is of that sort."""
    return not refuses(field.read, value, "", "linear")


def entries_are_told() -> str:
    """Exact decimals, fractions, intervals, units; the first four entries too many."""
    fields, file, number = part("document.fields"), part("document.file"), part("document.number")
    for value, told in (
        (Fraction(1, 10), "0.1"), (Fraction(7, 20), "0.35"), (Fraction(1, 6), "1/6"), (Fraction(3), "3"),
        (Fraction(-1, 3), "-1/3"), (Fraction(1, 3**90), "about 1.14574263767e-43"),
        (Fraction(2**300), "about 2.03703597633e+90"),
        (Fraction(2**200 - 1, 2**199), f"1.{10**199 - 5**199:0199d}"),
        (Fraction(1, 2**40), "9.094947017729282379150390625e-13"),
    ):  # fmt: skip
        if (found := number.exactly(value)) != told:
            return f"{value} is told as {found}"
    between = fields.Between(number.FORCE)
    if (
        between.text((Fraction(1), Fraction(2)), "linear") != "1 to 2"
        or between.text((1, 1), "linear") != "1"
    ):
        return "an interval"
    words = {
        "m_per_s_N": "m/s, N", "rad_per_s_N_m": "rad/s, N·m", "m_N": "m, N", "rad_N_m": "rad, N·m",
        "N_N_s_per_m": "N, N·s/m", "N_m_N_m_s_per_rad": "N·m, N·m·s/rad", "N_m_rad": "in N, m, rad",
        "N_m_s_rad": "in N, m, s, rad", "kg_m2": "kg·m²", "N_s_per_m": "N·s/m", "": "",
    }  # fmt: skip
    for ending, told in words.items():
        if number.in_words(ending) != told:
            return f"{ending} is told as {number.in_words(ending)}"
    record = fields.Record({"a": fields.Number()})
    try:
        record.read(dict.fromkeys("bcdefg", 1), "", "linear")
    except part("document.refusal").Invalid as error:
        if str(error) != "entries that no proof of this kind has: b, c, d, e":
            return str(error)
    one, two = (
        fields.Record({"a": fields.Number()}),
        fields.Record({"a": fields.Number(), "b": fields.Flag()}),
    )
    for first, second in ((one, two), (two, one), (fields.numbers(), two), (two, fields.numbers())):
        either = fields.Either(first, second, lambda value, first=first: _is_read_by(first, value))
        for value, names in (
            ({"a": 1}, ["a"]), ({"a": 1, "b": True}, ["a", "b"]), ([1, 2], ["name"]),
        ):  # fmt: skip
            if _is_read_by(first, value) or _is_read_by(second, value):
                rows = either.rows("name", either.read(value, "", "linear"), "linear")
                if [row.name for row in rows] != names:
                    return f"{value}, one of two sorts"
    long = fields.numbers()
    if long.text([Fraction(1)] * 12, "linear") != f"[{', '.join('1' * 12)}]" or "…" not in long.text(
        [Fraction(1)] * 13, "linear"
    ):
        return "a long list"
    if not fields.numbers().shown or fields.numbers(shown=False).shown:
        return "what is shown"
    deep: Any = 1
    for _ in range(11):
        deep = {"x": [deep, 1]}
    shallow: Any = 1
    for _ in range(11):
        shallow = {"x": shallow}
    return (
        ""
        if refuses(lambda: list(file._told(deep)))
        and refuses(lambda: list(file._told({"x": shallow})))
        and list(file._told(shallow)) == ["x"] * 11
        else "depth"
    )


def sums_of_minors_are_those_of_the_matrix() -> str:
    """Of Hermitian matrices of whole numbers, by all minors."""
    sums, random = part("port.index")._principal_sums, Random(1)
    for size, _ in product((1, 2, 3, 4), range(4)):
        a = [[(0, 0)] * size for _ in range(size)]
        for i in range(size):
            a[i][i] = (random.randrange(-9, 10), 0)
            for j in range(i):
                a[i][j] = (random.randrange(-9, 10), random.randrange(-9, 10))
                a[j][i] = (a[i][j][0], -a[i][j][1])
        right = [
            sum(
                _determinant([[a[i][j] for j in chosen] for i in chosen])[0]
                for chosen in combinations(range(size), k)
            )
            for k in range(1, size + 1)
        ]
        if sums(a) != right:
            return f"{a}: {sums(a)}, not {right}"
    return ""


def _times(x: tuple[Any, Any], y: tuple[Any, Any]) -> tuple[Any, Any]:
    return x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]


def _determinant(a: Sequence[Sequence[tuple[Any, Any]]]) -> tuple[Any, Any]:
    """By Leibniz."""
    real = imaginary = Fraction(0)
    for order in permutations(range(len(a))):
        sign = (-1) ** sum(order[i] > order[j] for j in range(len(a)) for i in range(j))
        term: tuple[Any, Any] = (sign, 0)
        for i, j in enumerate(order):
            term = _times(term, a[i][j])
        real, imaginary = real + term[0], imaginary + term[1]
    return real, imaginary


def minors_of_a_port_are_those_at_a_point() -> str:
    """Π = ½(Dᴴ N + Nᴴ D) − σ Dᴴ D at s = j tan θ/2 or z = e^{jθ}, in rational numbers."""
    matrix, system, random = part("port.index"), part("port.system"), Random(2)
    for continuous, axes, level in product(
        (True, False), (1, 2, 3), (Fraction(0), Fraction(2, 3), Fraction(-1))
    ):
        order, size = 2, range(axes)

        def some(low: int = -5) -> list[Fraction]:
            return [
                Fraction(random.randrange(low, 6), random.randrange(1, 4))
                for _ in range(random.randrange(0, 4))
            ]

        outputs, inputs = ([[some() for _ in size] for _ in size] for _ in range(2))
        d = inputs[0][0] = [Fraction(1), Fraction(2), Fraction(1, 2)]
        p = system.Port(outputs, inputs, d, continuous, level, order, axes)
        t = Fraction(random.randrange(1, 9), 5)
        c, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
        point = (Fraction(0), t) if continuous else (c, sine)
        n, u = ([[_at(q, point) for q in row] for row in side] for side in (outputs, inputs))
        pi = [[(Fraction(0), Fraction(0)) for _ in size] for _ in size]
        for i, j, k in product(size, size, size):
            for factor, a, b in ((Fraction(1, 2), u, n), (Fraction(1, 2), n, u), (-level, u, u)):
                real, imaginary = _times((a[k][i][0], -a[k][i][1]), b[k][j])
                pi[i][j] = pi[i][j][0] + factor * real, pi[i][j][1] + factor * imaginary
        more = (1 + c) ** order if continuous else Fraction(1)
        right = [
            more**k * sum(_determinant([[pi[i][j] for j in s] for i in s])[0] for s in combinations(size, k))
            for k in range(1, axes + 1)
        ]
        own = _at(d, point)
        found = matrix._minors_at(p, matrix._whole(p), t)
        if found != (c, more * (own[0] ** 2 + own[1] ** 2), right):
            return f"{p} at {t}"
    return ""


def _at(ascending: Sequence[Fraction], point: tuple[Fraction, Fraction]) -> tuple[Fraction, Fraction]:
    value: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    for c in reversed(ascending):
        value = _times(value, point)
        value = value[0] + c, value[1]
    return value


def lines_of_a_burst_are_those_of_the_port() -> str:
    """Re(N D̄) − σ |D|² at (m + j)Ω, and a row's answer to α − jβ."""
    motion, system, random = part("port.motion"), part("port.system"), Random(3)
    for power, order, cycles in product((1, 2, 3), (0, 1, 2, 3), (4, 6)):
        n, d = ([Fraction(random.randrange(-5, 6), 3) for _ in range(order + 1)] for _ in range(2))
        level, step = Fraction(random.randrange(-3, 4), 2), Fraction(random.randrange(2, 7), 3)
        told = SimpleNamespace(power=power, cycles=cycles, step=step)
        right = Fraction(0)
        for j in range(-power, power + 1):
            point = (Fraction(0), (cycles + j) * step)
            a, b = _at(n, point), _at(d, point)
            weight = Fraction(comb(2 * power, power + j) ** 2, 4**power)
            right += weight * (a[0] * b[0] + a[1] * b[1] - level * (b[0] ** 2 + b[1] ** 2)) / step
            row = [(system.part_of(q, 0), system.part_of(q, 1)) for q in (n, d)]
            (found,) = motion._line([row], point[1], [Fraction(2), Fraction(3)], [Fraction(-1), Fraction(5)])
            sums = [_times(q, w) for q, w in ((a, (2, 1)), (b, (3, -5)))]
            if found != (sums[0][0] + sums[1][0], sums[0][1] + sums[1][1]):
                return f"the answer of {n}, {d}"
        port = system.Port([[n]], [[d]], d, True, level, order, 1)
        if order <= 2 * power and motion._burst(port, told) != right:
            return f"a burst through {n}, {d}"
    return ""


def rotations_are_those_of_their_quaternions() -> str:
    """Whichever of its four numbers is the largest; there and back, and as a product."""
    pose, cells = part("arm.pose"), part("arm.cells")
    for told in (
        (9, 1, -2, 3),
        (1, 9, 2, -3),
        (-2, 1, 9, 3),
        (3, -1, 2, 9),
        (1, 0, 0, 0),
        (0, 0, 3, 4),
        (0, 0, 0, 1),
    ):
        w, x, y, z = told
        size = sum(v * v for v in told)
        doubled = [
            [-y * y - z * z, x * y - w * z, x * z + w * y],
            [x * y + w * z, -x * x - z * z, y * z - w * x],
            [x * z - w * y, y * z + w * x, -x * x - y * y],
        ]
        rotation = [
            [(i == k) + Fraction(2 * v, size) for k, v in enumerate(row)] for i, row in enumerate(doubled)
        ]
        found = pose._quaternion(rotation)
        if pose._rotation(found) != rotation or pose._rotation([Fraction(v) for v in told]) != rotation:
            return f"{told}: {found}"
        if any(found[i] * told[j] != found[j] * told[i] for i, j in product(range(4), repeat=2)):
            return f"{told} is not along {found}"
        rows = pose._times_quaternion([Fraction(v) for v in told])
        right = [[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]]
        for found_row, row in zip(rows, right, strict=True):
            for entry, v in zip(found_row, row, strict=True):
                off = abs(v * (1 << cells.BITS)) / Fraction(isqrt(size << 160), 1 << 80)
                if abs(abs(entry.middle) - off) > 99 or entry.middle * v < 0 or entry.radius > 99:
                    return f"{told} as a matrix"
    return ""


def turns_are_bounded() -> str:
    """Half for every joint that turns, where the hand turns in space; how many rows a wall has."""
    pose, chain = part("arm.pose"), part("arm.kinematics")
    told = chain.Chain([SimpleNamespace(slides=s) for s in (False, True, False, False)], [], [])
    found = [pose.turning_bend(told, pose.Pose(turns, True)) for turns in (0, 1, 3)]
    if found != [0, 0, Fraction(3, 2)]:
        return f"{found}"
    rows = [list(pose.Pose(turns, True).sizes) for turns in (0, 1, 3)]
    if rows != [[1, 2, 3], [3], [6]]:
        return f"{rows}"
    stiffness = [[Fraction(k if i == j else 0) for j in range(6)] for i, k in enumerate((1, 9, 3, 4, 2, 7))]
    plane = pose.in_words([row[:3] for row in stiffness[:3]], pose.Pose(1, True))
    if "up to 9 N/m and 3 N·m/rad" not in plane:
        return plane
    if not chain.NOTHING.is_zero:
        return "nothing is something"
    links = [SimpleNamespace(slides=False, low=0, high=0, translation=[Fraction(k), 0, 0]) for k in (9, 2, 4)]
    bends = chain.bends(chain.Chain(links, [Fraction(8), 0, 0], []))
    if [row[0] / chain.LONGER for row in bends] != [14, 12, 8]:
        return f"bends {bends}"
    said = pose.in_words(stiffness, pose.Pose(3, True))
    return (
        ""
        if "up to 9 N/m and 7 N·m/rad" in said and not pose.in_words(stiffness, pose.Pose(0, True))
        else said
    )


def what_an_arm_is_made_of_is_as_it_is_told() -> str:
    """Ends of cells and of boxes, matrices without a sign, and what is known of a projector, one by one."""
    cells, region, pose, null = (part(f"arm.{name}") for name in ("cells", "region", "pose", "null_space"))
    projector, enclosed, bits = (
        part("arm.null_space"),
        part("exact.enclosed").Enclosed,
        part("arm.cells").BITS,
    )
    numbers = [
        (x.middle, x.slopes, x.radius)
        for x in (
            cells._coordinate((4, 5), 0, [1]), cells._coordinate((4, 4), 0, [1]),
            cells._coordinate((-6, 10), 1, [0, 1, 3]), cells._coordinate((-6, 11), 0, [0]),
        )
    ]  # fmt: skip
    if numbers != [(4, (), 1), (4, (), 0), (2, (0, 8, 0), 0), (2, (9,), 0)]:
        return f"coordinates {numbers}"
    for matrix, right in (
        ([[1, 0], [1]], True), ([[1, 1], [1]], False), ([[2, 1], [1]], True), ([[2, 2], [1]], False),
        ([[2, 1, 0], [1, 0], [1]], True), ([[2, 1, 1], [2, 2], [2]], False), ([[0]], False),
        ([[5, 2, 1], [3, 1], [1]], True), ([[5, 2, 1], [3, 2], [1]], False), ([[1, 0, 0], [1, 1], [2]], True),
    ):  # fmt: skip
        if cells.positive([[enclosed(bits, x) for x in row] for row in matrix]) is not right:
            return f"{matrix} is told wrongly"
    for rows, right in (
        ([[0, 0], [0, "-1/2"]], False), ([[0, 0], [0, 0]], True), ([[0, 0], [0, "1/2"]], True),
        ([[1, 1], [1, 1]], True), ([[0, 0, 0], [0, 0, 1], [0, 1, 0]], False), ([[4, 2], [2, "9/10"]], False),
    ):  # fmt: skip
        if region._semidefinite([[Fraction(x) for x in row] for row in rows]) is not right:
            return f"{rows} is told wrongly"
    wall = SimpleNamespace(stiffness=[[1]], virtual_damping=[[-2]], damping_bound=[[3]])
    if region.matrices_of(wall, pose.Pose(0, False)) != ([[1]], [[-2]], [[3]]):
        return "the matrices of a wall"
    for row in range(3):
        need = [[Fraction(int((i, k) in ((row, 4), (4, row)))) for k in range(6)] for i in range(6)]
        if not refuses(pose.for_every_rest, need, pose.Pose(3, True)):
            return "forces and turns coupled"
    for places, signs in product(permutations(range(3)), product((1, -1), repeat=3)):
        turn = [[Fraction(signs[i] * (places[i] == k)) for k in range(3)] for i in range(3)]
        mirrored = _determinant([[(x, 0) for x in row] for row in turn])[0] < 0
        if refuses(pose._quaternion, turn) is not mirrored:
            return f"{turn} mirrors: {mirrored}"
    joint = SimpleNamespace(low=Fraction(-1), high=Fraction(2))
    chain, rest = SimpleNamespace(joints=[joint] * 3), [Fraction(-1), Fraction(1, 2), Fraction(3, 2)]
    encoders, chain_of = part("arm.region"), part("arm.kinematics")
    wider = encoders.with_steps(
        chain_of.Chain([chain_of.Joint(False, [], [], Fraction(1), Fraction(2))], [], []),
        encoders.Encoders([Fraction(1, 10)], [], []),
    ).joints[0]
    if (wider.low, wider.high) != (Fraction(9, 10), Fraction(21, 10)):
        return "a step to either side"
    held, moves = (SimpleNamespace(slides=False, low=0, high=high) for high in (0, 1))
    read = SimpleNamespace(resolution=Fraction(3), coulomb_friction=Fraction(2), largest_column=Fraction(5))
    if encoders.encoders_of(SimpleNamespace(joints=[read] * 2), SimpleNamespace(joints=[held, moves])) != (
        [0, 3], [2, 2], [5, 5]
    ):  # fmt: skip
        return "what a joint that stays is read with"
    unit = [[Fraction(i == k) for k in range(3)] for i in range(3)]
    link = chain_of.Joint(False, unit, [Fraction(0)] * 3, Fraction(0), Fraction(1))
    one = chain_of.Chain([link], [Fraction(3), Fraction(0), Fraction(0)], [])
    ((below,),) = encoders.columns_below(one, encoders.Encoders([], [], [Fraction(4)]))([enclosed(bits, 0)])
    if abs((16 - 9 * chain_of.LONGER**2) * 2**bits - below.middle) > 9:
        return "a column below the longest"
    box = null._box(chain, SimpleNamespace(rest=rest, distance=Fraction(1)))
    if box != [(-1, 0), (Fraction(-1, 2), Fraction(3, 2)), (Fraction(1, 2), 2)]:
        return f"a box {box}"
    around = projector.Near([[enclosed(bits, 3 << bits - 2, (), 1 << bits - 3)]], Fraction(1, 5), [])
    loop = SimpleNamespace(delay_samples=1, sample_period=Fraction(1, 10))
    spring = SimpleNamespace(stiffness=Fraction(4), damping=Fraction(2))
    left = null._left([[Fraction(9)]], around, loop, spring)  # 9 − (0.6 + 2) (3/4 + 1/8) − 2/5
    if left != [[9 - Fraction(13, 5) * Fraction(7, 8) - Fraction(2, 5)]]:
        return f"{left} is left"
    if projector._most(enclosed(bits, -3, (1, -2), 4)) != 10:
        return "the most of a number"
    for sign, off in ((1, Fraction(0)), (-1, Fraction(0)), (1, Fraction(1, 16))):
        # ∓[[8, 4], [4, 2]], its eigenvalues 0 and ∓10, and each entry twice as far off as those of Y₁
        y_1 = [
            [[enclosed(bits, sign * x << bits, (), int(off * 2**bits)) for x in row] for row in y]
            for y in ([[4, 1], [3, 0]], [[2, 2], [0, 0]])
        ]
        most = projector._form(y_1, 0, [0, 1])
        if not 10 + off * Fraction(36, 10) <= most <= 10 + off * 8 + Fraction(1, 100):
            return f"a form of up to {float(most)}"
    return ""


def what_a_hand_moves_is_bounded() -> str:
    """A mass and its inverse beside a usual one; when all is rational; how far it may move in a sample."""
    motion, enclosed, bits = part("known_hand.held_motion"), part("exact.enclosed").Enclosed, 40
    for off in (Fraction(0), Fraction(1, 10), Fraction(1, 2), Fraction(9, 10)):
        heavy, light = motion._near_1(1 - off, 1 + off, bits)
        spare = off**2 / (1 - off) / 2
        if light.radius > spare * 2**bits + 4 or heavy.radius > 2:
            return f"{off}: {light.radius} is too wide"
        for at in (-1, Fraction(-1, 2), 0, Fraction(1, 3), 1):
            for found, right in ((heavy, 1 + off * at), (light, 1 / (1 + off * at))):
                slope = found.slopes[0] * at if found.slopes else 0
                if abs(right * 2**bits - found.middle - slope) > found.radius:
                    return f"{right} of {off} at {at}"
    nothing, some = (Fraction(0),) * 2, (Fraction(0), Fraction(1))
    for damping, stiffness in product((nothing, some), repeat=2):
        moved = motion.Motion(some, damping, stiffness, Fraction(1), Fraction(0))
        if moved.is_free is not (damping == stiffness == nothing):
            return f"free with {damping}, {stiffness}"
    still, most = enclosed(8, 0), motion.LARGEST_NORM - 200
    for spring, loss in product((still, enclosed(8, most << 8, (100 << 8,), 101 << 8)), repeat=2):
        if refuses(motion._pushed, spring, loss, Fraction(1), 8) is not (
            spring is not still or loss is not still
        ):
            return "moved too far"
    near = enclosed(8, most << 8, (100 << 8,), 100 << 8)
    return "not moved too far" if refuses(motion._pushed, near, still, Fraction(1), 8) else ""


def what_two_arms_lose_is_summed_up() -> str:
    """What counts to the side of less, of a motion as of encoders, one by one."""
    coupling, passive, motion, held = (
        part(f"pair.{name}") for name in ("coupling", "passive", "motion", "held")
    )
    zero, nothing = Fraction(0), passive.NO_LINE
    side = coupling.Side(
        Fraction(1),
        zero,
        Fraction(1),
        [zero, zero],
        [zero, zero],
        0,
        [zero, zero],
        0,
        0,
        zero,
        Fraction(1),
        None,
        1,
    )
    if passive._beyond_springs(side._replace(own=[3, 0], other=[1, 0], echo=[2, 0]), nothing):
        return "a spring alone"
    for more in ({"own": [0, 1]}, {"other": [0, 1]}, {"echo": [0, 1]}, {"part": Fraction(1, 2)}):
        if not passive._beyond_springs(side._replace(**more), nothing):
            return f"{more} is a spring"
    if not passive._beyond_springs(side, nothing._replace(moving=1)):
        return "compensation is a spring"
    other = side._replace(other=[Fraction(5), zero])
    for often, right in ((1, [2, 4]), (2, [6, 4])):  # readings of a drive are not those that come back
        own = side._replace(own=[Fraction(3), Fraction(-1)], echo=[Fraction(-2), zero], often=often)
        own = own._replace(other=[zero, Fraction(-2)])
        other = other._replace(own=[Fraction(1), Fraction(2)], often=often)
        loop = SimpleNamespace(sample_period=Fraction(1))
        found = list(passive._errors(loop, [own, other], [nothing, nothing]))
        if found != [Fraction(right[0] + 2, 2), Fraction(3 + 5, 2)]:
            return f"errors {found} of {often} readings"
    arm = object.__new__(motion._Arm)
    arm.bounds, arm.helped, arm.pushed = {2: (3, 5)}, 0, 0
    for move, way, helped, pushed in (
        (2, 4, 8, 12),
        (2, -4, 0, -8),
        (-2, 4, -8, -28),
        (-2, -4, 0, -16),
        (0, 9, 0, -16),
    ):
        arm._help(move, way)
        if (arm.helped, arm.pushed) != (helped, pushed):
            return f"{move} by {way} gives {arm.helped}, {arm.pushed}"
    enclosed = part("exact.enclosed").Enclosed
    told = SimpleNamespace(free=side, period=Fraction(2), scale=4)
    cost = held._cost(
        told, [zero, Fraction(2), Fraction(1)], [enclosed(8, 512, (), 3), enclosed(8, 256, (), 1)]
    )
    right = Fraction(512 * 2 - 256 + 7, 4 << 8) + (4 + 1) / Fraction(2)
    return "" if cost == right else f"{cost} for a motion, not {right}"


def sizes_of_matrices_are_not_below() -> str:
    """√(‖A‖₁ ‖A‖∞) or ‖A‖_F, the smaller; a root is not below."""
    encoders, chain = part("arm.region"), part("arm.kinematics")
    for rows, square in (([[3, 4]], 25), ([[1, 1], [1, 1]], 4), ([[2, 0], [0, 2]], 4), ([[1, -2], [0, 0]], 5),
                         ([[-3, 0], [0, 0]], 9), ([[1], [-1]], 2)):  # fmt: skip
        found = encoders._size([[Fraction(x) for x in row] for row in rows])
        if not square <= found * found <= square * (1 + Fraction(1, 10**20)):
            return f"{rows}: {float(found)}"
    for x in (Fraction(2), Fraction(1, 3), Fraction(10**9 + 1, 7), Fraction(0)):
        if not x <= chain.root_above(x) ** 2 <= x * (1 + Fraction(1, 10**20)) + Fraction(1, 10**40):
            return f"a root of {x}"
    return "" if chain.root_above(Fraction(9, 4)) == Fraction(3, 2) else "a root of a square"


def a_friction_curve_goes_on() -> str:
    """Between its points, before the first, beyond the last."""
    law = part("contact.law")
    points = [(Fraction(1), Fraction(2)), (Fraction(2), Fraction(6)), (Fraction(4), Fraction(4))]
    told = law.Losses([], points, Fraction(1), Fraction(1), 0, Fraction(1))
    for speed, force in ((0, 2), (1, 2), ("3/2", 4), (2, 6), (3, 5), (4, 4), (6, 4)):
        if told._force(Fraction(speed)) != force:
            return f"{told._force(Fraction(speed))} at {speed}"
    for friction, damping in ((Fraction(1), Fraction(-1)), (Fraction(-1), Fraction(1, 2))):
        if not refuses(
            law._models_below,
            [[friction, damping]],
            [(Fraction(0), Fraction(9)), (Fraction(1), Fraction(10))],
        ):
            return f"a model of {friction} and {damping}"
    rising = told._replace(curve=points[:2])
    return "" if rising._force(Fraction(3)) == 10 else "beyond the last point"


def a_violation_is_the_criterion_at_a_point() -> str:
    """Up to a power of the denominator of cos θ, whatever the law and its delay are."""
    loop, criterion, violation = (part(f"loop.{name}") for name in ("loop", "linear", "violation"))
    value, random = part("exact.polynomial").value, Random(4)
    for above, below, whole, late in product((1, 3), (1, 2, 3), (0, 2), (Fraction(0), Fraction(1, 3))):
        n, d = ([Fraction(random.randrange(1, 9)) for _ in range(size)] for size in (above, below))
        size = max(above, below)
        n, d = (side + [Fraction(0)] * (size - len(side)) for side in (n, d))
        p = loop.Loop(n, d, Fraction(2), Fraction(0), Fraction(0), Fraction(1, 2), whole, late, False)
        c = Fraction(random.randrange(-6, 7), 7)
        right = (
            value(criterion.bounded_criterion(p, late * (1 - late)), c)
            if late
            else value(criterion.criterion(p), c)
        )
        found = violation.criterion_at(p, c)
        power = 1
        while power < 7**40 and found != right * power:
            power *= 7 if c else 10**99
        if found != right * (power if c else 1):
            return f"{found}, where {right} is the criterion of {p} at {c}"
    return ""


def contact_is_kept_by_motions_that_stay_inside() -> str:
    """At every sample but the first and the last; where the law has no surface nobody asks."""
    scope = part("scope")
    for positions, right in (
        ((0, 1, 2, 0), scope.KEPT), ((0, 0, 2, 0), scope.BROKEN), ((0, -1, 2, 3, 0), scope.BROKEN),
        ((0, 2, -1, 0), scope.BROKEN), ((0, 1, 2, 0, 0), scope.BROKEN), ((0, 5), scope.KEPT), ((-1, 1, -1),
         scope.KEPT),
    ):  # fmt: skip
        for unilateral in (True, False):
            loop = SimpleNamespace(unilateral=unilateral, resolution=0)
            found = scope.of_a_motion(SimpleNamespace(positions=positions, loop=loop)).contact
            if found != (right if unilateral else scope.BOTH_SIDES):
                return f"{positions}: {found}"
    return ""


def rounds_are_summed_once_they_are_alike() -> str:
    """Where what is remembered has moved on by as much as the hand over H(1), and every force with it."""
    motion = part("loop.motion")
    for unilateral, encoder, before, after, forces, advance, lowest, right in (
        (False, 0, [2, 5], [5, 8], ([1, 2], [7, 8]), 3, 0, 6), (False, 3, [0, 0], [3, 3], ([0], [6]), 3, -9,
         6),
        (False, 0, [1, 1], [3, 3], ([1], [7]), 3, 0, None), (False, 0, [0, 0], [3, 4], ([1], [7]), 3, 0,
         None),
        (False, 0, [0, 0], [3, 3], ([1], [6]), 3, 0, None), (False, 0, [0, 0], [3, 3], ([0, 0], [6, 5]), 3,
         0, None),
        (False, 2, [0, 0], [3, 3], ([0], [6]), 3, 0, None), (True, 0, [0, 0], [3, 3], ([0], [6]), 3, 0, None),
        (True, 0, [0, 0], [3, 3], ([0], [6]), 3, 1, 6), (True, 3, [0, 0], [3, 3], ([0], [6]), 3, 2, None),
        (False, 0, [1], [1], ([2], [2]), 0, 0, 0), (False, 0, [1], [2], ([2], [2]), 0, 0, None),
        (False, 0, [1], [1], ([2], [3]), 0, 0, None), (False, 0, [3], [3], ([3], [2]), 0, 0, None),
        (False, 0, [0, 0], [3, 3], ([0], [7]), 3, 0, None),
    ):  # fmt: skip
        run = object.__new__(motion._Run)
        run.p, run.encoder = SimpleNamespace(unilateral=unilateral), encoder
        run.numerator, run.denominator, run.scale, run.memory, run.forces = (
            [3, -1],
            [2, -1],
            1,
            after,
            forces[1],
        )
        found = run._push(before, forces[0], advance, lowest)
        if found != right or (found is None) is not (right is None):
            return f"{before} to {after}, {forces}, by {advance}: {found}"
        run.denominator = [3, -1]  # by 3 nothing whole is remembered
        if advance and run._push(before, forces[0], advance, 2) is not None:
            return f"{advance} over 2"
    return ""


def a_motion_in_contact_is_read_as_late_as_it_is() -> str:
    """Forces of two ages, bounds of speed in each part of a sample, and roundings that are never a gain."""
    motion = part("contact.motion")
    law = SimpleNamespace(force=lambda readings, _: readings[0], averaged=lambda average, _: average)
    for delay, right in ((0, (9, 9)), (1, (7, 9)), (2, (5, 7)), (3, (4, 5))):
        losses, state = SimpleNamespace(delay=delay, resolution=1), motion._State([0] * 5, [0] * 5)
        for reading in (4, 5, 7, 9):
            found = state.read(reading, law, losses, 1)
        if found != right:
            return f"{found}, {delay} samples late"
    losses = SimpleNamespace(resolution=2)
    for stiffness in (3, -3):
        relaxing = SimpleNamespace(relaxing=(Fraction(1, 2), Fraction(stiffness)))
        if motion._uncertainty(relaxing, losses, [0, 5, 4]) != Fraction(3 * 6 * 2 * 2) / motion.FINEST:
            return f"roundings of {stiffness}"
    losses = SimpleNamespace(part=Fraction(1, 4), period=Fraction(2))
    for speed, right in ((Fraction(2), True), (Fraction(19, 10), False)):
        for path, turn in (([0, 4], 1), ([4, 0], 3), ([0, 1], 1), ([1, 4], 1)):
            if motion._slow(losses, path, [turn], speed) is not right:
                return f"{path} by {turn} at {speed}"
        if motion._slow(SimpleNamespace(part=1, period=Fraction(2)), [0, 4, 0], [], speed) is not right:
            return f"in one at {speed}"
    return ""


def a_cycle_gains_in_all_and_again() -> str:
    """More than nothing, both times."""
    kinds, loop = part("kinds"), SimpleNamespace(sample_period=1)
    told = SimpleNamespace(energy=None, sample_period=None, loop=loop)
    for sums, right in (((0, 1), False), ((1, 0), False), ((-1, 1), False), ((2, 3), True)):
        found = kinds._round_again(lambda _, sums=sums: tuple(map(Fraction, sums)))(told)
        if found.valid is not right or (found.energy, found.gain) != sums:
            return f"{sums}: {found}"
        if not right and f"extracts {min(sums)} J: none" not in found.reason:
            return found.reason
    return ""


CHECKS = (
    a_violation_is_the_criterion_at_a_point,
    contact_is_kept_by_motions_that_stay_inside,
    rounds_are_summed_once_they_are_alike,
    a_motion_in_contact_is_read_as_late_as_it_is,
    a_cycle_gains_in_all_and_again,
    what_is_spent_adds_up,
    numbers_are_read_and_told,
    polynomials_are_multiplied,
    entries_are_told,
    sums_of_minors_are_those_of_the_matrix,
    minors_of_a_port_are_those_at_a_point,
    lines_of_a_burst_are_those_of_the_port,
    rotations_are_those_of_their_quaternions,
    turns_are_bounded,
    what_an_arm_is_made_of_is_as_it_is_told,
    what_a_hand_moves_is_bounded,
    what_two_arms_lose_is_summed_up,
    sizes_of_matrices_are_not_below,
    a_friction_curve_goes_on,
)

CASES = [Case(check.__name__.replace("_", " "), check, "") for check in CHECKS]

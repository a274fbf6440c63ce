"""Random functions of the subset of Python that is emitted, as text.

Each has the arguments m, an array of 6; p, five known numbers; q, a known whole number; x, y and k.  Every
loop ends, every index is inside and every whole number small, whatever x, y and k are.
"""

from __future__ import annotations

from random import Random

CELLS, KNOWN = 6, 5

HEAD = """\
from math import ceil, fabs, floor, sqrt


def over(a, b):
    return a / b


def twice(a, b):
    if a < b:
        if b > 2.0:
            return b, a
        a = a + 1.0
    elif a == b:
        return 0.0, a
    return a, b


def searched(m, a, n):
    found = -1.0
    for i in range(n):
        if m[i % 6] > a:
            found = m[i % 6]
            break
    else_ = 0
    while else_ < n:
        else_ += 1
        if found > 0.5 * else_:
            return found
        for j in range(else_):
            if a > m[j % 6] + 3.0:
                return a - j
    return found


def kept(m, i, a):
    m[i] = a + m[i]
    return m[i] > 0.0

"""


class _Function:
    def __init__(self, random: Random, name: str) -> None:
        self.random, self.name = random, name
        self.lines: list[str] = []
        self.reals, self.wholes, self.truths = ["x", "y"], ["k", "q"], []
        self.counts = 0
        self.budget = 30

    # ---- expressions

    def real(self, depth: int = 0) -> str:
        r, deep = self.random, depth + 1
        if depth > 2 or r.random() < 0.3:
            return r.choice([*self.reals, *self.reals, repr(round(r.uniform(-4, 4), 2)), "0.0", "-0.0"])
        a, b = self.real(deep), self.real(deep)
        made = r.choice([
            "({a} + {b})", "({a} - {b})", "({a} * {b})", "over({a}, {b})", "over(1, {a})", "(-{a})",
            "abs({a})", "fabs({a})", "sqrt(abs({a}))", "min({a}, {b})", "max({a}, {b}, x)",
            "({a} if {t} else {b})", "m[{i}]", "m[{i}]", "p[{w} % 5]", "p[3]", "({w} * {a})", "float({w})",
            "({a} % 1.5)", "(min(max({a}, -1e6), 1e6) // 1.0)", "searched(m, {a}, 3)",
            "searched(m, {a}, {w})",
        ])  # fmt: skip
        return self.filled(made, deep, a=a, b=b)

    def filled(self, made: str, depth: int, **given: str) -> str:
        """A text with what it asks for: a whole number, a condition, a place."""
        for key, make in {"w": self.whole, "t": self.truth, "i": self.place}.items():
            if f"{{{key}}}" in made:
                given[key] = make(depth)
        return made.format(**given)

    def whole(self, depth: int = 0) -> str:
        r, deep = self.random, depth + 1
        if depth > 2 or r.random() < 0.4:
            return r.choice([*self.wholes, str(r.randrange(-3, 6))])
        made = r.choice([
            "({a} + {b})", "({a} - {b})", "({a} * {b} % 11)", "({a} // 3)", "(-{a})", "abs({a})",
            "min({a}, {b})", "({a} if {t} else {b})", "int(min(max({x}, -9.0), 9.0) if {x} == {x} else 2.0)",
            "floor(min(max({x}, -9.0), 9.0) if {x} == {x} else 2.0)",
            "ceil(min(max({x}, -9.0), 9.0) if {x} == {x} else 2.0)",
        ])  # fmt: skip
        text = self.filled(made, deep, a=self.whole(deep), b=self.whole(deep), x=self.real(deep + 1))
        return f"({text} % {r.randrange(2, 12)})" if r.random() < 0.5 else text

    def place(self, depth: int = 0) -> str:
        r = self.random
        return str(r.randrange(CELLS)) if r.random() < 0.4 else f"{self.whole(depth + 1)} % {CELLS}"

    def truth(self, depth: int = 0) -> str:
        r, deep = self.random, depth + 1
        if self.truths and r.random() < 0.2:
            return r.choice(self.truths)
        if depth > 2 or r.random() < 0.4:
            return f"{self.real(deep)} {r.choice(['<', '<=', '==', '!=', '>', '>='])} {self.real(deep)}"
        made = r.choice([
            "({t} and {b})", "({t} or {b})", "(not ({t}))", "{x} < {y} <= {x}", "{w} < {y}", "{w} == 2",
            "-1 <= {w} < 3", "(({t}) == ({b}))", "({t} and kept(m, {i}, {x}))",
            "(kept(m, {i}, {x}) or kept(m, {i}, {y}))",
        ])  # fmt: skip
        return self.filled(made, deep, b=self.truth(deep), x=self.real(deep), y=self.real(deep))

    # ---- statements

    def block(self, depth: int, loop: bool) -> None:
        """Some statements; names that are new in it are forgotten behind it."""
        before = list(self.reals), list(self.wholes), list(self.truths)
        for _ in range(self.random.randrange(1, 4)):
            self.statement(depth, loop)
        self.reals, self.wholes, self.truths = before

    def say(self, depth: int, text: str) -> None:
        self.lines.append("    " * depth + text)

    def statement(self, depth: int, loop: bool) -> None:
        r = self.random
        self.budget -= 1
        kinds = ["real", "real", "whole", "truth", "cell", "cell", "tuple", "grow"]
        if self.budget > 0 and depth < 4:
            kinds += ["if", "if", "for", "while", "over"]
        if loop:
            kinds += ["break", "continue"]
        kinds += ["return"] if depth > 1 else []
        kind = r.choice(kinds)
        if kind in ("break", "continue"):
            self.say(depth, kind)
        else:
            getattr(self, f"_{kind}")(depth, loop)

    def _name(self, among: list[str], prefix: str) -> str:
        changing = [n for n in among if n not in ("q", "k") and not n.startswith("i")]
        if changing and self.random.random() < 0.6:
            return self.random.choice(changing)
        return self._new(prefix)

    def _new(self, prefix: str) -> str:
        self.counts += 1
        return f"{prefix}{self.counts}"

    def _set(self, depth: int, kind: str, value: str) -> None:
        among = getattr(self, kind)
        name = self._name(among, kind[0])
        self.say(depth, f"{name} = {value}")
        setattr(self, kind, [*dict.fromkeys([*among, name])])

    def _real(self, depth: int, loop: bool) -> None:
        self._set(depth, "reals", self.real())

    def _whole(self, depth: int, loop: bool) -> None:
        self._set(depth, "wholes", f"({self.whole()}) % 13")

    def _truth(self, depth: int, loop: bool) -> None:
        self._set(depth, "truths", self.truth())

    def _cell(self, depth: int, loop: bool) -> None:
        self.say(depth, f"m[{self.place()}] {self.random.choice(['=', '+=', '*='])} {self.real()}")

    def _tuple(self, depth: int, loop: bool) -> None:
        a, b = self.random.choice(self.reals), self.random.choice(self.reals)
        if a == b or "i" in (a[0], b[0]):
            return self._real(depth, loop)
        value = self.random.choice([f"{b}, {a}", f"twice({a}, {self.real(1)})", f"{b} + {a}, {self.real(1)}"])
        self.say(depth, f"{a}, {b} = {value}")
        return None

    def _grow(self, depth: int, loop: bool) -> None:
        name = self.random.choice(self.reals)
        self.say(depth, f"{name} {self.random.choice(['+=', '-=', '*='])} {self.real(1)}")

    def _if(self, depth: int, loop: bool) -> None:
        self.say(depth, f"if {self.truth()}:")
        self.block(depth + 1, loop)
        if self.random.random() < 0.3:
            self.say(depth, f"elif {self.truth()}:")
            self.block(depth + 1, loop)
        if self.random.random() < 0.5:
            self.say(depth, "else:")
            self.block(depth + 1, loop)

    def _for(self, depth: int, loop: bool) -> None:
        name = self._new("i")
        passes = self.random.choice(
            ["2", "3", "q", "40", "k", f"{self.whole(1)}", "5, -1, -2", "k, 9", "1, k + 2, 3"]
        )
        self.say(depth, f"for {name} in range({passes}):")
        self.wholes.append(name)
        self.block(depth + 1, True)
        self.wholes.remove(name)

    def _over(self, depth: int, loop: bool) -> None:
        name = self._new("r")
        self.say(depth, f"for {name} in ({self.real(1)}, {self.real(1)}):")
        self.reals.append(name)
        self.block(depth + 1, True)
        self.reals.remove(name)

    def _while(self, depth: int, loop: bool) -> None:
        name = self._new("i")
        self.say(depth, f"{name} = {self.random.choice(['3', 'k % 5', '7'])}")
        self.say(depth, f"while {name} > 0 and {self.truth(1)}:")
        self.say(depth + 1, f"{name} -= 1")
        self.block(depth + 1, True)

    def _return(self, depth: int, loop: bool) -> None:
        self.say(depth, f"return {self.real(1)}, {self.real(2)}")


def random_function(random: Random, name: str) -> str:
    f = _Function(random, name)
    f.lines.append(f"def {name}(m, p, q, x, y, k):")
    for _ in range(random.randrange(3, 8)):
        f.statement(1, False)
    f.lines.append(f"    return {f.real(1)}, {f.real(1)}")
    return "\n".join(f.lines) + "\n\n\n"

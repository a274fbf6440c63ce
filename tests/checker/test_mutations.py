"""The mistakes that are made on purpose: each compiles, changes its source, and is told as it is."""

from __future__ import annotations

import ast

from mutations import mutants_of

SOURCE = '''
"""A law."""
from math import inf
LIMIT = 3

def least(a: int, b: int = 2) -> str:
    """Not a word of this."""
    if a < b and not a == LIMIT:
        raise ValueError("too small")
    for word in ("one", "two"):
        return f"{word} of {min(a, -b)}"
    sizes = (a + b, less(a, b))
    return "the last of it"
'''
EXPECTED = {
    "LIMIT = 3 is 4": (4, "3 → 4"),
    "a default": (6, "2 → 1"),
    "a comparison": (8, "a < b → a <= b"),
    "a condition": (8, "a < b and (not a == LIMIT) → True"),
    "an equality": (8, "a == LIMIT → a != LIMIT"),
    "one of two conditions": (8, "a < b and (not a == LIMIT) → a < b"),
    "a refusal": (9, "removed"),
    "a word": (10, "('one', 'two') → ('two',)"),
    "an early return": (11, "removed"),
    "a term left out": (12, "a + b → b"),
    "an element left out": (12, "(a + b, less(a, b)) → (a + b,)"),
    "two that change places": (12, "less(a, b) → less(b, a)"),
    "a name of the same type": (12, "b → a"),
}


def changed(place: int) -> str:
    """The source with its mutant of that place."""
    tree = ast.parse(SOURCE)
    list(mutants_of(tree))[place].make()
    compile(ast.fix_missing_locations(tree), "<mutant>", "exec")
    return ast.unparse(tree)


def test_every_mutant_is_another_source() -> None:
    """One change each, and looking for them leaves the source as it is."""
    tree = ast.parse(SOURCE)
    found = list(mutants_of(tree))
    assert ast.unparse(tree) == ast.unparse(ast.parse(SOURCE))
    sources = [changed(place) for place in range(len(found))]
    assert ast.unparse(tree) not in sources
    assert len(set(sources)) == len(sources)
    assert {(m.line, m.change) for m in found} >= set(EXPECTED.values())
    assert (8, "a == LIMIT → a <= LIMIT") not in {(m.line, m.change) for m in found}


def test_what_is_said_to_people_is_left_alone() -> None:
    """No mutant of a docstring, a message or an annotation."""
    for place, _ in enumerate(list(mutants_of(ast.parse(SOURCE)))):
        source = changed(place)
        assert '"""A law."""' in source
        assert "Not a word of this." in source
        assert "a: int, b: int=" in source
        assert "too small" in source or "raise" not in source
        assert "the last of it" in source or "return 'the" not in source

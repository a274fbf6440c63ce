"""A parameter file of ROS 2, written: nodes, ros__parameters and gains, units in comments.

ROS keeps the type of a parameter: a gain is a double, so that 200 is written 200.0, and a rate is an integer.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from textwrap import wrap

from zwidth.data.gains.controllers import JointLaw
from zwidth.model.specification.table import plain
from zwidth.quantity.text import exact_text

_PLAIN = re.compile(r"[A-Za-z_/][A-Za-z0-9_./*-]*")
_NOT_TEXT = {"yes", "no", "on", "off", "true", "false", "null"}
"""Words that are no text where nothing quotes them."""

_WIDTH = 100
_UNITS = {"p": "N*m/rad", "i": "N*m/(rad*s)", "d": "N*m*s/rad"}

Remarks = Mapping[str, str]
Tree = dict[str, "Tree | str"]


def text_of(tree: Tree, head: Sequence[str]) -> str:
    """A file, line by line: comments, then keys; `tree` holds each value as it is written."""
    comments = [line for text in head for line in _comment(text)]
    return "\n".join([*comments, *_lines(tree, 0), ""])


def parameter_file(
    laws: Sequence[tuple[JointLaw, Remarks]], rate: Fraction, manager: tuple[str, ...], head: Sequence[str]
) -> str:
    """The text of a file with these joints, each with remarks on its "p", "i" and "d", below comments. `rate`
    [Hz] is of the controller manager, below the keys `manager`; one that is no whole number is said in the
    head alone, and so is that of ROS 1, whose robots have it in their code."""
    tree: Tree = {}
    if rate.denominator == 1 and all(law.form != "pid" for law, _ in laws):
        place_of(tree, manager)["update_rate"] = f"{rate}  # Hz, for which the gains are proved"
    for keys in dict.fromkeys(law.keys for law, _ in laws):
        own = [(law, remarks) for law, remarks in laws if law.keys == keys]
        place = place_of(tree, keys)
        by_joint = [pair for pair in own if pair[0].form == "gains"]
        listed = [pair for pair in own if pair[0].form == "k_gains"]
        for law, remarks in (pair for pair in own if pair[0].form == "pid"):
            place["pid"] = dict(_rows(law, remarks))
        if by_joint:
            place["gains"] = {law.name: dict(_rows(law, remarks)) for law, remarks in by_joint}
        if listed:
            place["k_gains"] = _list(listed, "p")
            place["d_gains"] = _list(listed, "d")
    return text_of(tree, head)


def double(value: Fraction) -> str:
    """A number as a double of YAML: with a point, without an exponent."""
    text = f"{Decimal(exact_text(value)):f}" if "/" not in exact_text(value) else f"{float(value):.17f}"
    return text if "." in text else f"{text}.0"


def place_of(tree: Tree, keys: Sequence[str]) -> Tree:
    """Where the keys lead, made where it is missing."""
    for key in keys:
        inner = tree.setdefault(key, {})
        assert isinstance(inner, dict)
        tree = inner
    return tree


def _rows(law: JointLaw, remarks: Remarks) -> Iterator[tuple[str, Tree | str]]:
    for key, value in (("p", law.stiffness), ("i", law.integral), ("d", law.damping)):
        remark = f"; {remarks[key]}" if key in remarks else ""
        yield key, f"{double(value)}  # {_UNITS[key]}{remark}"


def _list(laws: Sequence[tuple[JointLaw, Remarks]], key: str) -> str:
    values = [law.stiffness if key == "p" else law.damping for law, _ in laws]
    remarks = [f"{law.name} {told[key]}" for law, told in laws if key in told]
    return f"[{', '.join(map(double, values))}]  # {_UNITS[key]}" + "".join(f"; {r}" for r in remarks)


def _lines(tree: Tree, depth: int) -> Iterator[str]:
    for key, value in tree.items():
        name = f"{'  ' * depth}{_key(key)}:"
        if isinstance(value, str):
            yield f"{name} {value}"
        else:
            yield name
            yield from _lines(value, depth + 1)


def _key(text: str) -> str:
    if _PLAIN.fullmatch(text) and text.lower() not in _NOT_TEXT:
        return text
    return json.dumps(text)


def _comment(text: str) -> Iterator[str]:
    for line in wrap(plain(text, 1000), _WIDTH - 2, subsequent_indent="  " if text.startswith("- ") else ""):
        yield f"# {line}"

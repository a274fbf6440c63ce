"""Documents of any kind: what is read as a number, what is read at all, and which kinds there are."""

from __future__ import annotations

from . import accepted, put, refused
from .linear import SPRING as LINEAR
from .spring import spring

SPRING = spring(4)
NUMBERS = {
    "4": True,
    "+4": True,
    "4.": True,
    "0.4e1": True,
    "40E-1": True,
    "8/2": True,
    ".4e+1": True,
    "8/-2": False,
    "1/0": False,
    "0/0": False,
    "": False,
    " 4": False,
    "4 ": False,
    "4_0": False,
    "0x4": False,
    "nan": False,
    "inf": False,
    "four": False,
    "4e": False,
    "4/": False,
    "4,0": False,
    "٤": False,
}

CASES = [
    *(
        accepted(f"b is {text!r}", spring(text))
        if holds
        else refused(f"b is {text!r}", spring(text), "expected a number")
        for text, holds in NUMBERS.items()
    ),
    *(
        refused(f"b is {value!r}", spring(value), "expected a number")
        for value in (True, False, None, {}, [4])
    ),
    accepted("b is a float", spring(4.0)),
    accepted("b is large", spring("1e5000")),
    refused("b is too large", spring("1e5001"), "ordinary size"),
    accepted("b is small, K = 0", spring("1e-5000", [0])),
    refused("b is too small", spring("1e-5001", [0]), "ordinary size"),
    accepted("b is 0 with a large exponent", spring("0e9999", [0])),
    accepted("b has many digits", spring("4." + "0" * 19_998)),
    refused("b has too many digits", spring("4." + "0" * 19_999), "too many digits"),
    refused("N is a text", put(SPRING, {"loop.numerator": "8"}), "numerator must be a list"),
    refused(
        "a word where an object is to say of which sort it is",
        put(LINEAR, {"proof.stability": "kind"}),
        "stability must be an object with kind",
    ),
    refused(
        "a list where an object is to say of which sort it is",
        put(LINEAR, {"proof.stability": ["kind"]}),
        "stability must be an object with kind",
    ),
    refused("N is a number", put(SPRING, {"loop.numerator": 8}), "numerator must be a list"),
    refused(
        "N is too long", put(SPRING, {"loop.numerator": [0] * 2001}), "numerator must have 1 to 2000 entries"
    ),
    accepted("N is long", spring(0, [0] * 2000, [1] + [0] * 1999)),
    refused("damping twice", put(SPRING, {"loop.damping_N_m_s_per_rad": 4}), "of a rotary one"),
    refused(
        "damping in another unit",
        {
            "kind": "spring",
            "loop": {
                **{k: v for k, v in SPRING["loop"].items() if k != "damping_N_s_per_m"},
                "damping_N_per_m": 4,
            },
        },
        "unit of damping",
    ),
    refused("no kind", {"loop": SPRING["loop"]}, "verify takes an object with a kind"),
    refused("another kind", {**SPRING, "kind": "springs"}, "kind must be"),
    refused("a kind that is a list", {**SPRING, "kind": ["spring"]}, "kind must be"),
    refused(
        "a number that is a truth",
        put(SPRING, {"loop.damping_N_s_per_m": True}),
        "expected a number, got bool",
    ),
    refused("an entry more beside", put(SPRING, {"remark": 1}), "has: remark"),
    refused("an unread entry below", put(SPRING, {"loop.remark": {"by": "hand"}}), "entries"),
    refused("an unread entry in a list", {**SPRING, "remarks": [{"by": "hand"}]}, "no proof of this kind"),
]

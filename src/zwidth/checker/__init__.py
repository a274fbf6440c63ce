"""The independent checker: re-proves a certificate or a violation, recomputes a motion.

Written from the mathematics alone: Chebyshev sums for the criterion, Bernstein coefficients for its sign,
Schur and Cohn's recursion for roots, a plain recursion for the energy of a motion, every move one by one for
a storage function.  The standard library does for all but the last, whose many moves need numpy, and
have a slow twin without them.  It imports nothing else of zwidth, and zwidth imports of it what stands
here: keep it so.

Everything is exact, or enclosed where e^A, sines and roots come in: numbers are integers, or text such as
"3/20" and "0.15".
"""

from __future__ import annotations

from .document.fields import Row
from .document.file import Unreadable, read_file
from .one import STOPPED, Verified, verify
from .scope import Scope
from .verdict import Judged, Part, answer, headline, judge, judge_file, not_checked, rows
from .whole import EVIDENCE

__all__ = [
    "EVIDENCE",
    "STOPPED",
    "Judged",
    "Part",
    "Row",
    "Scope",
    "Unreadable",
    "Verified",
    "answer",
    "headline",
    "judge",
    "judge_file",
    "not_checked",
    "read_file",
    "rows",
    "verify",
]  # fmt: skip

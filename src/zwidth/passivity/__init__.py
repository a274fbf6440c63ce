"""The proof: criteria, certificates, violations, witnesses, the independent checker."""

from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness.violation import Violation
from zwidth.passivity.witness.witness import Witness

__all__ = ["Certificate", "Verdict", "Violation", "Witness", "check"]

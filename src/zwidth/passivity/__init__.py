"""The proof: criteria, certificates, witnesses, the independent checker."""

from zwidth.passivity import closed_forms, quantization
from zwidth.passivity.certificate import Certificate
from zwidth.passivity.check import check
from zwidth.passivity.verdict import Verdict
from zwidth.passivity.witness import Witness

__all__ = ["Certificate", "Verdict", "Witness", "check", "closed_forms", "quantization"]

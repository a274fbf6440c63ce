"""Which pairs of arms are passive with every two hands."""

from zwidth.passivity.pairs.criterion import PairCriterion, largest_spring
from zwidth.passivity.pairs.evidence import PairCertificate, PairViolation, PairWitness
from zwidth.passivity.pairs.verdict import PairVerdict, check_pair

__all__ = [
    "PairCertificate",
    "PairCriterion",
    "PairVerdict",
    "PairViolation",
    "PairWitness",
    "check_pair",
    "largest_spring",
]

"""How far one parameter may go: a value proved passive, and one refuted by a motion."""

from zwidth.passivity.bracket.bracket import Bracket
from zwidth.passivity.bracket.passive_limit import passive_limit

__all__ = ["Bracket", "passive_limit"]

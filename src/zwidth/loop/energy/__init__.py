"""The joules: what crosses the port, what is stored, what is lost."""

from zwidth.loop.energy.ledger import Ledger, ledger
from zwidth.loop.energy.pair_ledger import PairLedger

__all__ = ["Ledger", "PairLedger", "ledger"]

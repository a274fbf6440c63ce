"""The joules: what crosses the port, what is stored, what is lost."""

from zwidth.energy.ledger import Ledger, ledger

__all__ = ["Ledger", "ledger"]

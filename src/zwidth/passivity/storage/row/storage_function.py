"""The storage function of laws in a chain as a certificate."""

from __future__ import annotations

from dataclasses import dataclass

from zwidth.passivity.certificate import Certificate
from zwidth.passivity.storage.evidence.storage_function import StorageFunction
from zwidth.passivity.storage.row.document import STORAGE, law_document, table_document
from zwidth.passivity.storage.row.law import RowLaw


@dataclass(frozen=True)
class RowStorage(StorageFunction):
    """The available storage of laws in a chain, from above.

    Parameters
    ----------
    law
        The laws as the simulator runs them.
    """

    law: RowLaw

    def certificate(self) -> Certificate:
        """The proof as data: the table of the law, the losses, the grid, V."""
        table = table_document(self.iteration.grid.table)
        return Certificate((self._document(STORAGE, law_document(self.law), table=table),))

"""Why a document is refused."""

from __future__ import annotations


class Invalid(Exception):
    """The document does not prove what it claims; the message says where."""

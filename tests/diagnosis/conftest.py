"""Whatever is diagnosed in this room: what is printed for a cause speaks for it."""

import pytest

from zwidth.data.diagnosis import reason
from zwidth.data.diagnosis.evidence import TERMS


@pytest.fixture(autouse=True)
def _evidence_speaks(monkeypatch):
    named = reason._named

    def checked(taken, seen, device):
        found = named(taken, seen, device)
        if found.cause is not None:
            assert found.evidence
            assert not any(" 0 %" in line for line in found.evidence)
        if (
            found.cause in TERMS
            and seen.law is not None
            and (found.cause in TERMS[:4] or seen.drive is not None)
        ):
            assert seen.supplied[found.cause] > 0 or not (seen.sees_delay or found.cause != "delay")
        return found

    monkeypatch.setattr(reason, "_named", checked)

"""What is computed beside the pages ends: when it is done, when it takes too long, when nobody waits."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import count
from queue import Queue
from threading import Thread, local
from typing import Any

import pytest
from explorer.jobs import doubled, ended, endless, failed, refused

from zwidth.show.explorer.working import Answer, Workers

LOOK = 0.02
"""For an answer, at most [s]."""


def test_a_process_that_does_not_start_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(_: object) -> None:
        raise EOFError

    monkeypatch.setattr("zwidth.show.explorer.working._Process", fails)
    answers: Queue[Answer] = Queue()
    started = Workers(1)
    for number in (1, 2):
        started.submit(number, "double", doubled, (3,), answers.put)
    assert all("__main__" in answers.get(timeout=60).message for _ in range(2))
    started.close()


@pytest.fixture(autouse=True)
def _looks(monkeypatch: pytest.MonkeyPatch) -> None:
    """A second is a look for the answer, and the next one: a machine that stands still takes no longer."""

    class Looks(local):
        def __init__(self) -> None:
            self.so_far = count()

    looks = Looks()
    monkeypatch.setattr("zwidth.show.explorer.working.monotonic", lambda: float(next(looks.so_far)))
    monkeypatch.setattr("zwidth.show.explorer.working._STEP", LOOK)


@pytest.fixture
def workers() -> Iterator[Workers]:
    made = Workers(1, longest=100.0)
    yield made
    made.close()


def asked(workers: Workers, compute: Any, value: object) -> Answer:
    answers: Queue[Answer] = Queue()
    workers.submit(1, "job", compute, (value,), answers.put)
    return answers.get(timeout=600)


def test_nobody_waits_for_a_process_that_is_still_starting(monkeypatch: pytest.MonkeyPatch) -> None:
    """All of it ends, also while a process imports what it needs: this one is never done with that."""
    monkeypatch.setattr("zwidth.show.explorer.working._serve", endless)
    workers = Workers(count=1)
    workers.submit(1, "any", doubled, (1,), lambda _: None)
    ending = Thread(target=workers.close, daemon=True)
    ending.start()
    ending.join(timeout=300)
    assert not ending.is_alive()


def test_an_answer_a_message_and_a_mistake(workers: Workers) -> None:
    assert asked(workers, doubled, 21) == Answer(42)
    assert asked(workers, refused, 3) == Answer(None, "3 cannot be")
    assert "ZeroDivisionError" in asked(workers, failed, 1).message
    assert asked(workers, doubled, 4) == Answer(8)


def test_what_dies_or_takes_too_long_is_said_and_replaced(workers: Workers) -> None:
    assert "without an answer" in asked(workers, ended, 1).message
    assert "took more than" in asked(workers, endless, 1).message
    assert asked(workers, doubled, 4) == Answer(8)


def test_the_newest_job_alone_is_done() -> None:
    """Of one asker and one kind; of others each; nothing is told to who has left."""
    workers = Workers(1)
    answers: Queue[Answer] = Queue()
    try:
        workers.submit(1, "job", endless, (0,), answers.put)
        for value in range(5):
            workers.submit(1, "job", doubled, (value,), answers.put)
        workers.submit(2, "job", doubled, (50,), answers.put)
        found = {answers.get(timeout=600).value for _ in range(2)}
        assert found == {8, 100}
        workers.submit(3, "job", doubled, (1,), answers.put)
        workers.forget(3)
        workers.submit(4, "job", doubled, (7,), answers.put)
        assert answers.get(timeout=600).value == 14
        assert answers.empty()
    finally:
        workers.close()

"""Keeps the machine, its settings and its speed out of the tests; makes `from strategies import …` work."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings
from real_time import undisturbed

from zwidth.native.build import library

# no window, and no settings of one's own for pictures: before anything imports matplotlib
os.environ["MPLBACKEND"] = "agg"
os.environ["MATPLOTLIBRC"] = str(Path(__file__).parent / "matplotlibrc")
# matrices here are small: threads for them cost more than they save, most where several processes run
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

settings.register_profile(
    "explore",  # --hypothesis-profile=explore: other examples in every run
    deadline=None,  # a busy machine is no mistake
    suppress_health_check=[HealthCheck.too_slow],
    print_blob=True,
)
settings.register_profile(  # the same examples in every run: more of them are for those who look for others
    "same", settings.get_profile("explore"), derandomize=True, database=None, max_examples=40
)
settings.load_profile("same")

_TERMINAL = (
    "CLICOLOR_FORCE",
    "FORCE_COLOR",
    "NO_COLOR",
    "PYTHON_COLORS",
    "TTY_COMPATIBLE",
    "TTY_INTERACTIVE",
)


@pytest.fixture(scope="session", autouse=True)
def _plain_terminal() -> Iterator[None]:
    """What is printed is 80 columns wide and has no colours, wherever the tests run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("COLUMNS", "80")
        for name in _TERMINAL:
            patch.delenv(name, raising=False)
        yield


@pytest.fixture(scope="session", autouse=True)
def _messages_in_one_line() -> Iterator[None]:
    """A message is compared as it was written; tests/cli/test_help_width.py looks at how lines break."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zwidth.cli.output.message_lines", lambda text: [text])
        yield


def pytest_configure(config: pytest.Config) -> None:
    """Marks of these tests."""
    config.addinivalue_line("markers", "real_time: made again if the machine stood still, see real_time.py")
    config.addinivalue_line(
        "markers", "soak: takes long, and a quicker test gives an answer of its kind; see .ci/soak"
    )
    library()  # where a source has changed it is built now, before other processes ask for it


def pytest_addoption(parser: pytest.Parser) -> None:
    """Where the time goes."""
    parser.addoption(
        "--processor", metavar="FILE", help="append what each test took of the processor, in seconds"
    )


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Marks what `soak.txt` names; of every test there it leaves something quick that answers alike."""
    named = soaked()
    left = Counter(item.nodeid.partition("[")[0] for item in items)
    for item in items:
        test = item.nodeid.partition("[")[0]
        if named.keys() & {item.nodeid, test}:
            item.add_marker(pytest.mark.soak)
            left[test] -= 1
    missing = [test for test, count in left.items() if not count and not named.get(test)]
    if missing and not any("::" in given for given in config.args):
        raise pytest.UsageError(f"soak.txt leaves nothing of {missing[0]}, and names nothing in its place")


def soaked() -> dict[str, str]:
    """Of each test, or case of a test, that takes long, what stands for it; "" where cases are left."""
    lines = (Path(__file__).parent / "soak.txt").read_text(encoding="utf-8").splitlines()
    parts = (line.split(maxsplit=1)[1].partition(" -> ") for line in lines if line and line[0] != "#")
    return {test: quick for test, _, quick in parts}


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """A line for each test: seconds of the processor, those of processes that it waited for among them."""
    before = _processor()
    try:
        return (yield)
    finally:
        if path := item.config.getoption("--processor"):
            with Path(path).open("a", encoding="utf-8") as file:
                file.write(f"{_processor() - before:.3f} {item.nodeid}\n")


def _processor() -> float:
    own, others = os.times()[:2], os.times()[2:4]
    return sum(own) + sum(others)


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem: pytest.Function) -> bool | None:
    """A test in real time is called until the machine did not stand still; what it printed before is gone."""
    if pyfuncitem.get_closest_marker("real_time") is None:
        return None
    given = {name: pyfuncitem.funcargs[name] for name in pyfuncitem._fixtureinfo.argnames}
    printed = given.get("capsys")
    undisturbed(lambda: pyfuncitem.obj(**given), (lambda: None) if printed is None else printed.readouterr)
    return True


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Each process has a part of its own; who is done helps out."""
    if config.getoption("dist") != "load":
        return None
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)

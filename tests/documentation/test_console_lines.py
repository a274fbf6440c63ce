"""Every line that calls zwidth on a page of the docs, or in the README, is one that zwidth takes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from pages import NAMES, read, shown

from zwidth.cli import main as command_line

NOT_RUN = {
    "compare": "it simulates every law; run in tests/bench",
    "diagnose": "it needs a recording; run in tests/cli/test_diagnose_command.py",
    "doctor": "it measures for seconds",
    "explore": "it serves a page until it is ended; run in tests/explorer",
    "emit": "run in tests/firmware",
    "examples": "beside its files a page takes minutes; run in tests/cli and tests/test_readme_commands.py",
    "identify": "it needs a recording",
    "limit": "it searches for up to a minute; run in tests/cli/test_limit.py",
    "links": "it simulates minutes; run in tests/links",
    "map": "it computes thousands of walls; run in tests/cli/test_map.py",
    "network": "it starts processes",
    "new": "it asks; run in tests/cli/test_new_command.py",
    "play": "it opens a browser; run in tests/cli/test_play_command.py",
    "serve": "it runs until it is ended",
    "tissue": "it needs a recording; run in tests/cli/test_tissue_command.py",
    "sweep": "it asks hundreds of loops; run in tests/cli/test_sweep_command.py",
    "tour": "it simulates a touch; run in tests/cli/test_tour_command.py",
    "workspace": "it covers an arm; run in tests/cli/test_workspace_command.py",
}
"""Commands whose lines are read and not run, and why; so are those of files that no page shows."""

WRITES = {"-o", "--save", "--plot", "--sound", "--certify"}

COMPUTED = re.compile(r"^```\{computed\}\n((?::.*\n)*)((?:\$ .*\n)+)```$", re.M)


def typed(page: str) -> list[list[str]]:
    return [call for _, call in shown.commands_of(COMPUTED.sub("", read(page)))]


def put_files(page: str, folder: Path) -> Path:
    """The files of a page, as somebody would who follows it."""
    for name, text in shown.files_of(read(page)).items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def has_what_it_reads(call: list[str], folder: Path) -> bool:
    before = dict(zip(call[1:], call, strict=False))
    files = [word for word in call if re.search(r"\.(toml|ya?ml|json|csv|nc|urdf|mcap|bin)$", word)]
    return all((folder / file).exists() for file in files if before.get(file) not in WRITES)


@pytest.mark.parametrize("page", [name for name in NAMES if typed(name)])
def test_the_lines_of_a_page(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = put_files(page, tmp_path)
    for call in typed(page):
        with monkeypatch.context() as patch:
            if call and (call[0] in NOT_RUN or not has_what_it_reads(call, folder)):
                patch.setattr(command_line, "run", lambda *_: 0)
            again = ["--force"] if WRITES & set(call) else []  # a page may write one file twice
            status, _, said = shown.run([*call, *again], folder)
        assert status != shown.BAD_INPUT, f"zwidth {' '.join(call)}: {said}"


@pytest.mark.parametrize("page", [name for name in NAMES if "{computed}" in read(name)])
def test_each_computed_block_has_what_the_text_relies_on(page: str) -> None:
    """The docs' build runs its commands, and ends where one is a mistake or says something else by now."""
    blocks = COMPUTED.findall(read(page))
    assert len(blocks) == read(page).count("```{computed}")
    for options, commands in blocks:
        assert len(re.findall(r"^:says: (.+)$", options, re.M)) == 1, commands
        assert len(list(shown.commands_of(f"```console\n{commands}```"))) == commands.count("$ ")


def test_calls_and_files_are_found() -> None:
    line = "$ zwidth check a.toml && zwidth verify b.json  # so"
    page = f"```toml\n# a.toml\n[device]\n```\n```console\n{line}\nok\n$ ls\n```\n"
    assert [call for _, call in shown.commands_of(page)] == [["check", "a.toml"], ["verify", "b.json"]]
    assert shown.files_of(page) == {"a.toml": "# a.toml\n[device]\n"}
    assert shown.not_said("ACTIVE; 500 Hz; 300 N", " ACTIVE  at\n500   Hz") == ["300 N"]

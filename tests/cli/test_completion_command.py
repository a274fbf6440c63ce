"""`zwidth completion`: what a real shell is answered at the Tab key."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from zwidth.cli.main import main

BASH = shutil.which("bash")
PLACES = {
    "zwidth ch": ["check"],
    "zwidth check haptic": ["haptic-paddle"],
    "zwidth check wh": ["wheel.toml"],
    "zwidth check wheel.toml --stiff": ["--stiffness"],
    "zwidth check --type max": ["maxwell"],
    "zwidth simulate knob.toml --operator dow": ["dowel"],
    "zwidth workspace ": ["arm.urdf", "falcon", "hapkit", "haply-2diy", "two-link"],
    "zwidth identify ses": ["session.csv"],
}
"""Lines as typed so far, and what may follow."""


@pytest.mark.skipif(BASH is None, reason="there is no bash")
def test_bash_completes_commands_options_devices_types_and_files(tmp_path: Path) -> None:
    """The function that the script defines is called as bash calls it; a space in a word is quoted."""
    assert main(["examples", str(tmp_path)]) == 0
    shell = [
        'zwidth() { "$PYTHON" -m zwidth "$@"; }',
        'eval "$(zwidth completion bash)"',
        "complete -p zwidth >&2",
        'try() { COMP_LINE="$1" COMP_POINT=${#1} COMP_TYPE=9 COMPREPLY=()',
        '  _python_argcomplete zwidth; echo "${COMPREPLY[*]}"; }',
        *(f"try '{line}'" for line in PLACES),
    ]
    done = subprocess.run(
        [str(BASH), "--noprofile", "--norc", "-c", "\n".join(shell)],
        cwd=tmp_path,
        env={**os.environ, "PYTHON": sys.executable},
        capture_output=True,
        text=True,
        check=True,
    )
    answers = [sorted(line.split()) for line in done.stdout.splitlines()]
    assert dict(zip(PLACES, answers, strict=True)) == PLACES
    assert "_python_argcomplete" in done.stderr


@pytest.mark.parametrize("shell", ["zsh", "fish"])
def test_other_shells_can_read_their_script(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    """Without syntax errors, where the shell is there; it says how zwidth is asked everywhere."""
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert "_ARGCOMPLETE" in script
    assert "zwidth" in script
    if program := shutil.which(shell):
        subprocess.run([program, "-n"], input=script, text=True, check=True)


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_says_first_where_to_put_it(shell: str, capsys: pytest.CaptureFixture[str]) -> None:
    """In comments; only zsh has a line before them, which it asks for."""
    assert main(["completion", shell]) == 0
    lines = capsys.readouterr().out.splitlines()
    if shell == "zsh":
        assert lines.pop(0) == "#compdef zwidth"
    assert lines[0].startswith(f"# Completion of zwidth for {shell}. Put this line into ~/.")
    assert f"zwidth completion {shell}" in lines[1]
    assert not [line for line in lines if "compdef zwidth" in line and line.startswith("#")]


def test_another_shell_is_refused_with_those_there_are(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "powers"]) == 2
    assert "bash, zsh, fish" in capsys.readouterr().err


def test_without_a_shell_the_line_for_that_of_the_user_is_said(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As the environment names it; bash where it names one of which there is none."""
    for path, shell in (("/usr/bin/fish", "fish"), ("/bin/tcsh", "bash")):
        monkeypatch.setenv("SHELL", path)
        assert main(["completion"]) == 2
        assert f"zwidth completion {shell}" in " ".join(capsys.readouterr().err.split())


def test_the_library_is_imported_at_the_tab_key_only() -> None:
    """A command that is run does not wait for it."""
    code = (
        "import sys; from zwidth.cli.main import main; main(['devices']); "
        "assert 'argcomplete' not in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)

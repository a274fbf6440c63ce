"""`zwidth completion`: what a real shell is answered at the Tab key."""

import os
import shutil
import subprocess
import sys

import pytest

BASH = shutil.which("bash")
PLACES = {
    "zwidth ch": ["check"],
    "zwidth check haptic": ["haptic-paddle"],
    "zwidth check wh": ["wheel.toml"],
    "zwidth check wheel.toml --stiff": ["--stiffness"],
    "zwidth check --type max": ["maxwell"],
    "zwidth simulate knob.toml --operator dow": ["dowel"],
    "zwidth workspace ": ["arm.urdf", "falcon", "firmware/", "hapkit", "haply-2diy", "two-link"],
    "zwidth identify ses": ["session.csv"],
}
"""Lines as typed so far, and what may follow."""


@pytest.mark.skipif(BASH is None, reason="there is no bash")
def test_bash_completes_commands_options_devices_types_and_files(run, tmp_path):
    """The function that the script defines is called as bash calls it; a space in a word is quoted."""
    run(f"examples {tmp_path}")
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


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_a_script_says_first_where_to_put_it(run, shell):
    """In comments; only zsh has a line before them, which it asks for; a shell that is there can read it."""
    script = run(f"completion {shell}").out
    assert "_ARGCOMPLETE" in script
    if program := shutil.which(shell):
        subprocess.run([program, "-n"], input=script, text=True, check=True)
    lines = script.splitlines()
    if shell == "zsh":
        assert lines.pop(0) == "#compdef zwidth"
    assert lines[0].startswith(f"# Completion of zwidth for {shell}. Put this line into ~/.")
    assert f"zwidth completion {shell}" in lines[1]
    assert not [line for line in lines if "compdef zwidth" in line and line.startswith("#")]


def test_another_shell_is_refused_with_those_there_are(refused):
    assert "bash, zsh, fish" in refused("completion powers")


def test_without_a_shell_the_line_for_that_of_the_user_is_said(refused, monkeypatch):
    for path, shell in (("/usr/bin/fish", "fish"), ("/bin/tcsh", "bash")):
        monkeypatch.setenv("SHELL", path)
        assert f"zwidth completion {shell}" in refused("completion")


def test_the_library_is_imported_at_the_tab_key_only():
    """A command that is run does not wait for it."""
    run = "import sys; from zwidth.cli.main import main; main(['devices'])"
    code = f"{run}; assert 'argcomplete' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)

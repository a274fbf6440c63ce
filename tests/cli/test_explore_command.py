"""`zwidth explore` as it is typed: the address is said, Ctrl-C ends it, and what it lacks is one message."""

import os
import re
import signal
import subprocess
import sys
from urllib.request import urlopen

import pytest

COMMAND = [sys.executable, *["-m", "zwidth", "explore", "--no-browser", "--port", "0", "haptic-paddle"]]


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_it_says_where_it_is_and_ends_at_ctrl_c():
    """The page answers at the address that is said; the status is 130, as of what else is served."""
    environment = {**os.environ, "PYTHONUNBUFFERED": "1"}
    with subprocess.Popen(COMMAND, stderr=subprocess.PIPE, text=True, env=environment) as running:
        try:
            line = running.stderr.readline()
            found = re.fullmatch(r"exploring at (http://127\.0\.0\.1:\d+/) ; Ctrl-C ends it\n", line)
            assert found, line
            with urlopen(found[1], timeout=60) as answer:
                assert answer.status == 200
                assert b"zwidth" in answer.read()
            running.send_signal(signal.SIGINT)
            rest = running.communicate(timeout=300)[1]
        finally:
            running.kill()
    assert running.returncode == 130
    assert "Traceback" not in rest


@pytest.mark.skipif(sys.platform == "win32", reason="signals are those of POSIX")
def test_ctrl_c_is_heard_by_whichever_thread_takes_it(run):
    """The system may hand a signal to any thread of the process; the main one waits, and hears of it."""
    program = (
        "import signal, threading, time\n"
        "from zwidth.cli.start.explore import until_ctrl_c\n"
        "def pressed():\n"
        "    time.sleep(0.5)\n"
        "    signal.pthread_kill(threading.get_ident(), signal.SIGINT)\n"
        "    time.sleep(600)\n"
        "threading.Thread(target=pressed, daemon=True).start()\n"
        "try:\n"
        "    until_ctrl_c()\n"
        "except KeyboardInterrupt:\n"
        "    print('heard')\n"
    )
    ran = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, timeout=300)
    assert ran.stdout == "heard\n"


def test_without_its_libraries_it_says_what_to_install(run, monkeypatch):
    """On a line of its own, which may be wider than the terminal: it is copied."""
    command = f"{'folder/' * 40}pip install '.[explore]'"
    monkeypatch.setattr("zwidth.show.explorer.notebook.find_spec", lambda _: None)
    monkeypatch.setattr("zwidth.installing.line", lambda *_: command)
    assert run("explore --no-browser", 2).err.endswith(f"; type:\n  {command}\n")

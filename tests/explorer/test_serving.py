"""Who is answered: this machine's own pages, and over the network who has the token."""

from __future__ import annotations

import http.client
import re
import socket
import urllib.error
import urllib.request
from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest
from bokeh.client import pull_session
from bokeh.models import ImportedStyleSheet
from bokeh.util.token import generate_session_id

from zwidth.errors import InputError
from zwidth.show.explorer.serving import SHORTEST, serve_explorer, token_for

TOKEN = "a-token-of-a-test-0123456789"

_UPGRADE = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13"}


def status(address: str, path: str = "/", **headers: str) -> tuple[int, str]:
    host = urlsplit(address).netloc
    connection = http.client.HTTPConnection(host, timeout=60)
    connection.request("GET", path, headers=headers)
    answer = connection.getresponse()
    answer.read()
    connection.close()
    return answer.status, answer.headers.get("Set-Cookie", "")


def upgrade(address: str, origin: str, session: str, **more: str) -> int:
    """What a page of this origin is answered that asks for a WebSocket; 0 if it is hung up on."""
    host, _, port = urlsplit(address).netloc.partition(":")
    key = {"Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Protocol": f"bokeh, {session}"}
    asked = {"Host": f"{host}:{port}", **_UPGRADE, **key, "Origin": origin, **more}
    head = "".join(f"{name}: {value}\r\n" for name, value in asked.items())
    with socket.create_connection((host, int(port)), timeout=60) as stream:
        stream.sendall(f"GET /ws HTTP/1.1\r\n{head}\r\n".encode())
        answer = stream.makefile("rb")
        status = int(answer.readline().split()[1])
        while answer.readline().strip():
            pass
        return status if status != 101 or answer.read(1) else 0


def session_of(address: str, **headers: str) -> str:
    request = urllib.request.Request(address, headers=headers)
    with urllib.request.urlopen(request, timeout=60) as answer:
        return re.findall(r'"token": ?"([\w.=-]+)"', answer.read().decode())[0]


def test_nothing_is_asked_from_abroad_where_a_page_connects_late() -> None:
    """Its document was forgotten: of the one that is made anew every style is of this server."""
    with (
        serve_explorer() as page,
        pull_session(url=page.address, session_id=generate_session_id()) as session,
    ):
        styles = {style.url for style in session.document.select({"type": ImportedStyleSheet})}
    assert styles
    assert not [url for url in styles if "://" in url]


@pytest.fixture(scope="module")
def served() -> Iterator[tuple[str, int, str]]:
    with serve_explorer() as page:
        yield page.address, urlsplit(page.address).port or 0, session_of(page.address)


def test_only_pages_of_this_server_get_a_websocket(served: tuple[str, int, str]) -> None:
    """A page of another site is refused, also where it comes from another port of this machine."""
    address, port, session = served
    assert address == f"http://127.0.0.1:{port}/"
    for foreign in ("http://evil.example", "http://127.0.0.1:1", f"http://evil.example:{port}", "null"):
        assert upgrade(address, foreign, session) == 403
    assert upgrade(address, f"http://127.0.0.1:{port}", session) == 101


def test_a_foreign_name_meets_no_handler(served: tuple[str, int, str]) -> None:
    """Also where Origin says the same name, which is the same origin for a browser; a port belongs to it."""
    address, port, session = served
    names = ("evil.example:{}", "127.0.0.1", "localhost:1", "127.0.0.2:{}", "0.0.0.0:{}", "")
    for host in (name.format(port) for name in names):
        assert upgrade(address, f"http://{host}", session, Host=host) == 421
        assert {status(address, path, Host=host)[0] for path in ("/", "/static/", "/enter")} == {421}
    for host in (f"localhost:{port}", f"[::1]:{port}", f"LocalHost:{port}"):
        assert status(address, "/static/js/bokeh.min.js", Host=host)[0] == 200
        assert upgrade(address, f"http://{host.lower()}", session, Host=host) == 101


def test_over_the_network_an_address_in_numbers_is_a_name_too() -> None:
    """Of every address none can be listed; a name that is not this machine's own stays foreign."""
    with serve_explorer(address="0.0.0.0") as page:
        port = urlsplit(page.address).port
        for host, code in (("192.0.2.7", 401), ("[2001:db8::7]", 401), ("evil.example", 421)):
            assert status(page.address, "/enter", Host=f"{host}:{port}")[0] == code


def test_a_token_opens_the_page_and_nothing_else_does() -> None:
    """With it a cookie that no script reads; without it, or with another, the form; so of the WebSocket."""
    with serve_explorer(token=TOKEN) as page:
        assert TOKEN in page.address
        origin = page.address.partition("/?")[0]
        assert status(page.address)[0] == 302
        assert status(page.address, "/?token=another-token-0123456789")[0] == 302
        assert status(page.address, "/enter")[0] == 401
        code, cookie = status(page.address, f"/?token={TOKEN}")
        assert code == 200
        assert "HttpOnly" in cookie
        assert "SameSite=Strict" in cookie
        kept = cookie.partition(";")[0]
        session = session_of(origin, Cookie=kept)
        assert upgrade(page.address, origin, session) in (0, 302, 401, 403)
        assert upgrade(page.address, origin, session, Cookie=kept) == 101


def test_a_form_takes_the_token() -> None:
    with serve_explorer(token=TOKEN) as page:
        enter = page.address.partition("?")[0] + "enter"
        with pytest.raises(urllib.error.HTTPError, match="401"):
            urllib.request.urlopen(enter, data=b"token=wrong")
        request = urllib.request.Request(enter, data=f"token={TOKEN}".encode())
        opener = urllib.request.build_opener(urllib.request.HTTPCookieProcessor())
        assert opener.open(request).status == 200


def test_over_the_network_there_is_always_a_token() -> None:
    assert token_for("127.0.0.1", None) is None
    assert token_for("::1", None) is None
    made = token_for("0.0.0.0", None)
    assert len(made) >= SHORTEST
    assert made != token_for("0.0.0.0", None)


@pytest.mark.parametrize("token", ["short", "with a blank in it, long", "späte-umlaute-0123456789", ""])
def test_a_token_that_can_be_guessed_is_refused(token: str) -> None:
    with pytest.raises(InputError, match="16 characters"):
        token_for("127.0.0.1", token)


def test_a_port_in_use_is_said() -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(InputError, match="cannot be served"):
            serve_explorer(port=taken.getsockname()[1])
    with pytest.raises(InputError, match="no port"):
        serve_explorer(port=70000)


def test_so_many_pages_and_no_more() -> None:
    with serve_explorer(most=1) as page:
        first = urllib.request.urlopen(page.address).read().decode()
        second = urllib.request.urlopen(page.address).read().decode()
    assert "Device and wall" in first
    assert "pages are open" in second
    assert "Device and wall" not in second


def test_text_in_the_address_is_shown_and_not_obeyed() -> None:
    with serve_explorer() as page:
        for query in ("device.name=%3Cscript%3Ealert(1)%3C/script%3E", "%3Cscript%3Ealert(1)%3C/script%3E=1"):
            text = urllib.request.urlopen(f"{page.address}?{query}").read().decode()
            assert "<script>alert(1)" not in text

"""Who may look: on this machine everybody, over the network who has the token.

The token comes once in the address or by a form; from then on a cookie that no script reads and no other site
sends stands for it.  It is compared in constant time.
"""

from __future__ import annotations

import secrets
import socket
from collections.abc import Callable
from contextlib import suppress
from hmac import compare_digest
from ipaddress import ip_address
from typing import Any

from bokeh.server.auth_provider import AuthProvider
from tornado.web import RequestHandler

from zwidth.errors import InputError
from zwidth.machine.servo.live.page import OWN

SHORTEST = 16
"""Characters of a token."""

ANY = ("0.0.0.0", "::")
"""Addresses that stand for every one of this machine."""

TOKEN = "token"
_LOGIN = "/enter"


def is_loopback(address: str) -> bool:
    """True where only this machine is answered."""
    if address == "localhost":
        return True
    try:
        return ip_address(address).is_loopback
    except ValueError:
        return False


def token_for(address: str, given: str | None) -> str | None:
    """The token that is asked for, made where none was given; None where only this machine is answered."""
    if given is None:
        return None if is_loopback(address) else secrets.token_urlsafe(24)
    if len(given) < SHORTEST or not all(c.isascii() and (c.isalnum() or c in "-_") for c in given):
        raise InputError(
            f"the token has {SHORTEST} characters or more, of letters, digits, - and _: anybody who "
            "guesses it may look; leave it out, and one is made"
        )
    return given


def hosts(address: str) -> list[str]:
    """The names under which this server is asked, in small letters."""
    names = {address, *OWN}
    if not is_loopback(address):
        names |= {socket.gethostname(), socket.getfqdn()}
    if address in ANY:
        with suppress(OSError):
            names.update(socket.gethostbyname_ex(socket.gethostname())[2])
    return sorted({name.lower() for name in names} - set(ANY))


class TokenAccess(AuthProvider):  # type: ignore[misc]  # Bokeh's has no types
    """Asks for a token.

    Parameters
    ----------
    token
        Which.
    cookie
        The name of what stands for it.
    """

    def __init__(self, token: str, cookie: str) -> None:
        self._token, self._cookie = token, cookie
        super().__init__()

    @property
    def get_user(self) -> Callable[[RequestHandler], str | None]:
        """Who asks: somebody with the token, or nobody."""

        def user(handler: RequestHandler) -> str | None:
            given = handler.get_query_argument(TOKEN, None)
            if given is not None and self._is_token(given):
                self._remember(handler)
                return "somebody"
            kept = handler.get_cookie(self._cookie)
            return "somebody" if kept is not None and self._is_token(kept) else None

        return user

    get_user_async = None
    logout_url = None
    get_login_url = None
    logout_handler = None

    @property
    def login_url(self) -> str:
        """Where the form is."""
        return _LOGIN

    @property
    def login_handler(self) -> type[RequestHandler]:
        """The form, and what reads it."""
        access = self

        class Enter(RequestHandler):
            """Asks for the token."""

            def get(self) -> None:
                self.set_status(401)
                self.finish(_FORM.format(message=""))

            def post(self) -> None:
                if not access._is_token(self.get_body_argument(TOKEN, "")):
                    self.set_status(401)
                    self.finish(_FORM.format(message='<p role="alert">That is not the token.</p>'))
                    return
                access._remember(self)
                self.redirect("/")

        return Enter

    def _is_token(self, given: Any) -> bool:
        return compare_digest(str(given).encode(), self._token.encode())

    def _remember(self, handler: RequestHandler) -> None:
        handler.set_cookie(self._cookie, self._token, httponly=True, samesite="Strict")


_FORM = """<!DOCTYPE html><html lang="en"><head><meta charset="utf-8"><title>zwidth: token</title>
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
</head><body><main><h1>zwidth</h1>{message}<form method="post"><p><label>Token, as the terminal shows it:
<input name="token" type="password" autocomplete="off" required></label> <button>Enter</button></p></form>
</main></body></html>"""

# SPDX-License-Identifier: GPL-3.0-or-later
"""Who may ask the page's server: the browser that opened the printed address, and only that page in it; and answers."""
from __future__ import annotations

import hmac
import json
import secrets
from typing import Any

from aiohttp import web

from ..command_line import finite
from ..errors import Error, ServerError
from ..text import harmless

HEADERS = {
    "Content-Security-Policy": "default-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'; "
                               "object-src 'none'",
    "X-Content-Type-Options": "nosniff", "Referrer-Policy": "no-referrer", "Cache-Control": "no-store",
    "Cross-Origin-Opener-Policy": "same-origin", "Cross-Origin-Resource-Policy": "same-origin"}
_STATUS = {"NOT_FOUND": 404, "PERMISSION_DENIED": 403, "UNAUTHENTICATED": 403, "UNAVAILABLE": 503}


class Gate:
    """The token opens the page once and becomes a cookie that scripts cannot read. `host`, the address that was
    printed, is the only Host and Origin: a name that is made to mean 127.0.0.1 is refused, and so are pages of other
    ports, which browsers count to the same site."""

    def __init__(self, host: str) -> None:
        self.host, self._used = host, False
        self.token, self._secret = secrets.token_urlsafe(24), secrets.token_urlsafe(24)

    @property
    def _cookie(self) -> str:
        return f"anticrack-{self.host.rpartition(':')[2]}"  # browsers share cookies between ports

    def _refusal(self, request: web.Request) -> str:
        if request.headers.get("Host") != self.host:
            return f"this page is at {self.host} only"
        if (request.headers.get("Origin", f"http://{self.host}") != f"http://{self.host}"
                or request.headers.get("Sec-Fetch-Site", "none") not in ("none", "same-origin")):
            return "another page may not ask this"
        if request.method != "GET" and "Origin" not in request.headers:
            return "only the page itself may change something"
        return ""

    def _enters(self, request: web.Request) -> bool:
        given = request.query.get("token", "")
        return (request.path == "/" and request.method == "GET" and not self._used
                and hmac.compare_digest(given.encode("utf-8", "replace"), self.token.encode()))

    def _knows(self, request: web.Request) -> bool:
        given = request.cookies.get(self._cookie, "")
        return hmac.compare_digest(given.encode("utf-8", "replace"), self._secret.encode())

    @web.middleware
    async def check(self, request: web.Request, handler: Any) -> web.StreamResponse:
        if refusal := self._refusal(request):
            return web.Response(status=403, text=refusal)
        if self._enters(request):
            self._used = True
            entered = web.HTTPSeeOther("/")
            entered.set_cookie(self._cookie, self._secret, httponly=True, samesite="Strict", path="/")
            raise entered
        if not self._knows(request):
            return web.Response(status=403, text="The address with its token opens the page once, in one browser. "
                                                 "Start anticrack view again for a new one.")
        try:
            return await handler(request)  # type: ignore[no-any-return]
        except ServerError as error:
            return refused(error, _STATUS.get(error.code, 409))
        except (Error, OSError, ValueError, KeyError, IndexError) as error:
            return refused(error, 400)


def text_of(value: Any) -> str:
    return json.dumps(finite(value), allow_nan=False, separators=(",", ":"))


def reply(value: Any, status: int = 200) -> web.Response:
    return web.Response(text=text_of(value), content_type="application/json", status=status)


def refused(error: Exception, status: int) -> web.Response:
    return reply({"error": harmless(error, "\n")}, status)


async def add_headers(_: web.Request, response: web.StreamResponse) -> None:
    response.headers.update(HEADERS)

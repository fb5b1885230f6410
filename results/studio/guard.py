"""Access to the page's server: the right host name, the right origin, and the token of the address.

Every request needs the token: other users of this machine reach 127.0.0.1 as well. Its first use hands
the browser a cookie, so that the token leaves the address bar. On this machine only, the names of this
machine are the only ones accepted: another site cannot reach the server by pointing its own name here
(DNS rebinding), and a page of another site cannot open the connection (its origin differs).
"""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field
from ipaddress import ip_address
from urllib.parse import urlsplit

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

from flexspline.results.job import tell

COOKIE = "flexspline-studio"
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data: blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""Of every answer, errors too."""
USE_PRINTED = "use the address that flexspline studio printed where it was started"
# A redirect would not do: followed from another page, it is sent without a SameSite=Strict cookie.
_ENTER = (
    '<!doctype html><html lang="en"><meta charset="utf-8"><title>flexspline studio</title>'
    '<meta http-equiv="refresh" content="0; url=/"><p><a href="/">Open the page</a></p></html>'
)


def is_loopback(host: str) -> bool:
    """Whether an address to listen on is reached from this machine only."""
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host.lower() == "localhost"


def _secret() -> str:
    return secrets.token_urlsafe(32)


@dataclass
class Guard:
    """The rules for one server.

    `token` is for who can read the terminal. `ticket` is for the browser that the program opens: every
    user of the machine can read its command line, so it lets in once only.
    """

    host: str
    token: str = field(default_factory=_secret, repr=False)
    ticket: str = field(default_factory=_secret, repr=False)
    _ticket_uses: int = 0

    def address(self, port: int) -> str:
        """What to open in a browser, the token in it."""
        return f"{self._root(port)}?token={self.token}"

    def opened_address(self, port: int) -> str:
        """What the program opens itself, the ticket in it."""
        return f"{self._root(port)}?ticket={self.ticket}"

    def _root(self, port: int) -> str:
        bare = self.host.strip("[]")
        return f"http://{f'[{bare}]' if ':' in bare else bare}:{port}/"

    @property
    def middleware(self) -> Middleware:
        @web.middleware
        async def check(request: web.Request, handler: Handler) -> web.StreamResponse:
            try:
                name, port = host_and_port(request.host)
            except ValueError:
                return _refused(400, "the Host header is not an address")
            if is_loopback(self.host) and not is_loopback(name):
                return _refused(403, "this server accepts only the names of its own machine")
            origin = request.headers.get("Origin")
            if origin is not None and _netloc(origin) != request.host.lower():
                return _refused(403, "requests from other sites are refused")
            cookie = f"{COOKIE}-{port}"  # one jar for all ports of a host
            known = _same(request.cookies.get(cookie, ""), self.token)
            given = _same(request.query.get("token", ""), self.token)
            if not (known or given or self._takes(request)):
                return _refused(403, f"no token: {USE_PRINTED}")
            if request.path == "/" and request.query_string:
                return self._entered(cookie)  # the token leaves the address bar at once
            return await handler(request)

        return check

    def _takes(self, request: web.Request) -> bool:
        """Whether it brings the ticket, for the first time."""
        if request.path != "/" or not _same(request.query.get("ticket", ""), self.ticket):
            return False
        self._ticket_uses += 1
        if self._ticket_uses == 2:
            tell(
                "the address opened in the browser was used a second time and refused; if the page did not "
                "open, another user may have opened it: stop and start again with --no-browser"
            )
        return self._ticket_uses == 1

    def _entered(self, cookie: str) -> web.Response:
        page = web.Response(text=_ENTER, content_type="text/html")
        page.set_cookie(cookie, self.token, httponly=True, samesite="Strict", path="/")
        return page


async def add_headers(_: web.BaseRequest, answer: web.StreamResponse) -> None:
    """To every answer, whoever made it."""
    answer.headers.update(HEADERS)


def host_and_port(text: str) -> tuple[str, int]:
    """Of a Host header; port 80 if it names none.

    Raises
    ------
    ValueError : neither a name nor an address, or no port.
    """
    parts = urlsplit(f"//{text}")
    if parts.netloc != text or not parts.hostname or "@" in text:
        raise ValueError(text)
    port = parts.port
    return parts.hostname, 80 if port is None else port


def _refused(status: int, reason: str) -> web.Response:
    return web.Response(status=status, text=f"flexspline studio: {reason}\n")


def _netloc(origin: str) -> str | None:
    """Host and port in lower case; None of what is no address."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return None


def _same(given: str, secret: str) -> bool:
    """Compared as bytes, whatever the encoding, in a time that tells nothing."""
    return hmac.compare_digest(given.encode("utf-8", "surrogateescape"), secret.encode())

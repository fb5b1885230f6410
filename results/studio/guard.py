"""Who may talk to the page's server: the right host name, the right origin, and elsewhere a token.

On this machine only, the names of this machine are the only ones accepted: another site cannot reach
the server by pointing its own name here (DNS rebinding), and a page of another site cannot open the
connection (its origin differs). Listening for others, every request needs the token of the address.
"""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field
from ipaddress import ip_address
from urllib.parse import urlsplit

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

COOKIE = "flexspline-studio"
LOCAL_NAMES = ("localhost", "127.0.0.1", "[::1]")
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


def is_loopback(host: str) -> bool:
    """Whether an address to listen on is reached from this machine only."""
    try:
        return ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


@dataclass(frozen=True)
class Guard:
    """The rules for one server; `token` is "" where it listens on this machine only."""

    host: str
    token: str = field(default="", repr=False)

    @classmethod
    def of(cls, host: str) -> Guard:
        return cls(host, "" if is_loopback(host) else secrets.token_urlsafe(32))

    def address(self, port: int) -> str:
        """What to open in a browser, the token in it."""
        name = f"[{self.host}]" if ":" in self.host.strip("[]") else self.host
        return f"http://{name}:{port}/" + (f"?token={self.token}" if self.token else "")

    @property
    def middleware(self) -> Middleware:
        @web.middleware
        async def check(request: web.Request, handler: Handler) -> web.StreamResponse:
            reason = self.refusal(request)
            if reason:
                return web.Response(status=403, text=f"{reason}\n", headers=HEADERS)
            given = request.query.get("token")
            if given is not None and request.path == "/":
                # the token leaves the address bar and the history at once
                moved = web.HTTPFound("/", headers=HEADERS)
                moved.set_cookie(
                    _cookie(request), given, httponly=True, samesite="Strict", path="/"
                )
                raise moved
            return await handler(request)

        return check

    def refusal(self, request: web.Request) -> str:
        """Why a request is turned away; "" lets it in."""
        host = request.host.rpartition(":")[0] if _has_port(request.host) else request.host
        if not self.token and host.lower() not in LOCAL_NAMES:
            return "this server answers to the names of its own machine only"
        origin = request.headers.get("Origin")
        if origin is not None and _netloc(origin) != request.host.lower():
            return "requests from other sites are refused"
        if self.token:
            given = request.query.get("token") or request.cookies.get(_cookie(request), "")
            if not hmac.compare_digest(_bytes(given), _bytes(self.token)):
                return "give the token: open the address that flexspline studio printed"
        return ""


def _netloc(origin: str) -> str | None:
    """Host and port in lower case; None of what is no address."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return None


def _bytes(text: str) -> bytes:
    """As it came, whatever its encoding."""
    return text.encode("utf-8", "surrogateescape")


def _cookie(request: web.Request) -> str:
    """Browsers keep one jar for all ports of a host; two studios need two names in it."""
    return f"{COOKIE}-{request.url.port}"


def _has_port(host: str) -> bool:
    return host.rpartition(":")[2].isdigit() and not host.endswith("]")

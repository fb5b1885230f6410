"""Starts and ends the page's server: address, port, browser."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import logging
import signal
import socket
import webbrowser
from pathlib import Path
from threading import Thread

from aiohttp import web

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.load import design_from, load_design, tables_from
from flexspline.geometry.template import template
from flexspline.results.job import tell
from flexspline.results.studio.guard import Guard
from flexspline.results.studio.server import Studio, application

LARGEST_PORT = 65535
"""TCP has 16 bits for it."""
_REASONS = {
    errno.EADDRINUSE: "another program uses this port; --port 0 takes any free port",
    errno.EACCES: "ports below 1024 are reserved for the system; --port 0 takes any free port",
    errno.EADDRNOTAVAIL: "this machine has no such address; --host 127.0.0.1 is this machine only",
    socket.EAI_NONAME: "no such host; --host 127.0.0.1 is this machine only",
}


def starting_design(path: Path | None) -> Design:
    """The file's design, or the template's cup; errors as `load_design`."""
    if path is not None:
        return load_design(path)
    return design_from(tables_from(template("cup").encode(), "template"))


def serve(design: Design, host: str, port: int, browser: bool) -> None:
    """Serve until Ctrl-C; prints the address once the page can be opened.

    Raises
    ------
    DesignError : the address cannot be listened on.
    """
    if not host.strip("[]"):
        raise DesignError("--host", host, "must be a name or an address, such as 127.0.0.1")
    if not 0 <= port <= LARGEST_PORT:
        raise DesignError("--port", port, f"must be from 0 to {LARGEST_PORT}; 0 takes any free one")
    logging.getLogger("aiohttp").setLevel(
        logging.CRITICAL
    )  # a broken upload is the browser's matter
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(Studio(Guard(host), design), host, port, browser))


async def _serve(studio: Studio, host: str, port: int, browser: bool) -> None:
    runner = web.AppRunner(application(studio), access_log=None, shutdown_timeout=1.0)
    await runner.setup()
    try:
        listening = await listen_at(runner, host, port)
        print(f"flexspline studio: {studio.guard.address(listening)}", flush=True)
        tell("stop with Ctrl-C")
        if browser:
            # a browser in the terminal does not return before it is left
            opened = studio.guard.opened_address(listening)
            Thread(target=webbrowser.open, args=(opened,), daemon=True).start()
        ended = asyncio.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            # Windows: Ctrl-C raises KeyboardInterrupt in asyncio.run instead
            with contextlib.suppress(NotImplementedError):
                asyncio.get_running_loop().add_signal_handler(number, ended.set)
        await ended.wait()
    finally:
        await runner.cleanup()


async def listen_at(runner: web.AppRunner, host: str, port: int) -> int:
    """The port, which the system has chosen if 0 was asked for.

    Raises
    ------
    DesignError : as `serve`.
    """
    try:
        await web.TCPSite(runner, host.strip("[]"), port).start()
    except (OSError, UnicodeError) as fault:
        code = fault.errno if isinstance(fault, OSError) else socket.EAI_NONAME
        if code is None:  # asyncio since Python 3.13: no address of that name could be bound
            code = errno.EADDRNOTAVAIL
        reason = _REASONS.get(code or 0) or str(fault)
        raise DesignError(
            "--host, --port", f"{host}:{port}", f"cannot listen there: {reason}"
        ) from None
    return int(runner.addresses[0][1])

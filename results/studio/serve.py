"""Listening: the address, the browser, and an orderly end."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
import webbrowser
from pathlib import Path
from threading import Thread

from aiohttp import web

from geometry.design import Design
from geometry.errors import DesignError
from geometry.load import design_from, load_design, tables_from
from geometry.template import template
from results.job import tell
from results.studio.guard import Guard
from results.studio.server import Studio, application


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
    logging.getLogger("aiohttp").setLevel(
        logging.CRITICAL
    )  # a broken upload is the browser's matter
    with contextlib.suppress(KeyboardInterrupt):
        asyncio.run(_serve(Studio(Guard.of(host), design), host, port, browser))


async def _serve(studio: Studio, host: str, port: int, browser: bool) -> None:
    runner = web.AppRunner(application(studio), access_log=None, shutdown_timeout=1.0)
    await runner.setup()
    try:
        site = web.TCPSite(runner, host.strip("[]"), port)
        try:
            await site.start()
        except (OSError, OverflowError) as fault:
            raise DesignError(
                "--host, --port", f"{host}:{port}", f"cannot listen there ({fault})"
            ) from None
        address = studio.guard.address(runner.addresses[0][1])
        print(f"flexspline studio: {address}", flush=True)
        tell("stop with Ctrl-C")
        if browser:
            # a browser in the terminal does not return before it is left
            Thread(target=webbrowser.open, args=(address,), daemon=True).start()
        ended = asyncio.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            asyncio.get_running_loop().add_signal_handler(number, ended.set)
        await ended.wait()
    finally:
        await runner.cleanup()

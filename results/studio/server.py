"""The page's server: its files, one connection for each tab, uploads and downloads."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from dataclasses import dataclass, field
from importlib.resources import files
from typing import Any

from aiohttp import WSMsgType, web

from flexspline.geometry.design import Design
from flexspline.geometry.errors import DesignError
from flexspline.geometry.input_file import LARGEST_TOML_BYTES
from flexspline.geometry.load import design_from, tables_from
from flexspline.geometry.shapes import KINDS
from flexspline.geometry.template import design_text, template
from flexspline.pipeline.diagnosis.measurement.grid import LARGEST_MEASURED_BYTES
from flexspline.results.studio.fields import form, received
from flexspline.results.studio.guard import Guard, add_headers
from flexspline.results.studio.jobs import SERVED
from flexspline.results.studio.page_style import page_style
from flexspline.results.studio.session import Session
from flexspline.results.studio.tab import StudioWorkers
from flexspline.results.style import STUDIO_COLOURS, as_css

LARGEST_MESSAGE = 2 * LARGEST_TOML_BYTES
"""A design as JSON is at most a little larger than as TOML."""
LARGEST_UPLOAD = LARGEST_MEASURED_BYTES // 10
"""Bytes of a measured file through the page: a tenth of what the command reads."""
_TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript", "svg": "image/svg+xml"}


@dataclass
class Studio:
    """What the server holds: the design it was started with, the workers, the open tabs."""

    guard: Guard
    design: Design
    workers: StudioWorkers = field(default_factory=StudioWorkers.of_this_machine)
    sessions: dict[str, Session] = field(default_factory=dict)
    page: dict[str, tuple[bytes, str]] = field(default_factory=lambda: _page())


STUDIO: web.AppKey[Studio] = web.AppKey("studio", Studio)


def application(studio: Studio) -> web.Application:
    """Routes and rules; the workers live as long as it runs."""
    app = web.Application(middlewares=[studio.guard.middleware], client_max_size=LARGEST_UPLOAD)
    app[STUDIO] = studio
    app.router.add_get("/", _file)
    app.router.add_get("/page/{name}", _file)
    app.router.add_get("/start", _start)
    app.router.add_get("/live", _live)
    app.router.add_post("/open", _open)
    app.router.add_post("/text", _text)
    app.router.add_post("/measured/{tab}", _measured)
    app.router.add_get("/made/{tab}/{kind}/{name}", _made)
    app.on_response_prepare.append(add_headers)
    app.cleanup_ctx.append(_workers)
    return app


async def _workers(app: web.Application) -> AsyncIterator[None]:
    app[STUDIO].workers.start()
    yield
    for session in list(app[STUDIO].sessions.values()):
        await session.close()
    app[STUDIO].workers.stop()


def _page() -> dict[str, tuple[bytes, str]]:
    """Every file of the page by name, read once: a request picks from these and reads no disk."""
    page_files = {"colours.css": (as_css(STUDIO_COLOURS).encode(), "text/css")}
    shared = files("flexspline.results.page_3d")
    for folder in (files("flexspline.results.studio") / "page", shared, shared / "vendor"):
        for entry in folder.iterdir():
            kind = _TYPES.get(entry.name.rpartition(".")[2])
            if kind and entry.is_file():
                page_files[entry.name] = (entry.read_bytes(), kind)
    return page_files


async def _file(request: web.Request) -> web.Response:
    page_file = request.app[STUDIO].page.get(request.match_info.get("name", "index.html"))
    if page_file is None:
        raise web.HTTPNotFound
    body, kind = page_file
    return web.Response(body=body, content_type=kind, charset="utf-8")


def _json(value: Any, status: int = 200) -> web.Response:
    text = json.dumps(value, allow_nan=False)
    return web.Response(text=text, content_type="application/json", status=status)


def _opened(design: Design) -> dict[str, Any]:
    tables = design.tables
    return {"tables": tables, "form": form(design)}


async def _start(request: web.Request) -> web.Response:
    """The design that the command named, how charts look, and what files may be sent."""
    largest = {"design": LARGEST_TOML_BYTES, "measured": LARGEST_UPLOAD}
    opened = _opened(request.app[STUDIO].design)
    return _json({**opened, "style": page_style(), "largest_bytes": largest})


async def _open(request: web.Request) -> web.Response:
    """A design as TOML, as JSON tables, or a template's name, checked: its tables and its form."""
    try:
        kind = request.query.get("kind", "")
        if kind in KINDS:
            tables = tables_from(template(kind).encode(), kind)
        elif request.content_type == "application/json":
            return _json(_opened(received(await _sent(request))))
        else:
            tables = tables_from(await _body(request, LARGEST_TOML_BYTES), "the file")
        return _json(_opened(design_from(tables)))
    except DesignError as fault:
        return _json({"key": fault.key, "text": str(fault)}, status=422)


async def _text(request: web.Request) -> web.Response:
    """JSON tables as the text of a design file."""
    try:
        design = received(await _sent(request))
    except DesignError as fault:
        return _json({"key": fault.key, "text": str(fault)}, status=422)
    return web.Response(text=design_text(design))


async def _measured(request: web.Request) -> web.Response:
    """A CSV for the tab's next diagnosis."""
    session = request.app[STUDIO].sessions.get(request.match_info["tab"])
    if session is None:
        raise web.HTTPNotFound
    session.measured = await _body(request, LARGEST_UPLOAD)
    return _json({"bytes": len(session.measured)})


async def _sent(request: web.Request) -> Any:
    """JSON of a design; what is no JSON is no design either."""
    try:
        return json.loads(await _body(request, LARGEST_MESSAGE))
    except (ValueError, RecursionError):
        return None


async def _body(request: web.Request, most: int) -> bytes:
    """At most so many bytes, whatever the request says of its length."""
    held = bytearray()
    try:
        async for chunk in request.content.iter_chunked(1 << 16):
            held += chunk
            if len(held) > most:
                raise web.HTTPRequestEntityTooLarge(
                    most, len(held), text=f"larger than {most // 1_000_000} MB"
                )
    except web.RequestPayloadError:
        refused = web.HTTPBadRequest(text="the body is not what its headers say")
        refused.force_close()  # where the next request begins is anybody's guess
        raise refused from None
    return bytes(held)


async def _made(request: web.Request) -> web.Response:
    """A file that a job of this tab made."""
    session = request.app[STUDIO].sessions.get(request.match_info["tab"])
    name = request.match_info["name"]
    data = None if session is None else session.file(request.match_info["kind"], name)
    if data is None:
        raise web.HTTPNotFound
    kind = SERVED["." + name.rpartition(".")[2]]
    # a report is a document of its own: it is handed over to keep, never shown as part of this site
    shown = {} if kind == "image/png" else {"Content-Disposition": f'attachment; filename="{name}"'}
    return web.Response(body=data, content_type=kind, headers=shown)


async def _live(request: web.Request) -> web.WebSocketResponse:
    """A tab's connection, as long as it lasts."""
    studio = request.app[STUDIO]
    socket = web.WebSocketResponse(max_msg_size=LARGEST_MESSAGE, heartbeat=20)
    await socket.prepare(request)
    session = Session(studio.workers, socket)
    studio.sessions[session.tab.key] = session
    try:
        await session.open()
        async for note in socket:
            if note.type == WSMsgType.TEXT:
                await session.take(note.data)
            else:
                await session.refuse()
    finally:
        del studio.sessions[session.tab.key]
        await session.close()
    return socket

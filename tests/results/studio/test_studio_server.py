"""The live page's server without a browser: who is let in, what is too large, what can be fetched."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import subprocess
import sys
import time
import tomllib
from collections.abc import Awaitable, Callable
from typing import Any

import pytest

from geometry.load import design_from
from geometry.template import template

pytest.importorskip("aiohttp", reason="aiohttp is not installed: pip install '.[studio]'")
from aiohttp import WSMsgType, WSServerHandshakeError
from aiohttp.test_utils import TestClient, TestServer

from results.studio.guard import Guard, is_loopback
from results.studio.server import LARGEST_MESSAGE, Studio, application
from results.studio.tab import Workers

DESIGN = design_from(tomllib.loads(template("cup")))


class Idle:
    """A worker that never answers: these tests are about who may ask."""

    def start(self) -> None: ...

    def stop(self) -> None: ...

    async def ask(self, question: str, tables: object) -> Any:
        await asyncio.Event().wait()


def with_client(check: Callable[[TestClient], Awaitable[None]], guard: Guard | None = None) -> None:
    """Run a check against a server in this process."""

    async def run() -> None:
        idle: Any = Workers(*(Idle() for _ in range(3)))
        studio = Studio(guard or Guard.of("127.0.0.1"), DESIGN, idle)
        async with TestClient(TestServer(application(studio))) as client:
            await check(client)

    asyncio.run(run())


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1", "[::1]", "127.0.0.7"])
def test_this_machine_needs_no_token(host: str) -> None:
    assert is_loopback(host)
    assert Guard.of(host).token == ""


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "workstation"])
def test_any_other_address_needs_one(host: str) -> None:
    one, two = Guard.of(host), Guard.of(host)
    assert len(one.token) >= 40
    assert one.token != two.token
    assert one.token not in repr(one)


def test_without_the_token_nothing_is_served() -> None:
    guard = Guard("0.0.0.0", "right")

    async def check(client: TestClient) -> None:
        for path in ("/", "/start", "/page/main.js", "/?token=wrong", "/?token=", "/made/a/b/c"):
            assert (await client.get(path)).status == 403, path
        for path in ("/open", "/text", "/measured/a"):
            assert (await client.post(path, data=b"")).status == 403, path
        for cookie in ("flexspline-studio=right", f"flexspline-studio-{client.port}=\udcff"):
            assert (await client.get("/", headers={"Cookie": cookie})).status == 403, cookie
        with pytest.raises(WSServerHandshakeError) as refused:
            await client.ws_connect("/live")
        assert refused.value.status == 403
        moved = await client.get("/?token=right", allow_redirects=False)
        assert (moved.status, moved.headers["Location"]) == (302, "/")
        cookie = moved.headers["Set-Cookie"]
        assert "HttpOnly" in cookie
        assert "SameSite=Strict" in cookie
        assert cookie.startswith(f"flexspline-studio-{client.port}=")  # one jar for all ports
        headers = {"Cookie": cookie.partition(";")[0]}
        assert (await client.get("/start", headers=headers)).status == 200
        async with client.ws_connect("/live", headers=headers) as socket:
            assert json.loads((await socket.receive()).data)["is"] == "hello"

    with_client(check, guard)


def test_other_sites_and_foreign_names_are_refused() -> None:
    async def check(client: TestClient) -> None:
        own = f"http://127.0.0.1:{client.port}"
        for headers in (
            {"Host": "evil.example"},  # DNS rebinding
            {"Host": f"evil.example:{client.port}"},
            {"Origin": "http://evil.example"},
            {"Origin": f"http://127.0.0.1:{client.port + 1}"},
            {"Origin": "null"},
            {"Origin": "http://["},
        ):
            assert (await client.get("/start", headers=headers)).status == 403, headers
            with pytest.raises(WSServerHandshakeError):
                await client.ws_connect("/live", headers=headers)
        assert (await client.get("/start", headers={"Origin": own})).status == 200
        assert (await client.get("/start", headers={"Host": "localhost"})).status == 200

    with_client(check)


def test_no_path_reaches_the_file_system() -> None:
    async def check(client: TestClient) -> None:
        for name in (
            "..%2f..%2fserver.py",
            "%2fetc%2fpasswd",
            "LICENSE.three",
            "server.py",
            "..%5c",
        ):
            assert (await client.get(f"/page/{name}")).status == 404, name
        async with client.ws_connect("/live") as socket:
            tab = json.loads((await socket.receive()).data)["tab"]
            for name in ("..%2fdesign.toml", "%2fetc%2fpasswd", "report.pdf"):
                assert (await client.get(f"/made/{tab}/report/{name}")).status == 404, name
        assert (await client.get(f"/made/{tab}/report/report.pdf")).status == 404

    with_client(check)


def test_uploads_are_limited() -> None:
    async def check(client: TestClient) -> None:
        assert (await client.post("/open", data=b"#" * 1_000_001)).status == 413
        async with client.ws_connect("/live", max_msg_size=0) as socket:
            tab = json.loads((await socket.receive()).data)["tab"]

            async def endless() -> Any:  # no length is stated
                for _ in range(21):
                    yield b"1" * 1_000_000

            assert (await client.post(f"/measured/{tab}", data=endless())).status == 413
            assert (await client.post(f"/measured/{tab}", data=b"a,b\n")).status == 200
            await socket.send_str("x" * (LARGEST_MESSAGE + 1))
            assert (await socket.receive()).type in (WSMsgType.CLOSE, WSMsgType.CLOSED)
        assert (await client.post("/measured/unknown", data=b"a,b\n")).status == 404

    with_client(check)


@pytest.mark.parametrize(
    "note",
    ["", "[]", "{}", '{"do": "want"}', '{"do": "job", "kind": "../x", "tables": {}}', "[" * 9000,
     '{"do": "want", "number": 1, "tables": 7, "view": "wave_generator"}',
     '{"do": "want", "number": 1, "tables": {"name": NaN}, "view": "wave_generator"}'],
)  # fmt: skip
def test_nonsense_from_a_tab_is_survived(note: str) -> None:
    async def check(client: TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await socket.receive()
            await socket.send_str(note)
            tables = DESIGN.model_dump(mode="json", exclude_none=True)
            sane = {"do": "want", "number": 2, "tables": tables, "view": "wave_generator"}
            await socket.send_str(json.dumps(sane))
            while (said := json.loads((await socket.receive()).data)).get("number") != 2:
                assert said["is"] in ("refused", "fault")
            assert said["is"] == "taken"

    with_client(check)


@pytest.mark.parametrize("body", [b"", b"7", b"[" * 9000, b"{}", b'{"name": "x", "flexspline": 1}'])
def test_a_body_that_is_no_design_is_refused(body: bytes) -> None:
    async def check(client: TestClient) -> None:
        for path in ("/open", "/text"):
            reply = await client.post(path, data=body, headers={"Content-Type": "application/json"})
            assert reply.status == 422
            assert "\n" not in (await reply.json())["text"]

    with_client(check)


def test_the_page_may_load_only_its_own() -> None:
    async def check(client: TestClient) -> None:
        reply = await client.get("/")
        assert "default-src 'none'" in reply.headers["Content-Security-Policy"]
        text = await reply.text()
        assert "http://" not in text
        assert "https://" not in text

    with_client(check)


@pytest.mark.parametrize(
    "options", [["--port", "70000"], ["--host", "no such host"], ["missing.toml"]]
)
def test_wrong_options_are_one_line(options: list[str]) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "results.cli", "studio", "--no-browser", *options],
        capture_output=True, text=True, check=False, timeout=60,
    )  # fmt: skip
    assert done.returncode == 2
    assert "Traceback" not in done.stderr


@pytest.mark.parametrize("after_s", [0.0, 0.2])
def test_ctrl_c_ends_it_in_silence(after_s: float) -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "results.cli", "studio", "--no-browser"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    ) as studio:  # fmt: skip
        assert studio.stdout is not None
        studio.stdout.readline()  # its workers are starting
        time.sleep(after_s)
        os.killpg(studio.pid, signal.SIGINT)  # as a terminal does: to all of them
        _, said = studio.communicate(timeout=60)
    assert (studio.returncode, said) == (0, "stop with Ctrl-C\n")

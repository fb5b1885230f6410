"""The live page's server without a browser: what is too large, what can be fetched, where it listens."""

from __future__ import annotations

import asyncio
import errno
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any
from urllib.request import HTTPCookieProcessor, build_opener

import aiohttp
import aiohttp.test_utils
import pytest
from in_process import flexspline
from studio_client import TABLES, heard, with_client
from studio_page import running, write_design

from flexspline.geometry.errors import DesignError
from flexspline.results.studio.serve import listen_at


def test_no_path_reaches_the_file_system() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        for name in (
            "..%2f..%2fserver.py",
            "%2fetc%2fpasswd",
            "LICENSE.three",
            "server.py",
            "..%5c",
        ):
            assert (await client.get(f"/page/{name}")).status == 404, name
        async with client.ws_connect("/live") as socket:
            tab = (await heard(socket))["tab"]
            for name in ("..%2fdesign.toml", "%2fetc%2fpasswd", "report.pdf"):
                assert (await client.get(f"/made/{tab}/report/{name}")).status == 404, name
        assert (await client.get(f"/made/{tab}/report/report.pdf")).status == 404

    with_client(check)


def test_uploads_are_limited() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        assert (await client.post("/open", data=b"#" * 1_000_001)).status == 413
        async with client.ws_connect("/live") as socket:
            tab = (await heard(socket))["tab"]

            async def endless() -> Any:  # no length is stated
                for _ in range(21):
                    yield b"1" * 1_000_000

            assert (await client.post(f"/measured/{tab}", data=endless())).status == 413
            assert (await client.post(f"/measured/{tab}", data=b"a,b\n")).status == 200
        assert (await client.post("/measured/unknown", data=b"a,b\n")).status == 404

    with_client(check)


@pytest.mark.parametrize("body", [b"", b"7", b"[" * 9000, b"{}", b'{"name": "x", "flexspline": 1}'])
def test_a_body_that_is_no_design_is_refused(body: bytes) -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        for path in ("/open", "/text"):
            reply = await client.post(path, data=body, headers={"Content-Type": "application/json"})
            assert reply.status == 422
            assert "\n" not in (await reply.json())["text"]

    with_client(check)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--port", "99999"], "--port = 99999: must be from 0 to 65535"),
        (["--port", "-1"], "--port = -1: must be from 0 to 65535"),
        (["--host", ""], '--host = "": must be a name or an address'),
        (["--host", "no such host"], "no such host"),
        (["--host", "a..b"], "no such host"),
        (["--host", "192.0.2.1"], "this machine has no such address"),  # RFC 5737: nobody's
        (["missing.toml"], "missing.toml"),
    ],
)
def test_wrong_options_are_one_line(options: list[str], said: str, tmp_path: Path) -> None:
    done = flexspline(
        "studio", "--no-browser", *options, folder=tmp_path
    )  # which looks for one line
    assert done.status == 2
    assert said in done.stderr


def test_a_port_that_another_program_has_is_one_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        options = ["--port", str(taken.getsockname()[1])]
        done = subprocess.run(
            [sys.executable, "-m", "flexspline.results.cli", "studio", "--no-browser", *options],
            capture_output=True, text=True, check=False, timeout=60,
        )  # fmt: skip
    assert done.returncode == 2
    assert "another program uses this port; --port 0" in done.stderr
    assert done.stderr.count("\n") == 1


def test_a_port_of_the_system_is_refused_with_advice(monkeypatch: pytest.MonkeyPatch) -> None:
    async def denied(site: aiohttp.web.TCPSite) -> None:  # root, which may, runs the tests in CI
        raise PermissionError(errno.EACCES, "permission denied")

    monkeypatch.setattr(aiohttp.web.TCPSite, "start", denied)

    async def listen() -> None:
        runner = aiohttp.web.AppRunner(aiohttp.web.Application())
        await runner.setup()
        await listen_at(runner, "127.0.0.1", 80)

    with pytest.raises(DesignError, match="ports below 1024"):
        asyncio.run(listen())


@pytest.mark.parametrize("host", [pytest.param("127.0.0.2", marks=pytest.mark.long), "::1"])
def test_it_answers_at_the_address_that_it_prints(host: str, tmp_path: Path) -> None:
    try:
        socket.create_server((host, 0), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError:
        pytest.skip(f"this machine has no {host}")
    with running(write_design(tmp_path / "design.toml"), "--host", host) as server:
        assert (f"[{host}]" if ":" in host else host) in server.url
        browser = build_opener(HTTPCookieProcessor())
        assert browser.open(server.url).status == 200
        assert b"flexspline" in browser.open(server.url.partition("?")[0] + "start").read()


def test_the_drawing_library_stays_out_of_the_server() -> None:
    look = "import sys, flexspline.results.studio.serve; print(sorted(m for m in sys.modules if 'vtk' in m))"
    done = subprocess.run([sys.executable, "-c", look], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("after_s", [0.0, pytest.param(0.2, marks=pytest.mark.long)])
def test_ctrl_c_ends_it_in_silence(after_s: float) -> None:
    with subprocess.Popen(
        [sys.executable, "-m", "flexspline.results.cli", "studio", "--no-browser"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
    ) as studio:  # fmt: skip
        assert studio.stdout is not None
        studio.stdout.readline()  # its workers are starting
        time.sleep(after_s)
        os.killpg(studio.pid, signal.SIGINT)  # as a terminal does: to all of them
        _, said = studio.communicate(timeout=60)
    late = "flexspline: stopping after the current step\n"  # of a loaded machine
    assert (studio.returncode, said.removesuffix(late)) == (0, "stop with Ctrl-C\n")


def test_a_job_that_cannot_begin_is_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*anything: object) -> str:
        raise OSError(errno.ENOSPC, "No space left on device", "/tmp")

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            with monkeypatch.context() as disk:
                disk.setattr(tempfile, "mkdtemp", full)
                await socket.send_str(json.dumps({"do": "job", "kind": "step", "tables": TABLES}))
                said = await heard(socket)
            assert said == {"is": "ended", "kind": "step", "state": "failed", "files": [],
                            "text": "/tmp: No space left on device"}  # fmt: skip
            await socket.send_str("no message")  # and the tab is still served
            assert (await heard(socket))["is"] == "refused"

    with_client(check)

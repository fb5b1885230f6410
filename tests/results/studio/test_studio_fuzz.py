"""Two hundred hostile messages and requests: refused in order, and the page goes on."""

from __future__ import annotations

import asyncio
import gzip
import json
import random
from typing import Any

import aiohttp
import aiohttp.test_utils
import pytest
from studio_client import TABLES, heard, want, with_client

from flexspline.geometry.design import Design
from flexspline.results.studio.jobs import Done, StudioJob
from flexspline.results.studio.server import LARGEST_MESSAGE

MUTATIONS = 200
RAW = {"Infinity", "-Infinity", "NaN", "1e999", "-1e999", "1e-999", "9" * 400, "9" * 6000, "[" * 300,
       "[" * 150 + "]" * 150, "{" * 9000, '"\\ud800"', '"\\u0000"', '"x"', "null", "true", "-1", "{}",
       "[]", "1.5", '"' + "y" * 100_000 + '"', "undefined", "0x1F", "\u202e", "//"}  # fmt: skip
"""Put in place of a value, as text: what JSON writers do not write too."""
MESSAGES: tuple[dict[str, Any], ...] = (
    {"do": "want", "number": 1, "tables": TABLES, "view": "wave_generator"},
    {"do": "job", "kind": "step", "tables": TABLES},
    {"do": "stop", "kind": "solid"},
    {"do": "fly", "kind": "../../etc"},
)
HEADERS = (
    b"Content-Encoding: gzip", b"Content-Encoding: deflate", b"Content-Encoding: br",
    b"Content-Encoding: \xff", b"Content-Type: ;;;=", b"Content-Type: application/json; charset=no",
    b"Content-Length: -1", b"Content-Length: 9999", b"Transfer-Encoding: chunked", b"Expect: x",
    b"Host: x:99999999", b"Host: [::1", b"Host: \xff", b"Origin: http://[", b"Cookie: \"\xff;=;a=",
    b"Range: bytes=9-1,-", b"Upgrade: websocket\r\nConnection: Upgrade", b"X: " + b"y" * 99_999,
    b"\r\n".join(b"X-%d: y" % i for i in range(3000)), b": nameless", b"no colon", b"X:\x00",
)  # fmt: skip
PATHS = (
    b"/", b"/start", b"/open", b"/text", b"/open?kind=cup", b"/open?kind=%ff", b"/measured/a",
    b"/made/a/b/c", b"/made/%2e%2e/%00/%ff", b"/page/%00", b"//[", b"http://[", b"*", b"/live",
    b"/?token=%ff", b"/" + b"a" * 9000, b"/?ticket=\xff",
)  # fmt: skip


def at_random(rng: random.Random, message: dict[str, Any]) -> str:
    """One value of a message replaced, or its text torn."""
    text = json.dumps(message)
    for _ in range(rng.randint(1, 3)):
        places = [i for i, letter in enumerate(text) if letter in ":,[{"]
        start = rng.choice(places) + 1 if places else 0
        end = next((i for i in range(start, len(text)) if text[i] in ",]}"), start)
        kind = rng.random()
        if kind < 0.7:
            text = text[:start] + rng.choice(sorted(RAW)) + text[end:]
        elif kind < 0.85:
            text = text[:start] + text[min(len(text), start + rng.randint(1, 40)) :]
        else:
            text = text[:end] + text[start:]
    return text


def request(rng: random.Random, cookie: str, port: int) -> bytes:
    """A request that may be malformed anywhere."""
    method = rng.choice([b"GET", b"POST", b"POST", b"PUT", b"G\xc3T", b"OPTIONS"])
    body = rng.choice([b"", b"garbage" * 30, at_random(rng, TABLES).encode(), b"[" * 9000,
                       gzip.compress(b"x" * 5_000_000)[: rng.choice([40, None])]])  # fmt: skip
    lines = [method + b" " + rng.choice(PATHS) + b" HTTP/1.1", b"Connection: close"]
    extra = rng.sample(HEADERS, rng.randint(0, 2))
    if not any(line.startswith(b"Host") for line in extra):
        lines.append(b"Host: 127.0.0.1:%d" % port)
    if not any(line.startswith((b"Content-Length", b"Transfer")) for line in extra):
        lines.append(b"Content-Length: %d" % len(body))
    if rng.random() < 0.9:
        lines.append(b"Cookie: " + cookie.encode())
    return b"\r\n".join([*lines, *extra, b"", body])


async def status(port: int, sent: bytes) -> int:
    """Of the answer; 400 where the connection is closed without one."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    try:
        writer.write(sent)
        writer.write_eof()
        line = await asyncio.wait_for(reader.readline(), 30)
    except ConnectionError:
        return 400
    finally:
        writer.close()
    return int(line.split()[1]) if line else 400


def test_hostile_input_meets_an_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    async def run(job: StudioJob, design: Design, measured: bytes = b"") -> Done:
        return Done("stopped", "stopped")  # these tests are about what is let through to it

    monkeypatch.setattr(StudioJob, "run", run)

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        jar = client.session.cookie_jar.filter_cookies(client.make_url("/"))
        cookie = "; ".join(f"{name}={entry.value}" for name, entry in jar.items())
        async with client.ws_connect("/live", max_msg_size=0) as socket:
            await heard(socket)
            for seed in range(MUTATIONS):
                rng = random.Random(seed)
                if seed % 2:
                    sent = request(rng, cookie, client.port)
                    assert await status(client.port, sent) < 500, (seed, sent[:300])
                else:
                    hostile = at_random(rng, rng.choice(MESSAGES))
                    binary = rng.random() < 0.1
                    await (
                        socket.send_bytes(hostile.encode()) if binary else socket.send_str(hostile)
                    )
                number = 1_000_000 + seed
                await socket.send_str(want(number))
                while (said := await heard(socket)).get("number") != number:
                    assert said["is"] in ("refused", "fault", "taken", "ended"), seed
                assert said["is"] == "taken", seed

    with_client(check)


@pytest.mark.parametrize(
    "note",
    ["", "[]", "{}", '{"do": "want"}', '{"do": "job", "kind": "../x", "tables": {}}', "[" * 9000,
     '{"do": "want", "number": 1e999, "tables": {}, "view": "wave_generator"}',
     '{"do": "want", "number": 7, "tables": {}, "view": "nothing"}',
     '{"do": "want", "number": 7, "tables": 7, "view": "wave_generator"}',
     '{"do": "want", "number": "7", "tables": {}, "view": "wave_generator"}',
     '{"do": ["want"]}', '{"do": "stop", "kind": {}}', b"\x00\x01", b'{"do": "want"}'],
)  # fmt: skip
def test_a_message_that_is_none_is_refused_and_the_connection_stays(note: str | bytes) -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await (socket.send_str(note) if isinstance(note, str) else socket.send_bytes(note))
            assert (await heard(socket))["is"] == "refused"
            await socket.send_str(want(8))
            assert (await heard(socket))["is"] == "taken"

    with_client(check)


@pytest.mark.parametrize("number", ["1e999", "NaN", "9" * 400])
def test_a_number_that_is_none_in_a_design_names_its_key(number: str) -> None:
    wall = json.dumps(TABLES["flexspline"]["wall_thickness_mm"])
    text = want(3).replace(f'"wall_thickness_mm": {wall}', f'"wall_thickness_mm": {number}')

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as socket:
            await heard(socket)
            await socket.send_str(text)
            said = await heard(socket)
            assert (said["is"], said.get("key")) in (
                ("fault", "flexspline.wall_thickness_mm"), ("refused", None)
            )  # fmt: skip
            assert "\n" not in said["text"]

    assert number in text
    with_client(check)


@pytest.mark.parametrize("encoding", ["gzip", "deflate"])
def test_a_body_that_does_not_unpack_is_a_bad_request(encoding: str) -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        for path in ("/open", "/text"):
            reply = await client.post(
                path, data=b"garbage" * 100, headers={"Content-Encoding": encoding}
            )
            assert reply.status == 400
            assert "body" in await reply.text()

    with_client(check)


def test_a_message_too_large_ends_its_connection_and_no_other() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        async with client.ws_connect("/live") as other:
            await heard(other)
            async with client.ws_connect("/live") as socket:
                await heard(socket)
                await socket.send_str("x" * (LARGEST_MESSAGE + 1))
                ended = await socket.receive(timeout=30)
                assert ended.type in (aiohttp.WSMsgType.CLOSE, aiohttp.WSMsgType.CLOSED)
            await other.send_str(want(1))
            assert (await heard(other))["is"] == "taken"

    with_client(check)

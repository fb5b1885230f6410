"""Who is let in to the live page's server: the token, the host's names, pages of other sites."""

from __future__ import annotations

import aiohttp
import aiohttp.test_utils
import pytest
from studio_client import heard, with_client

from flexspline.results.studio.guard import HEADERS, Guard, is_loopback

EVERYWHERE = ("127.0.0.1", "localhost", "::1", "0.0.0.0", "192.168.1.5", "workstation")


@pytest.mark.parametrize(
    "host", ["127.0.0.1", "localhost", "LOCALHOST", "::1", "[::1]", "127.0.0.7"]
)
def test_addresses_of_this_machine_alone(host: str) -> None:
    assert is_loopback(host)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "workstation", "127.0.0.1.evil"])
def test_addresses_that_others_reach(host: str) -> None:
    assert not is_loopback(host)


@pytest.mark.parametrize("host", EVERYWHERE)
def test_every_server_has_secrets_of_its_own(host: str) -> None:
    one, two = Guard(host), Guard(host)
    secrets = {one.token, one.ticket, two.token, two.ticket}
    assert len(secrets) == 4
    assert min(map(len, secrets)) >= 40
    assert one.token in one.address(8000)
    assert one.token not in one.opened_address(8000)  # on a command line that everybody can read
    assert not any(secret in repr(one) for secret in secrets)


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_without_the_token_nothing_is_served(host: str) -> None:
    guard = Guard(host, "right", "once")

    async def check(client: aiohttp.test_utils.TestClient) -> None:
        for path in ("/", "/start", "/page/main.js", "/?token=wrong", "/?token=", "/made/a/b/c",
                     "/nothing", "/?token=%ff%00", "/start?ticket=once"):  # fmt: skip
            reply = await client.get(path)
            assert reply.status == 403, path
            assert "use the address that flexspline studio printed" in await reply.text()
        for path in ("/open", "/text", "/measured/a"):
            assert (await client.post(path, data=b"")).status == 403, path
        for cookie in ("flexspline-studio=right", f"flexspline-studio-{client.port}=\udcff"):
            assert (await client.get("/", headers={"Cookie": cookie})).status == 403, cookie
        with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
            await client.ws_connect("/live")
        assert refused.value.status == 403

    with_client(check, guard, known=False)


def test_the_token_becomes_a_cookie_and_leaves_the_address() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        entered = await client.get("/?token=right")
        assert entered.status == 200
        assert "right" not in await entered.text()
        assert 'content="0; url=/"' in await entered.text()
        cookie = entered.headers["Set-Cookie"]
        assert "HttpOnly" in cookie
        assert "SameSite=Strict" in cookie
        assert cookie.startswith(f"flexspline-studio-{client.port}=")  # one jar for all ports
        assert (await client.get("/start")).status == 200
        async with client.ws_connect("/live") as socket:
            tab = (await heard(socket))["tab"]
            client.session.cookie_jar.clear()
            # whoever knows the tab still needs the token for what it made
            assert (await client.get(f"/made/{tab}/report/report.pdf")).status == 403
            assert (await client.post(f"/measured/{tab}", data=b"a\n")).status == 403

    with_client(check, Guard("127.0.0.1", "right", "once"), known=False)


def test_the_ticket_lets_in_once(capsys: pytest.CaptureFixture[str]) -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        assert (await client.get("/?ticket=once")).status == 200
        assert (await client.get("/start")).status == 200
        assert (await client.get("/?ticket=once")).status == 200  # again, by the same browser
        client.session.cookie_jar.clear()
        assert capsys.readouterr().err == ""
        for _ in range(3):
            assert (await client.get("/?ticket=once")).status == 403
        assert capsys.readouterr().err.count("used a second time") == 1

    with_client(check, Guard("127.0.0.1", "right", "once"), known=False)


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Host": "evil.example"}, 403),  # DNS rebinding
        ({"Host": "evil.example:{port}"}, 403),
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "http://127.0.0.1:1"}, 403),
        ({"Origin": "null"}, 403),
        ({"Origin": "http://["}, 403),
        ({"Host": "x:99999999"}, 400),
        ({"Host": "127.0.0.1:99999999"}, 400),
        ({"Host": "[::1"}, 400),
        ({"Host": ""}, 400),
        ({"Host": "me@127.0.0.1"}, 400),
        ({"Host": "localhost:{port}"}, 200),
        ({"Host": "127.0.0.2:{port}"}, 200),
        ({"Host": "[::1]:{port}"}, 200),
        ({"Origin": "http://127.0.0.1:{port}"}, 200),
    ],
)
def test_names_and_origins(headers: dict[str, str], status: int) -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        given = {key: value.format(port=client.port) for key, value in headers.items()}
        assert (await client.get("/start", headers=given)).status == status
        if status != 200:
            with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                await client.ws_connect("/live", headers=given)
            assert refused.value.status == status

    with_client(check)


def test_every_answer_has_the_headers_that_keep_the_token_in() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        for path in ("/", "/start", "/page/main.js", "/nothing", "/made/a/b/c"):
            reply = await client.get(path)
            assert reply.headers.items() >= HEADERS.items(), path
        assert reply.headers["Referrer-Policy"] == "no-referrer"
        client.session.cookie_jar.clear()
        assert (await client.get("/")).headers.items() >= HEADERS.items()

    with_client(check)


def test_the_page_may_load_only_its_own() -> None:
    async def check(client: aiohttp.test_utils.TestClient) -> None:
        reply = await client.get("/")
        assert "default-src 'none'" in reply.headers["Content-Security-Policy"]
        text = await reply.text()
        assert "http://" not in text
        assert "https://" not in text

    with_client(check)

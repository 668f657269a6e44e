"""Addresses of servers: what is odd in one is told without what is secret in it."""

from __future__ import annotations

import pytest

from afkb.errors import EndpointError
from afkb.store.http import Address, PassingTrouble, post


def test_a_tokens_line_break_is_left_out() -> None:
    address = Address.read("http://localhost:1", {"AFKB_STORE_TOKEN": "sekrit\n"})
    assert address.authorization == "Bearer sekrit"
    with pytest.raises(EndpointError) as refused:
        Address.read("http://localhost:1", {"AFKB_STORE_TOKEN": "sek\nrit"})
    assert "sek" not in str(refused.value)


def test_no_part_of_a_password_is_told() -> None:
    with pytest.raises(EndpointError) as refused:
        Address.read("http://user:pa/ss@host:7878", {})
    assert "pa" not in str(refused.value).replace("password", "")


@pytest.mark.parametrize("url", ["http://localhost:1/kü", "http://a..b/", "http://localhost:1/a b"])
def test_a_url_that_http_cannot_carry_is_refused_at_once(url: str) -> None:
    with pytest.raises(EndpointError, match="percent-encode") as refused:
        post(Address.read(url, {}), b"", "text/plain", timeout_s=1)
    assert not isinstance(refused.value, PassingTrouble)

"""Tests clients that send no request or no command: they harm nobody else, and do not fill the log."""

from __future__ import annotations

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from served import LOGGER, check_watching, frame_of, handshake, open_raw, served

from solepath.show.page.messages import CommandError, parse_command
from solepath.wire.receiver import build_position


@settings(max_examples=100)
@given(st.one_of(st.text(), st.dictionaries(
    st.sampled_from(["do", "value", "to", "sigma", "at", "level"]),
    st.none() | st.booleans() | st.floats() | st.integers() | st.sampled_from(["play", "seek", "speed", "here"])
    | st.lists(st.floats(), max_size=3),
).map(json.dumps)))  # fmt: skip
def test_any_text_is_a_command_or_none(text: str) -> None:
    try:
        command = parse_command(text)
    except CommandError as error:
        assert str(error) and "\n" not in str(error)
    else:
        assert command.do in ("play", "pause", "speed", "seek", "here")
        if command.do == "here":
            assert build_position(command.position) and command.value is None
            return
        message = {"do": command.do} if command.value is None else {"do": command.do, "value": command.value}
        assert parse_command(json.dumps(message)) == command


@pytest.mark.parametrize(
    "text",
    [
        "", "{", "null", '"play"', "{}", '{"do":"stop"}', '{"do":["play"]}', '{"do":"play","value":1}',
        '{"do":"play","do":"play"}', '{"do":"seek"}', '{"do":"seek","value":true}', '{"do":"seek","value":NaN}',
        '{"do":"seek","value":1e999}', '{"do":"speed","value":0}', '{"do":"speed","value":32.01}', "[" * 5000,
        '{"do":"here"}', '{"do":"here","value":1}', '{"do":"here","sigma":0}', '{"do":"here","sigma":1e5}',
        '{"do":"here","sigma":NaN}', '{"do":"here","sigma":1,"at":[1]}', '{"do":"here","sigma":1,"at":[1,"2"]}',
        '{"do":"here","sigma":1,"at":[1,2e6]}', '{"do":"here","sigma":1,"level":"0"}', '{"do":"play","sigma":1}',
        '{"do":"here","sigma":1,"at":[1,2],"level":0}', '{"do":"here","sigma":1,"at":[1,2],"level":"\\ud800"}',
        '{"do":"here","sigma":1,"at":[1,2],"level":"' + "x" * 65 + '"}', '{"do":"here","sigma":1,"place":"door"}',
    ],
)  # fmt: skip
def test_text_that_is_no_command_is_rejected(text: str) -> None:
    with pytest.raises(CommandError):
        parse_command(text)


@pytest.mark.parametrize(
    ("sent", "code"),
    [
        (frame_of(2, b"bytes"), 1003),
        (frame_of(1, b"\xff\xfe"), 1007),
        (frame_of(1, b"no json"), 1007),
        (frame_of(1, b'{"do":"seek","value":NaN}'), 1007),
        (frame_of(1, b'{"do":"dance"}'), 1008),
        (frame_of(1, b" " * 4096), 1007),
        (frame_of(1, b" " * 4097), 1009),
        (frame_of(3, b"reserved"), 1002),
        (frame_of(1, b"", fin=0xC0), 1002),
    ],
)
async def test_what_is_malformed_is_answered_with_a_close_and_one_line(
    sent: bytes, code: int, caplog: pytest.LogCaptureFixture
) -> None:
    async with served(commands=lambda command: None) as (page, client, url):
        reader, writer = await open_raw(page)
        writer.write(handshake())
        await reader.readuntil(b"\r\n\r\n")
        writer.write(sent)
        assert await reader.readuntil(b"\x88") and code.to_bytes(2, "big") in await reader.read(3)
        writer.close()
        await check_watching(client, url)
    assert [one.name for one in caplog.records] == [LOGGER]

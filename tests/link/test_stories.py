"""The files of protocol/stories: packets with their arrivals, and the samples and events that a decoder gives."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from here import PROTOCOL

from solepath.events import ClockReset, LayoutKnown, Limitation, PacketRejected, SampleGap, StreamResumed, StreamStale
from solepath.link.decoder import Decoder
from solepath.types import Packet, Sample, Site

STORIES = sorted((PROTOCOL / "stories").glob("*.json"))

KIND_OF_OUTPUT = {
    Sample: "sample",
    SampleGap: "gap",
    PacketRejected: "rejected",
    ClockReset: "reset",
    StreamStale: "stale",
    StreamResumed: "resumed",
    Limitation: "limitation",
    LayoutKnown: "layout known",
}


def feed_line(decoder: Decoder, site: Site, line: dict[str, Any]) -> list[Any]:
    if "channel" not in line:
        return decoder.advance(line["t"])
    return decoder.feed(Packet(line["t"], site, line["channel"], bytes.fromhex(line["data"])))


def describe(output: Any, expected: dict[str, Any]) -> dict[str, Any]:
    """Return the output in the form of the stories, with the keys that `expected` has."""
    fields: dict[str, Any] = {"what": KIND_OF_OUTPUT[type(output)]}
    for key in expected.keys() - {"what"}:
        if isinstance(output, LayoutKnown):
            layout = output.layout
            fields[key] = {"layout": layout.id, "cells": len(layout.cells), "length": layout.length}[key]
        elif isinstance(output, PacketRejected):
            fields[key] = output.reason.value
        else:
            value = getattr(output, key)
            fields[key] = list(value) if isinstance(value, tuple) else value
    return fields


def check(outputs: list[Any], expected: list[dict[str, Any]], tolerance: float, where: str) -> None:
    assert [KIND_OF_OUTPUT.get(type(o)) for o in outputs] == [e["what"] for e in expected], f"{where}: {outputs}"
    for output, fields in zip(outputs, expected, strict=True):
        description = describe(output, fields)
        for key, value in fields.items():
            if key in ("t", "duration"):
                assert description[key] == pytest.approx(value, rel=0, abs=tolerance), where
            elif isinstance(value, float | list):
                assert description[key] == pytest.approx(value, rel=1e-5, abs=1e-12), where
            else:
                assert description[key] == value, where


@pytest.mark.parametrize("path", STORIES, ids=lambda path: path.stem)
def test_a_decoder_gives_the_output_of_the_story(path: Path) -> None:
    story = json.loads(path.read_text())
    decoder = Decoder(site=Site(story["site"]))
    for number, line in enumerate(story["packets"]):
        outputs = feed_line(decoder, Site(story["site"]), line)
        check(outputs, line["gives"], story["tolerance"], f"{path.stem}, packet {number}")
        assert all(output.known_at >= max(output.t, line["t"]) for output in outputs), "known before it was, or arrived"

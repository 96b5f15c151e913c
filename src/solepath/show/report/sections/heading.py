"""Adds the head of a report: what it is of, whom, when and with which device, and at its end how it was made."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from datetime import date
from typing import Any
from xml.etree.ElementTree import Element

from ....recording import printable
from ...tables.svg import add
from ..content import ReportContent, ReportDetails
from ..markup import terms

CAUTION = (
    "These are measurements of foot-worn sensors, for whoever knows how to read them. They are no diagnosis and come "
    "from no medical device."
)


def date_words(text: str) -> str:
    """Return a date such as 2026-11-26 in words, 26 November 2026; any other text as it is."""
    with suppress(ValueError):
        day = date.fromisoformat(text.strip())
        return f"{day.day} {day:%B %Y}"
    return text.strip()


def moment_words(when: str) -> tuple[str, str]:
    """Return date and time of a moment such as "2026-11-26 09:40 UTC" in words; ("", "") without a moment."""
    day, _, time = when.partition(" ")
    words = date_words(day)
    return (words, time.strip()) if words != day else ("", "")


def title_of(details: ReportDetails, when: str, kind: str) -> str:
    """Return the heading: the given one, else "Walk of" a date, else "Gait report".

    `kind` is "Walk", "Run" or "Recording"; `when` is the start of the recording, as in moment_words."""
    day = date_words(details.date) or moment_words(when)[0]
    return details.title.strip() or (f"{kind} of {day}" if day else "Gait report")


def add_heading(main: Element, title: str, report: ReportContent) -> None:
    """Add the title, and a line of what is known of subject, date and device."""
    header, details = add(main, "<header><h1>{}</h1></header>", title), report.details
    moment = ", ".join([words for words in moment_words(report.when) if words])
    day = date_words(details.date) or moment or report.when
    shown_day = "" if title.endswith(day) else day
    terms(
        header, [("Subject", details.subject.strip()), ("Date", shown_day), ("Device", details.device.strip())], "facts"
    )


def making_facts(recipe: str, version: str, made_by: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return recipe and inputs with their hashes, and the version; `made_by` is as `provenance` says it."""
    return [
        ("Recipe", _hashed(recipe, made_by.get("recipe_sha256"))),
        *[("Input", _hashed(one["name"], one["sha256"])) for one in made_by.get("inputs", ())],
        ("Made by", f"solepath {version}".rstrip()),
    ]


def _hashed(name: str, sha256: str | None) -> str:
    return printable(name) if sha256 is None else f"{printable(name)}, SHA-256 {sha256}"


def add_making(parent: Element, facts: list[tuple[str, str]]) -> None:
    """Add how the report was made, and what it is not."""
    terms(parent, facts, "facts")
    add(parent, "<p class='caution'>{}</p>", CAUTION)

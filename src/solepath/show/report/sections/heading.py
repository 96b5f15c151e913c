"""Adds the head of a report: what it is of, whom, when and with which device, and at its end how it was made."""

from __future__ import annotations

from datetime import date, datetime
from xml.etree.ElementTree import Element

from attrs import frozen

from ..markup import add, terms

CAUTION = (
    "These are measurements of foot-worn sensors, for whoever knows how to read them. They are no diagnosis and come "
    "from no medical device."
)
MONTHS = (
    "January", "February", "March", "April", "May", "June", "July", "August", "September", "October", "November",
    "December",
)  # fmt: skip


@frozen
class ReportDetails:
    """Texts that a person gives for the head of a report; all may be empty."""

    title: str = ""
    subject: str = ""
    """Person, code or test."""
    date: str = ""
    """Date of the walk; one such as 2026-11-26 is shown in words."""
    device: str = ""


def date_words(text: str) -> str:
    """Return a date such as 2026-11-26 in words, 26 November 2026; any other text as it is."""
    try:
        day = date.fromisoformat(text.strip())
    except ValueError:
        return text.strip()
    return f"{day.day} {MONTHS[day.month - 1]} {day.year}"


def moment_words(when: str) -> tuple[str, str]:
    """Return date and time of a moment such as "2026-11-26 09:40 UTC" in words; ("", "") without a moment."""
    day, _, rest = when.partition(" ")
    try:
        datetime.fromisoformat(day)
    except ValueError:
        return "", ""
    return date_words(day), rest.strip()


def title_of(details: ReportDetails, when: str, what: str) -> str:
    """Return the heading: the given one, else "Walk of" a date, else "Gait report".

    `what` is "Walk", "Run" or "Recording"; `when` is the start of the recording, as in moment_words."""
    if details.title.strip():
        return details.title.strip()
    day = date_words(details.date) or moment_words(when)[0]
    return f"{what} of {day}" if day else "Gait report"


def add_heading(main: Element, title: str, details: ReportDetails, when: str) -> None:
    """Add the title, and a line of what is known of subject, date and device."""
    header = add(main, "header")
    add(header, "h1", title)
    day, time = moment_words(when)
    given = date_words(details.date)
    date_text = given or (f"{day}, {time}" if time else day) or when
    facts = [("Subject", details.subject.strip()), ("Date", date_text), ("Device", details.device.strip())]
    known = [(name, words) for name, words in facts if words and not (name == "Date" and title.endswith(words))]
    if known:
        terms(header, known, class_="facts")


def add_making(parent: Element, facts: list[tuple[str, str]]) -> None:
    """Add how the report was made, and what it is not."""
    terms(parent, [(name, words) for name, words in facts if words], class_="facts")
    add(parent, "p", CAUTION, class_="caution")

"""Writes a walk as one HTML file, to read, mail and print."""

from __future__ import annotations

from pathlib import Path
from xml.etree.ElementTree import tostring

from attrs import define

from ...saving.files import os_errors_naming
from .content import ReportContent
from .sections.page import page_of


@define
class Report(ReportContent):
    """The report of a walk; `take` adds what its session was fed and returned, `write` writes it."""

    def write(self, path: Path) -> None:
        """Write the page to a file, UTF-8; raise OSError, naming the file, when it cannot be written."""
        with os_errors_naming(path):
            path.write_bytes(self.text().encode("utf-8"))

    def text(self) -> str:
        """Return the page as HTML."""
        return "<!DOCTYPE html>\n" + tostring(page_of(self), encoding="unicode", method="html") + "\n"

"""Defines the options of `solepath track` for the report, and makes the empty report that they describe."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path
from typing import TYPE_CHECKING

from ...recording import Source, printable
from ...show.tables.words import moment_text
from .outcomes import band_files_of, person_of
from .parser import option, together

if TYPE_CHECKING:
    from ...floorplan.plan import FloorPlan
    from ...show.report import Report

DETAILS = {
    "title": "heading of the report (default: walk of its date, if that is known)",
    "subject": "whom the report is of: a person, a code, a test",
    "date": "date of the walk, as in 2026-11-26 (default: that of the recording, if it has one)",
    "device": "what was worn, as in 'insoles, size 42'",
}
"""Options that only the report shows, with their help."""


add_report = together(
    option(
        "--report", metavar="FILE", type=Path, help="write figures and the gait table into one HTML file, to be mailed"
    ),
    *[option(f"--{name}", metavar="TEXT", help=text) for name, text in DETAILS.items()],
    option(
        "--compare",
        metavar="BEFORE",
        type=Path,
        action="append",
        help="an earlier recording to compare with, run with the same recipe and calibration, without floor plan and "
        "with its clocks as they are; twice for the files of two feet",
    ),
)
"""--report and the options that go with it."""


def report_of(
    options: Namespace, source: Source, *, recipe: str, plan: FloorPlan | None = None, before: Report | None
) -> Report | None:
    """Return the report that the options describe, before anything was measured; None without --report."""
    if options.report is None:
        return None
    from ...show.report import Report, ReportDetails
    from ...show.report.bands import mean_bands, read_bands

    bands = mean_bands(person_of(options))
    for path in band_files_of(options):
        bands |= read_bands(path)
    return Report(
        printable(source.name),
        plan,
        recipe,
        moment_text(source.header),
        details=ReportDetails(**{name: getattr(options, name) or "" for name in DETAILS}),
        bands=bands,
        calibrated=options.calibration is not None,
        before=before,
    )

"""Renders the report in Chromium: one or two pages of A4, nothing cut, letters of 12 px or more, no fault by axe."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from browsers import Browser, Browsing, window
from floors import LOW, OFFICE, Pedestrian, office
from reported_walks import events_of, pressed_events, report_of

from solepath.body.place.particles import Particles
from solepath.floorplan.plan import Start
from solepath.show.report import Report, ReportDetails
from solepath.show.report.bands import Band

PAGE = re.compile(rb"/Type\s*/Page\b(?!s)")
PAPER_WIDTH = 688
"""Width of the contents of a page of A4 with margins of 14 mm, CSS px."""
CUT = """() => {
  const width = document.documentElement.clientWidth, found = [];
  for (const one of document.querySelectorAll("body *")) {
    const box = one.getBoundingClientRect();
    if (box.width && (box.right > width + 1 || box.left < -1)) found.push(`${one.tagName}: ${one.textContent}`);
    if (!one.closest("svg") && one.scrollWidth > one.clientWidth + 1 && getComputedStyle(one).display === "block")
      found.push(`${one.tagName} is cut: ${one.textContent}`);
  }
  return found;
}"""
"""Script that returns the elements that are wider than the page, or hide a part of their contents."""
SMALL = """() => {
  const found = [];
  for (const one of document.querySelectorAll("body *")) {
    const words = [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
    if (!words || !one.getClientRects().length || ["title", "desc"].includes(one.tagName)) continue;
    const scale = one.closest("svg") ? one.getScreenCTM().a : 1;
    const size = scale * parseFloat(getComputedStyle(one).fontSize);
    if (size < 11.95) found.push(`${size} px: ${one.textContent}`);
  }
  return found;
}"""
"""Script that returns the texts with letters of less than 12 px."""


def planned_report() -> Report:
    report, part, one = Report("indoors", office()), Particles(), Pedestrian(32, "0", (12.0, LOW))
    one.walk((24.0, LOW))
    part.set_out(Start("0", (12.0, LOW), -one.turned))
    for step in one.received:
        report.take(None, part.follow(OFFICE, step.events, step.here))
    return report


def made(name: str) -> Report:
    details = ReportDetails("", "P 017", "2026-11-26", "insoles, size 42")
    bands = {"speed_m_per_s": Band(1.1, 1.5, "A source"), "double_support_percent": Band(18.0, 24.0, "A source")}
    match name:
        case "plan":
            return planned_report()
        case "cells":
            return report_of(pressed_events(), details=details, bands=bands)
        case "long":
            return report_of(events_of("walk"), details=ReportDetails("t" * 150, "s" * 150, "d" * 150, "word " * 50))
        case "compared":
            return report_of(events_of("walk"), before=report_of(events_of("slow")))
    return report_of(events_of(name))


@pytest.mark.parametrize(
    ("name", "length"),
    [("walk", 2), ("cells", 2), ("run", 2), ("stairs", 2), ("compared", 2), ("plan", 1), ("standing", 1)],
)
def test_a_report_ends_on_two_pages_of_paper_or_on_one_without_gait_and_nothing_is_cut(
    browser: Browsing, name: str, length: int, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    made(name).write(path)

    async def print_it(chromium: Browser) -> tuple[int, list[str]]:
        async with window(chromium, path.as_uri(), width=PAPER_WIDTH) as view:
            pdf = await view.tab.pdf(prefer_css_page_size=True, print_background=True)
            await view.tab.emulate_media(media="print")
            return len(PAGE.findall(pdf)), await view.tab.evaluate(CUT)

    pages, cut = browser.run(print_it)
    assert (pages, cut) == (length, [])


@pytest.mark.parametrize("name", ["cells", "plan", "compared", "run", "long"])
def test_on_a_screen_nothing_is_cut_and_no_letter_is_small(browser: Browsing, name: str, tmp_path: Path) -> None:
    path = tmp_path / "report.html"
    made(name).write(path)

    async def look(chromium: Browser) -> list[str]:
        found = []
        for width in (360, 700, 1000, 1400):
            async with window(chromium, path.as_uri(), width=width) as view:
                found += [f"{width}: {one}" for script in (CUT, SMALL) for one in await view.tab.evaluate(script)]
                assert not view.complaints and len(view.requests) == 1
        return found

    assert browser.run(look) == []


@pytest.mark.parametrize("dark", [False, True])
def test_axe_finds_no_violation(browser: Browsing, dark: bool, tmp_path: Path) -> None:
    axe = pytest.importorskip("axe_playwright_python.async_playwright", reason="axe is not installed")
    path = tmp_path / "report.html"
    made("cells").write(path)

    async def check(chromium: Browser) -> list[str]:
        async with window(chromium, path.as_uri(), width=1000, dark=dark) as view:
            results = await axe.Axe().run(view.tab)
            return [f"{one['id']}: {one['nodes'][0]['html']}" for one in results.response["violations"]]

    assert browser.run(check) == []

"""Renders the report in Chromium: one or two pages of A4, nothing cut, letters of 12 px or more, no fault by axe."""

from __future__ import annotations

import re
from math import pi
from pathlib import Path

import pytest
from browsers import Browser, window
from commands import run
from measures import axe_faults
from pages import read_page
from recordings import recorded
from reported_walks import events_of, pressed_events, report_of
from soak import longer, soaked
from walks import insoles

from solepath.emulate.routes.route import Route
from solepath.show.outcomes.clinic import OutcomeRequest, WalkTest
from solepath.show.outcomes.references import Person, Sex, six_minute_reference
from solepath.show.report import Report, ReportDetails
from solepath.show.report.bands import Band, mean_bands

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

OVERLAPPING = """() => {
  const found = [];
  for (const svg of document.querySelectorAll("svg")) {
    const frame = svg.getBoundingClientRect();
    const words = [...svg.querySelectorAll("text")].filter((one) => one.getClientRects().length);
    words.forEach((one, k) => {
      const a = one.getBoundingClientRect();
      if (a.left < frame.left - 1 || a.right > frame.right + 1 || a.top < frame.top - 1 || a.bottom > frame.bottom + 1)
        found.push(`${one.textContent} is cut`);
      for (const other of words.slice(0, k)) {
        const b = other.getBoundingClientRect();
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (across > 1 && down > 3) found.push(`${one.textContent} is over ${other.textContent}`);
      }
    });
  }
  return found;
}"""
"""Script that returns the words of drawings that reach out of them, or into other words."""


OVER_THE_TRACK = """() => {
  const found = [];
  for (const way of document.querySelectorAll("svg path.way")) {
    if (!way.getClientRects().length || way.closest("svg").matches(".plan")) continue;
    const at = way.getScreenCTM(), points = [];
    for (let one = 0; one < way.getTotalLength(); one += 2) points.push(way.getPointAtLength(one).matrixTransform(at));
    for (const one of way.closest("svg").querySelectorAll("text.halo")) {
      const box = one.getBoundingClientRect();
      if (points.some((p) => p.x > box.left + 1 && p.x < box.right - 1 && p.y > box.top + 2 && p.y < box.bottom - 2))
        found.push(`${one.textContent} is over the track`);
    }
  }
  return found;
}"""
"""Script that returns the labels of a track through which it goes."""
ASIDE = """() => {
  const found = [];
  for (const table of document.querySelectorAll("table")) {
    const heads = [...table.querySelectorAll("thead th")].slice(1).map((one) => one.getBoundingClientRect());
    for (const row of table.querySelectorAll("tbody tr"))
      [...row.children].slice(1).forEach((one, k) => {
        const box = one.getBoundingClientRect();
        if (Math.abs(box.left - heads[k].left) > 1 || Math.abs(box.right - heads[k].right) > 1)
          found.push(`${one.textContent} is not below its header: ${row.textContent}`);
      });
  }
  return found;
}"""
"""Script that returns the cells of tables that are not below their headers."""
LAYOUT = (CUT, OVERLAPPING, ASIDE)
REQUESTS = {
    "six-minute": OutcomeRequest(test=WalkTest.SIX_MINUTE, person=Person(72.0, Sex.FEMALE, 1.62, 68.0)),
    "tug": OutcomeRequest(test=WalkTest.UP_AND_GO, marks=(1.0, 20.0), person=Person(72.0, Sex.FEMALE)),
    "walk test": OutcomeRequest(test=WalkTest.WALK, person=Person(72.0, Sex.FEMALE)),
}


def made(name: str) -> Report:
    if name in REQUESTS:
        before = report_of(events_of("slow"), outcomes=REQUESTS[name])
        bands = mean_bands(REQUESTS[name].person)
        return report_of(pressed_events(), outcomes=REQUESTS[name], before=before, bands=bands)
    if name == "cells":
        bands = {"speed_m_per_s": Band(1.1, 1.5, "A source"), "double_support_percent": Band(18.0, 24.0, "A source")}
        return report_of(pressed_events(), details=ReportDetails("t" * 150, "s" * 150, "", "word " * 50), bands=bands)
    return report_of(events_of(name), before=report_of(events_of("slow")) if name == "run" else None)


@pytest.mark.soak
@pytest.mark.parametrize(("name", "length"), [("run", 2), ("standing", 1), ("tug", 2), ("walk test", 2)])
async def test_a_report_ends_on_two_pages_of_paper_or_on_one_without_gait_and_nothing_is_cut(
    chromium: Browser, name: str, length: int, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    made(name).write(path)
    async with window(chromium, path.as_uri(), width=PAPER_WIDTH) as view:
        pdf = await view.tab.pdf(prefer_css_page_size=True, print_background=True)
        assert len(PAGE.findall(pdf)) == length
        await view.tab.emulate_media(media="print")
        assert [one for script in LAYOUT for one in await view.tab.evaluate(script)] == []


@pytest.mark.parametrize("name", [*soaked("six-minute"), *longer("tug", "walk test", "run")])
async def test_on_a_screen_labels_are_beside_the_track_and_cells_below_their_headers(
    chromium: Browser, name: str, tmp_path: Path
) -> None:
    path = tmp_path / "report.html"
    made(name).write(path)
    async with window(chromium, path.as_uri(), width=1000) as view:
        for width in (360, 390, 800, 1300):
            await view.tab.set_viewport_size({"width": width, "height": 900})
            scripts = (*LAYOUT, SMALL, OVER_THE_TRACK)
            assert [one for script in scripts for one in await view.tab.evaluate(script)] == [], width


@pytest.mark.parametrize("name", [*REQUESTS, "cells", "run"])
def test_no_number_is_on_another_line_than_its_unit(name: str) -> None:
    text = re.sub(
        "<style>.*?</style>|<title[^>]*>.*?</title>|<desc.*?</desc>|<[^>]*>", "", made(name).text(), flags=re.S
    )
    units = r"\d (?:m/s|mm|ms|m|s|min|%|Hz|deg|points)(?![\w/])"
    assert re.findall(units, text) == [] and re.search(units.replace(" ", "\N{NO-BREAK SPACE}"), text)


@pytest.mark.parametrize("dark", [*soaked(False), *longer(True)])
async def test_on_a_screen_nothing_is_cut_no_letter_is_small_and_axe_finds_no_violation(
    chromium: Browser, dark: bool, tmp_path: Path
) -> None:
    pytest.importorskip("axe_playwright_python", reason="axe is not installed")
    path = tmp_path / "report.html"
    made("cells").write(path)
    async with window(chromium, path.as_uri(), width=1000, dark=dark) as view:
        assert await axe_faults(view) == []
        for width in (360, 700, 1000, 1400):
            await view.tab.set_viewport_size({"width": width, "height": 900})
            assert [one for script in (*LAYOUT, SMALL) for one in await view.tab.evaluate(script)] == [], width
        assert not view.complaints and len(view.requests) == 1


@pytest.mark.long
async def test_six_whole_minutes_with_the_walk_before_have_two_pages_and_their_prediction(
    chromium: Browser, tmp_path: Path
) -> None:
    walks = []
    for seed, speed, crossings in ((5, 1.3, 16), (6, 1.1, 14)):
        route = Route().stand(2.0)
        for k in range(crossings):  # the corridor of 30 m of the test (ATS 2002)
            route = route.walk(30.0, speed).turn(pi if k % 2 else -pi, radius=0.5)
        walks.append(recorded(tmp_path / f"walk_{seed}.jsonl", insoles(route.stop(2.0), seed=seed).packets))
    options = ("--test", "six-minute", "--compare", walks[1], "--reference", "72,female,162,68")
    assert run("track", walks[0], *options, "--report", tmp_path / "r.html").returncode == 0
    reference = six_minute_reference(Person(72.0, Sex.FEMALE, 1.62, 68.0))
    result = read_page(tmp_path / "r.html").first("main").all("p")[0].text
    assert reference is not None and f"of the predicted {reference.value:.1f} m (lower limit" in result
    assert "reaches the smallest that matters, 30 m." in result
    async with window(chromium, (tmp_path / "r.html").as_uri(), width=PAPER_WIDTH) as view:
        pdf = await view.tab.pdf(prefer_css_page_size=True, print_background=True)
        assert len(PAGE.findall(pdf)) == 2
        await view.tab.emulate_media(media="print")
        assert [one for script in (*LAYOUT, OVER_THE_TRACK) for one in await view.tab.evaluate(script)] == []
        await view.tab.emulate_media(media="screen")
        for width in (390, 800, 1300):
            await view.tab.set_viewport_size({"width": width, "height": 900})
            assert [one for script in (*LAYOUT, OVER_THE_TRACK) for one in await view.tab.evaluate(script)] == []

"""Puts a report together: what somebody with ten seconds reads, then details, definitions and how it was made."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ...findings import Concern, texts
from ...outcomes.clinic import ClinicalResults, WalkTest
from ...outcomes.rows import OutcomeRow
from ...tables.svg import add
from ..content import ReportContent
from ..figures.activity import activity_figure
from ..figures.pressure import pressure_figures
from ..figures.space import space_figure
from ..figures.stride import stride_figures
from ..figures.track import plan_figure, track_figure
from ..markup import keep_units, paragraph, section, sentences, skeleton, table, whole_sentences
from ..words import LINK_HEADER, link_rows, overview, sensors
from .clinical import clinical_sections
from .comparison import comparison
from .facts import Facts, facts_of
from .gait_table import definitions, gait_table
from .heading import add_heading, add_making, making_facts, title_of
from .headline import headline
from .key_figures import key_figures
from .quality import BEFORE, STOP, judgements, overall, quality_box, warning

NO_PLACE = "Where on the floor plan the wearer was is not known."
NO_TRACK = "There is no track: no foot with a motion sensor took two strides."
CONCERNING = {
    WalkTest.SIX_MINUTE: ["samples", "strides", "plausibility", "wearing", BEFORE],
    WalkTest.UP_AND_GO: ["plausibility"],
    WalkTest.WALK: ["gait cycles", "samples", "strides", "plausibility", "wearing", BEFORE],
}
"""Parts of the quality that concern the result of each test.

None needs clocks that agree, and only the speed of a walk needs gait cycles. The time of an up and go is that between
two marks, whatever the sensors missed."""
FOUND = {
    "Cannot be right": (Concern.DATA,),
    "Missing or wrong": (Concern.WEAR, Concern.LINK, Concern.STRIDES),
    "Done without": (Concern.LIMITATION,),
}
"""Headings of the findings."""


def page_of(report: ReportContent) -> Element:
    """Return the page of a report as an <html> element."""
    facts, walk = facts_of(report), report.walk
    outcomes, before = _outcomes_of(report), None if report.before is None else facts_of(report.before)
    earlier = _outcomes_of(report.before)
    test = None if report.outcomes is None else report.outcomes.test
    title = title_of(report.details, report.when, facts.kind if test is None else test.title)
    html, main = skeleton(title)
    main.set("class", "" if test is None else "test")
    add_heading(main, title, report)
    if test is not None and outcomes is not None:
        add(main, "<p class='headline'>{}</p>", " ".join(outcomes.answer(earlier)))
    add(main, "<p class='{}'>{}</p>", "headline" if test is None else "beside", headline(facts))
    judged = judgements(facts, before, None if test is None else CONCERNING[test])
    if words := warning(judged):
        stops = any([one.verdict is STOP for one in judged])
        add(main, "<p class='{}'>{}</p>", "warning" if stops else "warning look", words)
    if facts.measures:
        usual_pace = report.outcomes is None or report.outcomes.usual_pace
        bands = {name: band for name, band in report.bands.items() if usual_pace or not band.is_mean}
        key_figures(section(main, "figures", "Figures"), facts, bands)
    if judged:
        quality_box(section(main, "quality", f"Quality: {overall(judged)}"), judged)
    if len(report.track) >= 2 or report.plan is not None:
        _ways(section(main, "track-part", "Where the wearer went"), report)
    has_strides = any([cycles.count for cycles in walk.cycles.values()])
    has_page = has_strides and report.before is None and test is None
    if test is None:
        _course(main, report, facts)
    details = add(main, "<div class='{}'/>", "second-page" if has_page else "")
    if report.before is not None and before is not None:
        results = [one.result for one in (earlier, outcomes) if one is not None]
        rows = [one for one in results if isinstance(one, OutcomeRow)]
        comparison(details, report.before, report, facts, before, rows)
    if outcomes is not None:
        clinical_sections(details, outcomes)
    if test is not None:
        _course(details, report, facts)
    if has_strides:
        _gait(section(details, "gait", "Gait"), report, facts, figures=test is None)
    if test is None and any([sole.samples for sole in walk.soles.values()]):
        figures = add(section(details, "pressure", "Pressure"), "<div class='figures soles'/>")
        pressure_figures(figures, walk.soles)
    if walk.links:
        _health(section(details, "health", "Sensors and links"), report)
    if facts.means:
        parent = section(details, "definitions", "Definitions and sources")
        definitions(parent, facts.means, difference=bool(facts.difference_words), brief=test is not None)
    add_making(section(details, "making", "How this report was made"), _making(report))
    keep_units(html)
    return html


def _outcomes_of(report: ReportContent | None) -> ClinicalResults | None:
    """Return the outcomes that were requested of a walk; None without any."""
    return None if report is None or report.outcomes is None else report.outcomes.results(report.walk)


def _ways(parent: Element, report: ReportContent) -> None:
    """Add plan or track over the whole width."""
    figures = add(parent, "<div class='ways'/>")
    if plan_figure(figures, report):
        return
    if report.plan is not None:
        paragraph(figures, NO_PLACE)
    if not track_figure(figures, report):
        paragraph(figures, NO_TRACK)


def _gait(parent: Element, report: ReportContent, facts: Facts, *, figures: bool) -> None:
    for means in facts.means:
        gait_table(parent, means, report.walk.newest_cycles, brief=not figures)
    if figures:
        drawn = add(parent, "<div class='figures'/>")
        stride_figures(drawn, [one for cycles in report.walk.cycles.values() for one in cycles], report.clock)


def _course(parent: Element, report: ReportContent, facts: Facts) -> None:
    """Add the course of the recording: its sentences, and a drawing of the activities unless there was a test."""
    walk, clock = report.walk, report.clock
    if walk.event_span is None:
        return
    figures = add(section(parent, "course", "Course of the recording"), "<div class='figures'/>")
    sentences(figures, overview(walk, facts.duration, clock.end))
    if report.outcomes is None or report.outcomes.test is None:
        activity_figure(figures, walk.timeline.spans(clock.end), clock)
    if walk.placed.count:
        track_figure(figures, report, wide=False)
    space_figure(figures, report.track)


def _health(parent: Element, report: ReportContent) -> None:
    walk = report.walk
    table(parent, "From each sensor", LINK_HEADER, link_rows(walk), "numbers links")
    found = {title: whole_sentences(texts(walk, *concerns)) for title, concerns in FOUND.items()}
    if not any(list(found.values())[:-1]):
        paragraph(parent, "Nothing was wrong with the sensors and their links.")
    for title, words in found.items():
        if words:
            add(parent, "<h3>{}</h3>", title)
            sentences(parent, words)


def _making(report: ReportContent) -> list[tuple[str, str]]:
    clock = report.clock
    times = f"{clock.start:.1f} to {clock.end:.1f} s of its own clock" if report.walk.event_span else ""
    return [
        ("Recording", ", ".join(filter(None, [report.source, times]))),
        ("Start", report.when),
        ("Sensors", sensors(report.walk)),
        *making_facts(report.recipe, report.version, report.made_by),
    ]

"""Puts a report together: what somebody with ten seconds reads, then details, definitions and how it was made."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from ..content import ReportContent
from ..figures.activity import activity_figure
from ..figures.cycle import cycle_figure
from ..figures.pressure import pressure_figures
from ..figures.space import space_figure
from ..figures.stride import stride_figures
from ..figures.track import height_figure, plan_figure, track_figure
from ..markup import add, section, sentences, skeleton, table, whole_sentences
from ..words import faults, link_rows, overview, sensors
from .comparison import comparison
from .facts import facts_of
from .gait_table import NO_STEADY, definitions, gait_tables
from .heading import add_heading, add_making, title_of
from .headline import headline, warning
from .key_figures import key_figures
from .quality import QualityVerdict, overall, quality_box

NO_PLACE = "Where on the floor plan the wearer was is not known."
NO_TRACK = "There is no track: no foot with a motion sensor took two strides."


def page_of(report: ReportContent) -> Element:
    """Return the page of a report as an <html> element."""
    facts = facts_of(report)
    title = title_of(report.details, report.when, facts.kind)
    html, main = skeleton(title)
    add_heading(main, title, report.details, report.when)
    add(main, "p", headline(facts.walk), class_="headline")
    if words := warning(facts.judgements):
        stops = any(one.verdict is QualityVerdict.STOP for one in facts.judgements)
        add(main, "p", words, class_="warning" if stops else "warning look")
    if facts.measures:
        parent = section(main, "figures", "Figures")
        key_figures(parent, facts.measures, report.bands, facts.difference_words)
    if facts.judgements:
        parent = section(main, "quality", f"Quality: {overall(facts.judgements)}")
        quality_box(parent, facts.judgements)
    _ways(main, report)
    if facts.walk.has_data:
        _course(main, report)
    has_strides = any(cycles.count for cycles in report.walk.cycles.values())
    details = add(main, "div")
    if has_strides and report.before is None:
        details.set("class", "second-page")
    if report.before is not None:
        comparison(details, report.before, report, facts)
    if report.outcomes is not None:
        from .clinical import clinical_sections

        clinical_sections(details, report.outcomes, report.outcomes.results(report.walk))
    if has_strides:
        _gait(details, report)
    if any(sole.samples for sole in report.walk.soles.values()):
        parent = section(details, "pressure", "Pressure")
        pressure_figures(add(parent, "div", class_="figures thirds"), report.walk.soles)
    _health(details, report)
    if report.walk.gait.of(False) is not None or report.walk.gait.of(True) is not None:
        parent = section(details, "definitions", "Definitions and sources")
        definitions(parent, report.walk.gait, difference=bool(facts.difference_words))
    parent = section(details, "making", "How this report was made")
    add_making(parent, _making(report))
    return html


def _ways(main: Element, report: ReportContent) -> None:
    """Add the section with plan, track and heights, over the whole width."""
    track = report.track
    places = list(report.walk.placed)
    if len(track) < 2 and report.plan is None:
        return
    parent = section(main, "track-part", "Where the wearer went")
    figures = add(parent, "div", class_="ways")
    has_plan = report.plan is not None and plan_figure(figures, report.plan, places)
    if report.plan is not None and not has_plan:
        add(figures, "p", NO_PLACE)
    if not has_plan and not track_figure(figures, track, report.foot_tracks, report.clock):
        add(figures, "p", NO_TRACK)


def _gait(parent: Element, report: ReportContent) -> None:
    parent = section(parent, "gait", "Gait")
    if not gait_tables(parent, report.walk.gait):
        add(parent, "p", NO_STEADY)
    figures = add(parent, "div", class_="figures")
    for running in (False, True):
        parameters = report.walk.gait.of(running)
        if parameters is not None:
            cycle_figure(figures, parameters)
    stride_figures(figures, {foot: list(cycles) for foot, cycles in report.walk.cycles.items()}, report.clock)


def _course(parent: Element, report: ReportContent) -> None:
    """Add the course of the recording: its sentences, and the activities."""
    parent = section(parent, "course", "Course of the recording")
    counts = {foot: cycles.count for foot, cycles in report.walk.cycles.items()}
    figures = add(parent, "div", class_="figures")
    sentences(figures, overview(report.walk, report.clock, counts))
    activity_figure(figures, report.walk.timeline.spans(report.clock.end), report.clock)
    track = report.track
    if report.walk.placed.count:
        track_figure(figures, track, report.foot_tracks, report.clock, wide=False)
    space_figure(figures, track)
    height_figure(figures, {foot: list(positions) for foot, positions in report.walk.standing.items()}, report.clock)


def _health(parent: Element, report: ReportContent) -> None:
    walk = report.walk
    header, *rows = link_rows(walk)
    if not rows:
        return
    parent = section(parent, "health", "Sensors and links")
    table(parent, "From each sensor", header, rows, "numbers links")
    found = {"Cannot be right": whole_sentences(walk.defects), "Missing or wrong": faults(walk)}
    if not any(found.values()):
        add(parent, "p", "Nothing was wrong with the sensors and their links.")
    for title, texts in {**found, "Done without": whole_sentences(walk.limitations)}.items():
        if texts:
            add(parent, "h3", title)
            sentences(parent, texts)


def _making(report: ReportContent) -> list[tuple[str, str]]:
    clock = report.clock
    times = f"{clock.start:.1f} to {clock.end:.1f} s of its own clock" if report.walk.event_span else ""
    return [
        ("Recording", ", ".join([words for words in (report.source, times) if words])),
        ("Start", report.when),
        ("Sensors", sensors(report.walk)),
        ("Recipe", report.recipe),
        ("Made by", f"solepath {report.version}".rstrip()),
    ]

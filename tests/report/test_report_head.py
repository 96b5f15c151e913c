"""Tests what the first page of a report says: title, sentence, large figures, bands, quality, and the comparison."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import pytest
from attrs import evolve
from pages import Node, parse_page
from quoted import PAGES
from reported_walks import ROUTES, events_of, report_of
from walks import of, run_session, samples

from solepath import Defect, DefectFound, Site
from solepath.events import Event, GaitCycleMeasured
from solepath.show.outcomes.references import Person, Sex
from solepath.show.report import Report
from solepath.show.report.bands import Band, BandError, mean_bands, read_bands
from solepath.show.report.sections.facts import facts_of
from solepath.types import Foot


def shown(report: Report) -> Node:
    return parse_page(report.text())


def sentence_of(events: Sequence[Event]) -> str:
    return shown(report_of(events)).named("headline").text


def cards(page: Node) -> dict[str, str]:
    """Return the value of each large figure, with its unit, by its label."""
    found = [one for one in page.all("div") if one.attributes.get("class") == "card"]
    return {one.first("h3").text: one.named("value").text for one in found}


def test_the_first_sentence_has_distance_time_speed_and_cadence() -> None:
    facts = facts_of(report_of(events_of("walk")))
    walk = facts.bouts[False]
    assert walk.distance == pytest.approx(40.0, abs=1.0)
    assert walk.duration == pytest.approx(40.0 / 1.3, abs=2.0)
    sentence = sentence_of(events_of("walk"))
    speed, cadence = [measure.text for measure in facts.measures[:2]]
    assert sentence.startswith(
        f"Walked {walk.distance:.0f} m in {walk.duration:.0f} s, in steady strides at {speed} m/s"
    )
    assert sentence.endswith(f" and {cadence} steps a minute.")


@pytest.mark.parametrize("silent", [*Foot])
def test_the_distance_is_that_of_the_other_foot_while_one_sends_nothing(silent: Foot) -> None:
    fed = [one for one in samples(ROUTES["walk"], cells=0, rate=100.0) if one.site.foot is not silent or one.t < 15.0]
    sentence = sentence_of(run_session(fed, poses=True, pressures=True))
    assert float(sentence.removeprefix("Walked ").partition(" m in")[0]) == pytest.approx(40.0, abs=1.5)


def with_factor(name: str, factor: float) -> list[Event]:
    """Return the gait cycles of a walk with a parameter of the right foot that is `factor` times as large."""
    changed: list[Event] = []
    for one in of(GaitCycleMeasured, events_of("walk")):
        value = getattr(one, name)
        larger = one.foot is Foot.RIGHT and value is not None
        changed.append(evolve(one, **{name: factor * value}) if larger else one)
    return changed


def test_a_difference_of_the_feet_is_named_above_its_own_error_only() -> None:
    assert "left" not in sentence_of(with_factor("swing_time", 1.0))
    assert "left" not in sentence_of(with_factor("swing_time", 1.01)), "4 ms are less than a heel-strike's scatter"
    assert "the right foot swings 12 % longer than the left one" in sentence_of(with_factor("swing_time", 1.12))
    assert "the left foot swings" in sentence_of(with_factor("swing_time", 0.88))
    assert "stride length: check the sensors" in sentence_of(with_factor("stride_length", 1.06))
    assert "left" not in sentence_of(with_factor("stride_length", 1.01))


def test_bands_are_drawn_and_their_source_is_named(tmp_path: Path) -> None:
    path = tmp_path / "bands.json"
    path.write_text(json.dumps({"source": "Our laboratory, 2025", "bands": {"speed_m_per_s": [1.1, 1.2]}}))
    page = shown(report_of(events_of("walk"), bands=read_bands(path)))
    assert "above the band; reference 1.1 to 1.2 m/s" in page.named("card").first("desc").text
    assert "Reference of speed: Our laboratory, 2025" in page.text
    path = tmp_path / "bands.csv"
    path.write_text("measure,low,high,source\ncadence_steps_per_min,90,130,A book\n")
    assert read_bands(path) == {"cadence_steps_per_min": Band(90.0, 130.0, "A book")}
    (mean,) = mean_bands(Person(72.0, Sex.FEMALE)).values()
    assert mean.is_mean and mean.low == mean.high == 1.13 and "Bohannon and Andrews 2011" in mean.source
    assert mean_bands(None) == {} == mean_bands(Person(10.0, Sex.MALE))


@pytest.mark.parametrize(
    ("name", "text", "fault"),
    [
        ("a.json", "[]", "no \"bands\""),
        ("a.json", '{"source": "x", "bands": {"pace": [1, 2]}}', "no measure"),
        ("a.json", '{"source": "x", "bands": {"speed_m_per_s": [2, 1]}}', "low, then high"),
        ("a.json", '{"source": "x", "bands": {"speed_m_per_s": [1, NaN]}}', "low, then high"),
        ("a.json", "[" * 20000, "is no file of bands"),
        ("a.csv", "speed,1,2\n", "first line"),
        ("a.csv", "measure,low,high,source\nspeed_m_per_s,one,2,x\n", "no numbers"),
    ],
)  # fmt: skip
def test_a_wrong_file_of_bands_gets_one_line(tmp_path: Path, name: str, text: str, fault: str) -> None:
    path = tmp_path / name
    path.write_text(text)
    with pytest.raises(BandError, match=fault) as caught:
        read_bands(path)
    assert name in str(caught.value) and "\n" not in str(caught.value)


def quality(page: Node) -> dict[str, tuple[str, str]]:
    """Return verdict and words of each part of the quality."""
    rows = page.named("quality").children
    return {one.first("span").text: (one.first("strong").text, one.first("dd").text) for one in rows}


def test_the_quality_is_good_look_at_or_do_not_use() -> None:
    good = quality(shown(report_of(events_of("walk"))))
    assert {part: verdict for part, (verdict, _) in good.items()} == {
        "gait cycles": "good", "samples": "good", "strides": "good", "clocks": "good", "plausibility": "good",
        "calibration": "note", "accuracy": "note",
    }  # fmt: skip
    report = report_of(events_of("walk"), calibrated=True)
    clocks = DefectFound(
        t=9.0, known_at=9.0, site=Site.RIGHT_FOOT, defect=Defect.CLOCKS, what="its times are late", spoils=False
    )
    report.take(None, [clocks])
    figures = cards(shown(report))
    assert "Double support" not in figures and "Stance" in figures
    axes = DefectFound(t=9.0, known_at=9.0, site=Site.LEFT_FOOT, defect=Defect.AXES, what="mirrored axes")
    report.take(None, [axes])
    page = shown(report)
    bad = quality(page)
    assert bad["clocks"] == ("look at", "Right foot: its times are late.")
    assert bad["plausibility"][0] == "do not use" and bad["calibration"][0] == "good"
    assert "Quality: do not use before it is checked" in [one.text for one in page.all("h2")]


def test_two_walks_are_compared_with_signs_and_with_the_smallest_change_that_matters() -> None:
    before = report_of(events_of("slow"), when="2026-10-01 08:00 UTC")
    page = shown(report_of(events_of("walk"), before=before))
    rows = {row.first("th").text: [cell.text for cell in row.all("td")] for row in page.named("comparison").all("tr")}
    old, new, change, smallest, words = rows["speed, m/s"]
    assert float(new) - float(old) == pytest.approx(float(change.split()[0]), abs=0.011) and change.startswith("+0.")
    assert words == "yes" and 0.0 < float(smallest) < float(change.split()[0])
    assert rows["asymmetry, %"][-2:] == ["-", "-"]
    assert "Before (walk.jsonl, 1 October 2026, 08:00 UTC): Walked 25 m" in page.text
    assert {"Track before", "Track after"} <= {one.first("strong").text for one in page.all("figcaption")}


AGREEMENT = {
    "motion sensors alone": (("ipol_10m_uturn", ""), ("tripod_treadmill", "stride length")),
    "cells alone": (("gaitpdb_vgrf", ""),),
    "motion sensors and cells": (("moticon_pressed", ""),),
}
"""Rows of the table of agreement, of all parameters or of one, that belong to each kind of sensors."""


def report_with(sensors: str, events: Sequence[Event] | None = None, **more: object) -> Report:
    report = report_of(events_of("walk") if events is None else events, **more)
    for link in report.walk.links.values():
        link.has_motion, link.has_pressure = sensors != "cells alone", "cells" in sensors
    return report


@pytest.mark.parametrize("sensors", AGREEMENT)
def test_the_accuracy_beside_the_quality_is_that_of_these_sensors_in_the_table_of_its_command(sensors: str) -> None:
    rows = [[cell.strip() for cell in line.strip("| ").split("|")] for line in PAGES["docs/accuracy.md"].splitlines()]
    table = [row for row in rows if len(row) == 7 and row[2].isdecimal()]
    words = quality(shown(report_with(sensors)))["accuracy"][1]
    known = []
    for data, only in AGREEMENT[sensors]:
        for _, label, _, _, bias, limits, icc in [row for row in table if row[0] == f"`{data}`"]:
            if only in label and (only or (data, label) != ("tripod_treadmill", "stride length")):
                ends = limits.removesuffix(bias.partition(" ")[2]).strip()
                known.append(
                    f"{label.removesuffix(' time') if 'stride' not in label else label} {bias} ({ends}; {icc})"
                )
    assert len(known) >= 4
    for one in known:
        assert one in words
    assert words.count(";") == len(known) + (sensors == "motion sensors alone") + 1


def test_no_accuracy_is_said_of_what_was_not_measured() -> None:
    report = report_of(events_of("walk"))
    report.recipe = "zupt"
    assert quality(shown(report))["accuracy"] == ("note", "Not measured for this recipe.")
    assert "accuracy" not in quality(shown(report_of(events_of("run"))))
    unknown = [
        evolve(one, stride_length=None, speed=None) if isinstance(one, GaitCycleMeasured) else one
        for one in events_of("walk")
    ]
    assert "stride length" not in quality(shown(report_with("motion sensors and cells", unknown)))["accuracy"][1]


def test_a_walk_before_that_was_measured_badly_is_a_point_of_the_quality() -> None:
    before = report_of(events_of("slow"))
    assert quality(shown(report_of(events_of("walk"), before=before)))["walk before"][0] == "good"
    for foot in before.walk.feet.values():
        foot.degraded = foot.strides // 4
    page = shown(report_of(events_of("walk"), before=before))
    assert quality(page)["walk before"][0] == "look at"
    assert page.named("warning").text == "Check before use: the walk before (degraded strides)."

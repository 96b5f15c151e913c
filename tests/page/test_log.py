"""Tests the log of the page: sentences about feet, sensors and places, each reported once."""

from __future__ import annotations

from page_events import foot_moved
from shown import shown

from solepath import BatteryLevel, Connected, Foot, FootResumed, FootSilent, Site, StreamStale
from solepath.show.page.scene.log import sentence


def test_a_low_battery_is_reported_once() -> None:
    levels = [BatteryLevel(t=t, known_at=t, site=Site.LEFT_FOOT, level=0.2 - 0.01 * t) for t in (1.0, 6.0, 7.0, 8.0)]
    assert [line[2] for line in shown(levels).log.lines.items] == ["left foot: the battery is at 14 %"]


def test_a_silence_that_the_link_reported_is_not_reported_again_for_the_foot() -> None:
    stale = StreamStale(t=1.0, known_at=2.0, site=Site.LEFT_FOOT, silent_for=1.0)
    silent = FootSilent(t=1.0, known_at=2.5, foot=Foot.LEFT, silent_for=1.5)
    resumed = FootResumed(t=3.0, known_at=3.0, foot=Foot.LEFT, silent_for=2.0)
    assert len(shown([foot_moved(0.5), stale, silent]).log.lines.items) == 1
    assert len(shown([foot_moved(1.9), foot_moved(2.5), silent, resumed]).log.lines.items) == 2


def test_a_device_name_cannot_break_a_line() -> None:
    named = Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device="", name="a\nb\x1b[2J" + 999 * "x", signal=None)
    _, text = sentence(named) or ("", "")
    assert "\n" not in text and "\x1b" not in text and len(text) <= 300

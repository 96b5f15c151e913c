"""Tests the log of the page: sentences about feet, sensors and places, each reported once."""

from __future__ import annotations

from shown import shown

from solepath import BatteryLevel, Connected, Site
from solepath.show.page.scene.log import sentence


def test_a_low_battery_is_reported_once() -> None:
    levels = [BatteryLevel(t=t, known_at=t, site=Site.LEFT_FOOT, level=0.2 - 0.01 * t) for t in (1.0, 6.0, 7.0, 8.0)]
    assert [line[2] for line in shown(levels).log.lines.items] == ["left foot: the battery is at 14 %"]


def test_a_device_name_cannot_break_a_line() -> None:
    named = Connected(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, device="", name="a\nb\x1b[2J" + 999 * "x", signal=None)
    _, text = sentence(named) or ("", "")
    assert "\n" not in text and "\x1b" not in text and len(text) <= 300

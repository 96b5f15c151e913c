"""The programs on feedback of docs/app.md run unchanged: the loop, a rule of one's own, and a snapshot of it."""

from __future__ import annotations

from quoted import run_page

from solepath import Foot
from solepath.emulate import Route, Walker


def test_the_programs_of_the_page_print_what_the_page_says() -> None:
    (loop, own, saved), names = run_page("docs/app.md", programs=slice(7, 10))
    walker = Walker(Route().stand(2).walk(8, speed=0.8).stop(2))
    contacts = walker.truth().feet[Foot.RIGHT].heel_strikes
    assert len(contacts) - 2 <= loop.count("EveryHeelStrike, right foot") <= len(contacts)
    assert "StanceLonger, left foot, 0.7" in loop
    assert own.count("lifted by 0.") == 1 and saved == ""
    assert [type(rule).__name__ for rule in names["feedback"].rules] == ["LowLift"]

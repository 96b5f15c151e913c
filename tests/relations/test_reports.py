"""A person reports where they are: by a call or by a packet of the receiver, and in a mirror."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pytest
from attrs import evolve
from transforms import CALIBRATION, Change, differences, in_order, worn
from walks import of, often

from solepath import Foot, Packet, PositionReported, Sample, Session, Site, TrackRevised, recipes
from solepath.events import StrideTaken
from solepath.types import SITE_OF_FOOT
from solepath.wire.receiver import PositionFrame, build_position  # internal: the packets of an app in another language

MIRRORED = Change(mirrored=True)
REPORTS = (
    (3.6, PositionFrame((0.4, 0.1), 0.5)),
    (3.8, PositionFrame(None, 1.0, "the gate")),
    (4.5, PositionFrame((3.3, 0.3), 0.3)),
    (6.0, PositionFrame(None, 5.0, "the gate")),
    (6.5, PositionFrame(None, 20.0)),
    (7.0, PositionFrame((90.0, -40.0), 0.5)),
)
"""What a person reports at which times, s: positions, a place with a name, the start, and a place that cannot be."""


def mirrored(frame: PositionFrame) -> PositionFrame:
    return PositionFrame(frame.position and MIRRORED.vector(frame.position), frame.sigma, frame.place)


def reporting(
    recipe: str, samples: Iterable[Sample], site: Site | None, change: Any = lambda frame: frame
) -> list[Any]:
    """Return the events of a walk with reports, by packets of a site or else by calls."""
    session, events, waiting = Session(recipes.by_name(recipe), calibration=CALIBRATION, poses=True), [], [*REPORTS]
    for sample in sorted(samples, key=lambda sample: sample.t):
        if waiting and sample.t >= waiting[0][0]:
            _, frame = waiting.pop(0)
            frame = change(frame)
            assert session.now is not None
            if site is not None:
                events += session.feed(Packet(session.now, site, "receiver/position", build_position(frame)))
            else:
                events += session.here(frame.place or frame.position, frame.sigma)
        events += session.feed(sample)
    assert waiting == []
    return events + session.finish()


@pytest.mark.parametrize("recipe", often(recipes.NAMES))
def test_reports_of_a_mirrored_walk_give_the_mirrored_events(recipe: str) -> None:
    walk = reporting(recipe, worn(), Site.LEFT_FOOT)
    found = reporting(recipe, map(MIRRORED.sample, worn()), Site.RIGHT_FOOT, mirrored)
    assert len(of(PositionReported, walk)) == len(REPORTS)
    assert len(of(TrackRevised, walk)) == (4 if recipe in ("default", "footstep-tracker") else 0)
    within = {"": 1e-9, "compensation": 0.03, "legs": 2e-3}
    if recipe.endswith("-printed"):  # as in test_frames
        within |= {"position": 2.0, "WearerMoved.covariance": 0.2}
    if recipe == "footstep-tracker-printed":  # the right foot says where the wearer is, until the one-metre rule
        walk, found = of(StrideTaken, walk), of(StrideTaken, found)
    assert differences(in_order(map(MIRRORED.event, walk)), in_order(found), within) == []


@pytest.mark.parametrize("feet", [(Foot.LEFT,), (Foot.RIGHT,), tuple(Foot)])
def test_a_report_by_a_call_is_that_by_a_packet_of_the_first_foot(feet: tuple[Foot, ...]) -> None:
    walk = [evolve(sample, mag=None) for sample in worn() if sample.site.foot in feet]
    by_call = reporting("default", walk, None)
    assert by_call == reporting("default", walk, SITE_OF_FOOT[feet[0]])
    assert {event.site for event in of(PositionReported, by_call)} == {SITE_OF_FOOT[feet[0]]}


def test_before_any_foot_has_sent_a_report_is_of_the_left_one() -> None:
    session = Session()
    session.advance(1.0)
    (reported,) = session.here((1.0, 2.0))
    assert isinstance(reported, PositionReported) and reported.site is Site.LEFT_FOOT

"""A sensor that came loose in mid-walk is noticed, and one that is fixed is not."""

from __future__ import annotations

from functools import cache
from itertools import product
from math import pi

import pytest
from disturbed import loose

from solepath import Session
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import SampledWalk, sampled
from solepath.events import Defect, DefectFound, Event, StrideTaken
from solepath.types import OTHER, Foot, Sample

ROUTE = Route().stand(3).walk(60, 1.3).turn(pi, 0.6).walk(60, 1.3).stop(2)
CAME_LOOSE = 40.0


@cache
def walk(seed: int) -> SampledWalk:
    return sampled(ROUTE, seed=seed)


def found(samples: tuple[Sample, ...], session: Session | None = None) -> tuple[list[DefectFound], list[Event]]:
    session = session or Session()
    events: list[Event] = [event for sample in samples for event in session.feed(sample)]
    return [event for event in events if isinstance(event, DefectFound) and event.defect is Defect.LOOSE], events


@cache
def packed_before(seed: int) -> bytes:
    """Return the session of a walk before a sensor comes loose, packed."""
    session = Session()
    assert found(tuple(sample for sample in walk(seed).samples if sample.t < CAME_LOOSE), session)[0] == []
    return session.pack()


def continued(seed: int, samples: tuple[Sample, ...]) -> tuple[list[DefectFound], list[Event]]:
    """Return what is found in these samples of a walk from the time on at which a sensor comes loose."""
    return found(tuple(sample for sample in samples if sample.t >= CAME_LOOSE), Session.unpack(packed_before(seed)))


@pytest.mark.long
def test_a_sensor_that_swings_is_noticed_and_its_strides_are_degraded() -> None:
    """Within a minute in five of six walks; the stances of the sixth one are quiet moments of the swinging sensor."""
    noticed = 0
    for seed, foot in product((1, 2, 3), Foot):
        reports, events = continued(seed, loose(walk(seed), foot, CAME_LOOSE, 0.6, seed))
        for one in reports:
            noticed += 1
            assert one.site.foot is foot and one.t > CAME_LOOSE and "came loose" in one.what
            later = [event for event in events if isinstance(event, StrideTaken) and event.t > one.t]
            assert all(event.degraded for event in later if event.foot is foot)
            assert not all(event.degraded for event in later if event.foot is OTHER[foot])
    assert noticed >= 5


@pytest.mark.soak
def test_a_fixed_sensor_has_not_come_loose() -> None:
    assert continued(1, walk(1).samples)[0] == []


@pytest.mark.soak
def test_a_gap_in_the_samples_is_no_loose_sensor() -> None:
    samples = sampled(ROUTE.turn(pi, 0.6).walk(60, 1.3).stop(2), seed=2).samples
    kept = [s for s in samples if s.site.foot is not Foot.LEFT or not 70.0 <= s.t < 70.3]
    assert found(tuple(kept))[0] == []


@pytest.mark.soak
def test_feet_that_are_absent_in_turn_are_not_loose() -> None:
    """Each foot is silent for 15 s of every 30 s."""
    kept = [s for s in walk(1).samples if (s.t % 30.0 < 15.0) is (s.site.foot is Foot.LEFT) or s.t < 35.0]
    assert found(tuple(kept))[0] == []

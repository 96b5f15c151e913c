"""A person says where they are: the track is corrected and revised, or the place is refused."""

from __future__ import annotations

import numpy as np
import pytest
from lake import back_time, error, fed, loop, middle, session_back
from walks import samples

from solepath import Foot, Packet, Session, Site
from solepath.body.fuse.walked_path import MOST_NODES
from solepath.emulate import Route, Walker
from solepath.emulate.sensors.parts import LSM6DSOX
from solepath.events import PositionRejected, PositionReported, StrideTaken, TrackRevised
from solepath.wire.receiver import PositionFrame, build_position


@pytest.mark.soak
def test_a_return_corrects_place_and_heading_and_the_strides_after_it() -> None:
    walk, back = loop(), back_time(loop())
    corrected, plain = session_back(), session_back()
    before = error(walk, plain)
    assert corrected.position is not None
    sigma = corrected.position.heading_sigma
    was = corrected.position.position
    _, revised = corrected.here(middle(walk, back), sigma=0.3)
    assert isinstance(revised, TrackRevised)
    assert corrected.position is not None
    moved = [after - before for after, before in zip(corrected.position.position[:2], was[:2], strict=True)]
    assert revised.by == pytest.approx(moved)
    assert before > 1.0 and error(walk, corrected) < 0.3 * before
    assert corrected.position is not None and corrected.position.heading_sigma is not None and sigma is not None
    assert corrected.position.heading_sigma < 0.7 * sigma
    end = walk.truth.duration
    fed(walk, end, corrected, back)
    fed(walk, end, plain, back)
    assert error(walk, corrected) < 0.5 * error(walk, plain)


@pytest.mark.soak
def test_the_path_so_far_is_revised_towards_the_truth() -> None:
    walk, back = loop(), back_time(loop())
    session = Session()
    was: list[tuple[float, float, float]] = []
    for sample in walk.samples:
        if sample.t >= back:
            break
        if any(isinstance(event, StrideTaken) for event in session.feed(sample)) and session.position is not None:
            was.append((session.position.t, *session.position.position[:2]))
    revised = session.here(middle(walk, back), sigma=0.3)[1]
    assert isinstance(revised, TrackRevised) and 10 < len(revised.nodes) <= MOST_NODES + 1
    assert [node.t for node in revised.nodes] == sorted(node.t for node in revised.nodes)

    def rms(path: list[tuple[float, float, float]]) -> float:
        """Return the distance from the truth after the best turn about the start, since the first heading is off."""
        found = np.array([complex(x, y) for _, x, y in path])
        true = np.array([complex(*middle(walk, t)) for t, _, _ in path])
        turn = np.sum(true * found.conj())
        return float(np.sqrt(np.mean(np.abs(found * turn / abs(turn) - true) ** 2)))

    late = [(node.t, node.x, node.y) for node in revised.nodes]
    assert rms(late) < 0.6 * rms(was)


@pytest.mark.parametrize("angle", [0.0, 2.0])
@pytest.mark.soak
def test_a_place_that_is_20_m_off_is_rejected_with_a_reason_and_changes_nothing(angle: float) -> None:
    walk, back = loop(), back_time(loop())
    session = session_back()
    saved = session.position
    x, y = middle(walk, back)
    reported, rejected = session.here((x + 20.0 * np.cos(angle), y + 20.0 * np.sin(angle)), sigma=0.5)
    assert isinstance(reported, PositionReported) and isinstance(rejected, PositionRejected)
    assert 12.0 < rejected.distance < 28.0 and "the track stays as it is" in rejected.what
    assert session.position == saved


@pytest.mark.long
def test_a_packet_of_the_receiver_does_the_same_and_a_saved_session_too() -> None:
    walk = loop()
    one, other = fed(walk, 60.0), fed(walk, 60.0)
    again = Session.unpack(one.pack())
    assert one.now is not None
    events = one.here(sigma=50.0)
    data = build_position(PositionFrame(None, 50.0))
    assert other.feed(Packet(one.now, Site.LEFT_FOOT, "receiver/position", data)) == events == again.here(sigma=50.0)
    assert isinstance(events[1], TrackRevised)
    assert fed(walk, 90.0, one, 60.0).position == fed(walk, 90.0, again, 60.0).position


def test_before_the_first_stride_a_place_has_no_effect_and_impossible_ones_are_errors() -> None:
    session = Session()
    with pytest.raises(ValueError, match="before the first sample"):
        session.here()
    with pytest.raises(ValueError, match="needs a name"):
        session.here("")
    session.feed(samples()[:200])
    assert [type(event) for event in session.here()] == [PositionReported]
    for position, sigma in (((float("nan"), 0.0), 1.0), ((0.0, 2e6), 1.0), (None, 0.0), (None, -1.0)):
        with pytest.raises((ValueError, TypeError), match="position"):
            session.here(position, sigma)
    session.finish()
    with pytest.raises(ValueError, match="finished"):
        session.here()


def test_one_metre_after_a_report_far_from_the_start_another_one_that_is_off_by_more_is_rejected() -> None:
    walker = Walker(Route().stand(2).walk(26.0, 1.3).stop(1), seed=8)
    worn = sorted((one for foot in Foot for one in walker.samples(foot, 100.0, LSM6DSOX)), key=lambda one: one.t)
    session = Session()
    session.feed([one for one in worn if one.t < 18.0])
    assert session.position is not None and session.position.position[0] > 15.0
    x, y, _ = session.position.position
    assert isinstance(session.here((x, y + 0.2), sigma=0.2)[1], TrackRevised)
    session.feed([one for one in worn if 18.0 <= one.t < 19.0])
    x, y, _ = session.position.position
    assert isinstance(session.here((x, y + 1.5), sigma=0.2)[1], PositionRejected)

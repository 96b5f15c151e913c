"""A person says where they are: the track is corrected and revised, or the place is refused."""

from __future__ import annotations

from functools import cache
from math import hypot, pi

import numpy as np
import pytest

from solepath import Packet, Session, Site, recipes
from solepath.body.aiding.path_revision import revise_path
from solepath.body.aiding.walked_path import MOST_NODES, WalkedPath
from solepath.body.fuse.common_error import CommonError
from solepath.emulate import Route, sampled
from solepath.emulate.walk import SampledWalk
from solepath.events import PositionRejected, PositionReported, StrideTaken, TrackNode, TrackRevised
from solepath.lab.emulated.heading_walks import insoles_of
from solepath.types import Foot
from solepath.wire.receiver import PositionFrame, build_position


@cache
def loop() -> SampledWalk:
    """Return a walk of 180 m round a lake, back to where it began, and 40 m on, by feet that drift."""
    route = Route(speed=1.4).stand(2.0).walk(15.0).turn(pi, 24.0).walk(15.0).turn(pi, 24.0)
    return sampled(route.walk(40.0).stop(2.0), insoles=insoles_of(9), seed=9)


def fed(walk: SampledWalk, until: float, session: Session | None = None, since: float = 0.0) -> Session:
    session = Session() if session is None else session
    session.feed([sample for sample in walk.samples if since <= sample.t < until])
    return session


def middle(walk: SampledWalk, t: float) -> tuple[float, float]:
    """Return where the wearer truly is, in the session's world frame."""
    places = [walk.truth.pose(foot, t).position[0, :2] - walk.truth.pose(foot, 0.0).position[0, :2] for foot in Foot]
    x, y = 0.5 * (places[0] + places[1])
    return float(x), float(y)


def error(walk: SampledWalk, session: Session) -> float:
    assert session.position is not None
    x, y = middle(walk, session.position.t)
    return hypot(session.position.position[0] - x, session.position.position[1] - y)


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


@cache
def back_time(walk: SampledWalk) -> float:
    """Return when the wearer is closest to the start after the loops, s."""
    times = np.arange(0.6 * walk.truth.duration, walk.truth.duration, 0.1)
    return float(times[int(np.argmin([hypot(*middle(walk, float(t))) for t in times]))])


@cache
def packed_back() -> bytes:
    return fed(loop(), back_time(loop())).pack()


def session_back() -> Session:
    """Return the session of a wearer who is back where the walk started."""
    return Session.unpack(packed_back())


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


@pytest.mark.parametrize("angle", [0.0, 2.0, 4.0])
def test_a_place_that_is_20_m_off_is_rejected_with_a_reason_and_changes_nothing(angle: float) -> None:
    walk, back = loop(), back_time(loop())
    session = session_back()
    saved = session.position
    x, y = middle(walk, back)
    reported, rejected = session.here((x + 20.0 * np.cos(angle), y + 20.0 * np.sin(angle)), sigma=0.5)
    assert isinstance(reported, PositionReported) and isinstance(rejected, PositionRejected)
    assert 12.0 < rejected.distance < 28.0 and "the track stays as it is" in rejected.what
    assert session.position == saved


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


@pytest.mark.parametrize("sigma", [1e-30, 1e4])
def test_a_place_that_is_reported_again_and_again_is_used_each_time(sigma: float) -> None:
    session = fed(loop(), 40.0)
    assert session.position is not None
    place = session.position.position[:2]
    for _ in range(30):
        assert isinstance(session.here(place, sigma)[1], TrackRevised)
    xx, xy, _, yy, _, _ = session.position.covariance
    assert xx > 0.0 and yy > 0.0 and xx * yy >= xy * xy


def test_before_the_first_stride_a_place_has_no_effect_and_impossible_ones_are_errors() -> None:
    session = Session()
    with pytest.raises(ValueError, match="has samples"):
        session.here()
    fed(loop(), 1.0, session)
    assert [type(event) for event in session.here()] == [PositionReported]
    for position, sigma in (((float("nan"), 0.0), 1.0), ((0.0, 2e6), 1.0), (None, 0.0), (None, -1.0)):
        with pytest.raises(ValueError, match="position"):
            session.here(position, sigma)


def test_a_recipe_without_that_track_reports_the_place_alone() -> None:
    session = fed(loop(), 20.0, Session(recipes.by_name("shoe-sensing")))
    assert [type(event) for event in session.here()] == [PositionReported]


def test_a_path_keeps_few_nodes_however_long_it_is_and_ends_where_it_was_corrected_to() -> None:
    path = WalkedPath()
    for k in range(20_000):
        path.add_stride(float(k), (0.7 * k, 0.0), 0.7)
    assert 20 <= len(path.nodes) <= MOST_NODES
    error = CommonError()
    nodes = revise_path(path, 20_000.0, (14_000.0, 0.0), (14_000.0, 500.0), (0.01, 1.0), error, True)
    assert nodes[-1] == TrackNode(20_000.0, 14_000.0, 500.0) and nodes[0].y == 0.0
    assert all(0.0 <= node.y <= 520.0 for node in nodes)
    path.add_stride(20_001.0, (14_001.0, 500.0), 400.0)
    later = revise_path(path, 20_002.0, (14_002.0, 500.0), (14_002.0, 501.0), (0.01, 1.0), error, True)
    assert later[0] == nodes[-1], "what a report has settled stays"


@cache
def passing_times() -> tuple[float, float]:
    """Return when the wearer of the loop is 10 m from the start, and when they pass the same place again, s."""
    walk = loop()
    first = next(t for t in np.arange(0.0, 30.0, 0.05) if middle(walk, float(t))[0] > 10.0)
    x, y = middle(walk, float(first))
    times = np.arange(first + 60.0, walk.truth.duration, 0.05)
    again = min(times, key=lambda t: hypot(middle(walk, float(t))[0] - x, middle(walk, float(t))[1] - y))
    return float(first), float(again)


def test_a_place_with_a_name_is_noted_and_corrects_the_track_when_the_wearer_is_there_again() -> None:
    walk, (first, again) = loop(), passing_times()
    session, plain = fed(walk, first), fed(walk, again)
    assert [type(event) for event in session.here("the old gate", 0.2)] == [PositionReported]
    session = Session.unpack(fed(walk, again, session, first).pack())
    gap = hypot(*np.subtract(middle(walk, first), middle(walk, again)))
    assert gap < 0.3, "the wearer passes the same place"
    reported, revised = session.here("the old gate", 0.3)
    assert isinstance(reported, PositionReported) and reported.place == "the old gate"
    assert isinstance(revised, TrackRevised) and error(walk, session) < 0.4 * error(walk, plain)
    end = walk.truth.duration
    fed(walk, end, session, again)
    fed(walk, end, plain, again)
    assert error(walk, session) < 0.6 * error(walk, plain)


def test_a_named_place_where_the_wearer_cannot_be_is_rejected_by_its_name() -> None:
    walk, (first, _) = loop(), passing_times()
    session = fed(walk, first)
    session.here("gate", 0.2)
    fed(walk, first + 25.0, session, first)
    rejected = session.here("gate", 0.2)[1]
    assert isinstance(rejected, PositionRejected) and "where gate was before" in rejected.what


def test_places_are_forgotten_in_the_order_of_their_last_visit() -> None:
    session = fed(loop(), 40.0)
    assert session.now is not None
    for name in "abcdefgh":
        session.here(name)
    assert len(session.here("a")) == 2, "it is noted"
    session.here("i")
    assert len(session.here("a")) == 2 and len(session.here("b")) == 1, "b was visited before all others"


def test_two_rejected_places_that_agree_with_the_way_between_them_are_used() -> None:
    walk, session = loop(), fed(loop(), 60.0)
    off = np.array([30.0, -20.0])

    def report(session: Session, t: float, more: tuple[float, float] = (0.0, 0.0)) -> list[object]:
        x, y = np.array(middle(walk, t)) + off + more
        return [type(event) for event in session.here((float(x), float(y)), 0.5)]

    assert report(session, 60.0) == [PositionReported, PositionRejected]
    assert report(session, 60.0) == [PositionReported, PositionRejected], "on the spot it confirms nothing"
    again = fed(walk, 80.0, Session.unpack(session.pack()), 60.0)
    assert report(again, 80.0, (-14.0, 25.0)) == [PositionReported, PositionRejected], "another place, no confirmation"
    fed(walk, 80.0, session, 60.0)
    assert report(session, 80.0) == [PositionReported, TrackRevised]
    fed(walk, 100.0, session, 80.0)
    assert session.position is not None
    x, y = np.array(middle(walk, 100.0)) + off - session.position.position[:2]
    assert hypot(x, y) < 3.0
    assert report(session, 100.0) == [PositionReported, TrackRevised]


def test_a_place_without_a_name_or_with_too_long_a_one_is_an_error() -> None:
    session = fed(loop(), 5.0)
    for place in ("", "x" * 65):
        with pytest.raises(ValueError):
            session.here(place)
    with pytest.raises(ValueError, match="level"):
        session.here("gate", level="0")

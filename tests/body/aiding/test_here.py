"""A person says where they are: the track is corrected and revised, or the place is refused."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from lake import back_time, error, fed, loop, middle, session_back

from solepath import Packet, Session, Site, recipes
from solepath.body.aiding.path_revision import revise_path
from solepath.body.aiding.walked_path import MOST_NODES, WalkedPath
from solepath.body.fuse.common_error import CommonError
from solepath.events import PositionRejected, PositionReported, StrideTaken, TrackNode, TrackRevised
from solepath.wire.receiver import PositionFrame, build_position


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


def test_a_foot_that_sends_nothing_any_more_does_not_count_for_where_the_wearer_is() -> None:
    session = fed(loop(), 40.0)
    session.feed([sample for sample in loop().samples if 40.0 <= sample.t < 41.5 and sample.site is Site.LEFT_FOOT])
    assert session.position is not None
    revised = session.here(session.position.position[:2], 0.1)[1]
    assert isinstance(revised, TrackRevised) and hypot(*revised.by) < 0.3


def test_a_report_after_the_clock_was_set_names_no_time_of_the_other_one() -> None:
    session = fed(loop(), 60.0)
    assert session.position is not None
    x, y = session.position.position[:2]
    session.here((x, y), 0.3)
    session.restart_clock(5.0)
    rejected = session.here((x + 40.0, y), 0.3)[-1]
    assert isinstance(rejected, PositionRejected) and "s before" not in rejected.what


def test_before_the_first_stride_a_place_has_no_effect_and_impossible_ones_are_errors() -> None:
    session = Session()
    with pytest.raises(ValueError, match="has samples"):
        session.here()
    fed(loop(), 1.0, session)
    assert [type(event) for event in session.here()] == [PositionReported]
    for position, sigma in (((float("nan"), 0.0), 1.0), ((0.0, 2e6), 1.0), (None, 0.0), (None, -1.0)):
        with pytest.raises((ValueError, TypeError), match="position"):
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

"""A person names places, or reports what contradicts the track: what is noted, and what is used."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from lake import back_time, error, fed, loop, middle, off_by, passing_times

from solepath import Session
from solepath.body.aiding.path_revision import estimate
from solepath.body.fuse.both_feet import BothFeet
from solepath.events import PositionRejected, PositionReported, TrackRevised


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


def test_a_right_place_in_between_makes_a_wrong_one_no_likelier() -> None:
    walk, session = loop(), fed(loop(), 60.0)
    assert isinstance(session.here(off_by(session, 40.0, 0.0))[1], PositionRejected)
    fed(walk, 80.0, session, 60.0)
    assert isinstance(session.here(off_by(session, 0.3, 0.0))[1], TrackRevised)
    fed(walk, 100.0, session, 80.0)
    assert isinstance(session.here(off_by(session, 40.0, 0.0))[1], PositionRejected)


def test_places_that_were_named_while_the_track_was_lost_move_with_it() -> None:
    walk, session = loop(), fed(loop(), 60.0)
    session.here(off_by(session, 40.0, 0.0))
    fed(walk, 70.0, session, 60.0)
    session.here("kiosk", 0.3)
    kiosk = session.position
    fed(walk, 80.0, session, 70.0)
    assert isinstance(session.here(off_by(session, 40.0, 0.0))[1], TrackRevised)
    part = next(part for part in session._state.wearer.parts if isinstance(part, BothFeet))
    found = estimate(part.evidence.path.places["kiosk"].first, part.common)
    assert kiosk is not None and hypot(found[0] - kiosk.position[0] - 40.0, found[1] - kiosk.position[1]) < 4.0


def test_a_beacon_that_reports_all_the_time_leaves_the_path_as_fine_as_it_was() -> None:
    walk, session = loop(), fed(loop(), 30.0)
    for _ in range(300):
        session.here(off_by(session, 0.0, 0.0))
        session.here("beacon")
    size = len(session.pack())
    for _ in range(300):
        session.here(off_by(session, 0.0, 0.0))
        session.here("beacon")
    assert abs(len(session.pack()) - size) < 200
    fed(walk, 90.0, session, 30.0)
    revised = session.here(off_by(session, 0.0, 0.0))[1]
    assert isinstance(revised, TrackRevised) and len(revised.nodes) > 10


def test_the_place_where_a_wearer_stands_before_the_first_stride_can_have_a_name() -> None:
    session = fed(loop(), 1.0)
    assert [type(event) for event in session.here("door", 0.2)] == [PositionReported]
    back = fed(loop(), back_time(loop()), session, 1.0)
    assert isinstance(back.here("door", 0.5)[1], TrackRevised)


def test_a_position_is_a_pair_of_numbers_of_any_kind() -> None:
    session = fed(loop(), 20.0)
    assert session.here(np.array([1.0, 2.0]), 50.0)[0] == session.here([1, 2], 50.0)[0]  # type: ignore[arg-type]
    for wrong in (3.0, (1.0,), ("a", "b"), (1.0, 2.0, 3.0)):
        with pytest.raises(TypeError):
            session.here(wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        session.here((1.0, 2.0), level=5)  # type: ignore[arg-type]


def test_a_place_without_a_name_or_with_too_long_a_one_is_an_error() -> None:
    session = fed(loop(), 5.0)
    for place in ("", "x" * 65):
        with pytest.raises(ValueError):
            session.here(place)
    with pytest.raises(ValueError, match="level"):
        session.here("gate", level="0")

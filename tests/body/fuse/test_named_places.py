"""A person names places, or reports what contradicts the track: what is noted, and what is used."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest
from lake import error, fed, loop, middle, off_by, passing_times
from walks import samples

from solepath import Session
from solepath.body.fuse.walked_path import MOST_NODES, NotedPlace, WalkedPath
from solepath.events import PositionRejected, PositionReported, TrackNode, TrackRevised


@pytest.mark.long
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


@pytest.mark.long
def test_a_named_place_where_the_wearer_cannot_be_is_rejected_by_its_name() -> None:
    walk, (first, _) = loop(), passing_times()
    session = fed(walk, first)
    session.here("gate", 0.2)
    fed(walk, first + 25.0, session, first)
    rejected = session.here("gate", 0.2)[1]
    assert isinstance(rejected, PositionRejected) and "where gate was before" in rejected.what


@pytest.mark.soak
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


@pytest.mark.soak
def test_a_right_place_in_between_makes_a_wrong_one_no_likelier() -> None:
    walk, session = loop(), fed(loop(), 60.0)
    assert isinstance(session.here(off_by(session, 40.0, 0.0))[1], PositionRejected)
    fed(walk, 80.0, session, 60.0)
    assert isinstance(session.here(off_by(session, 0.3, 0.0))[1], TrackRevised)
    fed(walk, 100.0, session, 80.0)
    assert isinstance(session.here(off_by(session, 40.0, 0.0))[1], PositionRejected)


def test_a_place_without_a_name_or_with_too_long_a_one_is_an_error() -> None:
    session = Session()
    session.feed(samples())
    for place in ("", "x" * 65):
        with pytest.raises(ValueError):
            session.here(place)
    with pytest.raises(ValueError, match="level"):
        session.here("gate", level="0")


def test_the_path_of_a_long_walk_has_few_nodes_and_keeps_its_ends_its_length_and_every_place() -> None:
    path, strides = WalkedPath(), 3000
    for k in range(strides):
        path.add_stride(float(k), complex(k, 0.5 * k), hypot(1.0, 0.5))
        if k in (40, 41, 700, 2990):
            path.add_node(TrackNode(float(k), float(k), 0.5 * k))
            path.places[f"at {k}"] = NotedPlace(k, len(path.nodes) - 1)
        assert len(path.nodes) <= MOST_NODES + len(path.places)
    assert path.nodes[0].t == 0.0 and strides - path.nodes[-1].t < 300.0
    times = [node.t for node in path.nodes]
    assert times == sorted(times) and len(times) > 15
    assert {name: path.nodes[one.node].t for name, one in path.places.items()} == {
        "at 40": 40.0, "at 41": 41.0, "at 700": 700.0, "at 2990": 2990.0
    }  # fmt: skip
    assert all((node.x, node.y) == (node.t, 0.5 * node.t) for node in path.nodes)

"""Tests tables, plots and summaries for people."""

from attrs import evolve
from hypothesis import given
from hypothesis import strategies as st
from strides import stride

from solepath.events import (
    CellFault,
    CellsFailed,
    ClockReset,
    Defect,
    DefectFound,
    FeetSwapped,
    FootResumed,
    FootSilent,
    HeelStrike,
    InsoleNeverUnloads,
    Limitation,
    PacketRejected,
    PacketsLost,
    Rejection,
    SampleGap,
    StreamStale,
    StrideFused,
    TouchedDown,
)
from solepath.session import Session
from solepath.show.observer import Observer
from solepath.show.tables.plot import plot
from solepath.show.tables.summary import fused_stride, link_health, status, summary, wear_lines
from solepath.show.tables.table import milliseconds, number, percent, table
from solepath.types import Foot, Packet, Sample, Site, WalkingMode

STRIDE = stride(
    Foot.LEFT, 2.0, (1.25, 0.0, 0.0), known_at=2.0625, position=(1.25, 0.0, 0.0), degraded=True,
    covariance=(1e-4, 0.0, 0.0, 1e-4, 0.0, 1e-4),
)  # fmt: skip


def test_columns_are_padded_the_first_to_the_left_and_the_rest_to_the_right():
    assert table(["foot", "m"], [["left", "1.25"], [], ["mean", "12.50"]]).splitlines() == [
        "foot      m", "----  -----", "left   1.25", "----  -----", "mean  12.50",
    ]  # fmt: skip


def test_a_figure_that_is_not_there_is_a_dash():
    assert (number(None), percent(None), milliseconds(None)) == ("-", "-", "-")
    assert (number(1.25, 1), percent(0.125), milliseconds(-0.0125)) == ("1.2", "12.5", "-12")


def test_a_straight_walk_is_a_straight_line_from_start_to_foot():
    lines = plot([(Foot.LEFT, float(x), 0.0) for x in range(11)], 21, 5)
    assert [line.strip() for line in lines] == ["", "", "S . . . . . . . . . L", "", ""]


def test_y_is_up_and_each_foot_is_marked_where_it_is():
    lines = plot([(Foot.LEFT, 0.0, 0.0), (Foot.LEFT, 0.0, 10.0), (Foot.RIGHT, 10.0, 10.0)], 21, 11)
    assert lines[0].strip() == "L                   R" and lines[-1].strip() == "S"


@given(
    st.lists(st.tuples(st.sampled_from(Foot), st.floats(-1e3, 1e3), st.floats(-1e3, 1e3)), max_size=20),
    st.integers(2, 80),
    st.integers(2, 30),
)
def test_any_track_fits_its_frame(track, width, height):
    lines = plot(track, width, height)
    assert len(lines) == height and all(len(line) == width for line in lines)


def test_a_summary_counts_the_events_of_each_foot():
    observer = Observer()
    for n in range(11):
        observer.take(Sample(n * 0.25 + (1.5 if n > 5 else 0.0), Site.LEFT_FOOT), [])
    strike = HeelStrike(t=1.9375, known_at=2.0, foot=Foot.LEFT)
    gap = SampleGap(t=1.25, known_at=3.0, site=Site.LEFT_FOOT, duration=1.75)
    observer.take(None, [gap, strike, evolve(strike, final=False), STRIDE])
    left, link = observer.feet[Foot.LEFT], observer.links[Site.LEFT_FOOT]
    assert (link.samples, link.gaps, link.gap_time, link.rate) == (11, 1, 1.75, 4.0)
    assert (left.events["heel-strike"], left.strides, left.degraded, left.distance) == (1, 1, 1, 1.25)
    text = summary(observer, title="walk.npz", seconds=2.0)
    assert text.splitlines()[0] == "walk.npz: 4.0 s"
    assert "left: 1 of 1 strides degraded" in text and "2 times as fast as walked" in text
    # 62.5 ms, and only of what is final; a half is rounded to the even millisecond
    assert "known after it happened, median: heel-strike 62 ms\n" in text


def test_a_healthy_link_is_not_mentioned_and_a_bad_one_line_by_line():
    observer = Observer()
    assert link_health(observer) == []
    frame = Packet(1.0, Site.LEFT_FOOT, "insole/frame", b"")
    for _ in range(97):
        observer.take(frame, [])
    observer.add(PacketsLost(t=0.0, known_at=1.0, site=Site.LEFT_FOOT, channel="insole/frame", count=3))
    for reason in (Rejection.CHECKSUM, Rejection.DUPLICATE, Rejection.CHECKSUM):
        rejected = PacketRejected(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, channel="insole/frame", reason=reason)
        observer.take(frame, [rejected])
    assert link_health(observer) == ["3 of 100 packets lost", "3 packets rejected (checksum 2, duplicate 1)"]


def test_what_happened_once_has_the_singular():
    observer = Observer()
    observer.add(FootSilent(t=1.0, known_at=2.0, foot=Foot.LEFT, silent_for=1.0))
    for t in (1.0, 5.0):
        observer.add(FootSilent(t=t, known_at=t + 1.0, foot=Foot.RIGHT, silent_for=1.0))
    assert wear_lines(observer) == [
        "left: silent once while the other walked on",
        "right: silent twice while the other walked on",
    ]
    frame = Packet(1.0, Site.LEFT_FOOT, "insole/frame", b"")
    late = PacketRejected(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, channel="insole/frame", reason=Rejection.LATE)
    observer.take(frame, [late])
    for n in range(3):
        observer.add(ClockReset(t=float(n), known_at=float(n), site=Site.LEFT_FOOT, restarted=True))
    observer.add(StreamStale(t=2.0, known_at=3.0, site=Site.LEFT_FOOT, silent_for=1.0))
    observer.add(SampleGap(t=4.0, known_at=4.5, site=Site.LEFT_FOOT, duration=0.5))
    observer.take(Sample(4.5, Site.LEFT_FOOT), [])
    assert link_health(observer) == ["1 packet rejected (late 1)", "3 clock resets", "a stream fell silent once"]
    assert "left: 1 gap in the samples, 0.50 s in all" in summary(observer, title="walk", seconds=0.0)


def test_defects_are_the_first_lines_of_a_summary_and_limitations_are_reported():
    observer = Observer()
    observer.add(Limitation(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, what="no gyroscope"))
    observer.add(DefectFound(t=0.0, known_at=0.0, site=Site.LEFT_FOOT, defect=Defect.WRONG_SCALE, what="reads 4.9"))
    text = summary(observer, title="walk", seconds=0.0)
    assert "limitation, left foot: no gyroscope" in text
    assert text.splitlines()[1] == "DEFECT, left foot: reads 4.9"


FUSED = StrideFused(
    t=2.0, known_at=2.0, foot=Foot.LEFT, number=4, stride_length=1.375, own_length=1.25, similarity=None,
    error_index=None, coefficient=1.0, chosen=Foot.RIGHT, distance=5.25, position=(5.0, 0.25, 0.0),
)  # fmt: skip


def down(mode: WalkingMode) -> TouchedDown:
    zero = (0.0, 0.0, 0.0)
    return TouchedDown(t=1.0, known_at=1.0, foot=Foot.LEFT, position=zero, mode=mode, compensation=zero)


def test_what_both_feet_did_together_is_summed_up():
    observer = Observer()
    observer.add(FUSED)
    for mode in (WalkingMode.LEFT_WIDE, WalkingMode.STRAIGHT, WalkingMode.STRAIGHT):
        observer.add(down(mode))
    text = summary(observer, title="walk", seconds=0.0)
    assert "both feet fused: 5.25 m, at the end by the right foot's path" in text
    assert "3 touchdowns: STRAIGHT 2, LEFT_WIDE 1" in text


def test_a_fault_in_wearing_is_reported_once():
    observer = Observer()
    assert wear_lines(observer) == []
    for cells in ((3, 11), (3, 11), tuple(range(40))):
        observer.add(CellsFailed(t=1.0, known_at=1.0, site=Site.LEFT_FOOT, fault=CellFault.DEAD, cells=cells))
    observer.add(InsoleNeverUnloads(t=1.0, known_at=1.0, site=Site.RIGHT_FOOT, seconds=5.0))
    observer.add(FeetSwapped(t=1.0, known_at=1.0))
    observer.add(FootSilent(t=1.0, known_at=1.0, foot=Foot.RIGHT, silent_for=2.0))
    observer.add(FootResumed(t=3.0, known_at=3.0, foot=Foot.RIGHT, silent_for=4.0))
    assert wear_lines(observer) == [
        "left foot: cells 3, 11 dead, left out",
        "left foot: 40 cells dead, left out",
        "right foot: the insole never unloads; phases come from the inertial sensor",
        "the feet look swapped: what comes as the left one is like a right one",
        "right: silent once while the other walked on",
    ]


def test_control_codes_of_devices_do_not_reach_the_terminal():
    observer, packet = Observer(), Packet(1.0, Site.LEFT_FOOT, "receiver/trouble", b"\x1b[31mA\x07 is none")
    observer.take(packet, Session().feed(packet))
    for text in (*status(observer), *link_health(observer)):
        assert text.isprintable() and "A" in text


def test_the_last_fused_stride_shows_what_it_was_fused_by():
    observer = Observer()
    assert fused_stride(observer) == []
    observer.add(evolve(FUSED, error_index=0.12))
    assert fused_stride(observer) == [
        "both feet: 5.25 m by the right foot; last stride 1.38 m",
        "  similarity -, error index 0.12 m/s, own share 1.00",
    ]

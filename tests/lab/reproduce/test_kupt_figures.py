"""The velocities of figs. 11 and 14 of Chen et al. 2019, and the share of a gait cycle in which a velocity is known."""

from __future__ import annotations

import pytest
from attrs import evolve

from solepath import HeelStrike, ToeOff
from solepath.papers import StrideFused
from solepath.types import Foot
from solepath_lab.reproduce.kupt.figures import KnownSample, coverage, panels, without_drift

CYCLE = ("stands", "stands", "rolls", "air", "air", "air", "air", "air", "rolls", "air")
"""Samples of one stride from the start of the stance; 0.1 s each."""


def series(cycles: int) -> list[KnownSample]:
    """Return the samples of strides: the raw velocity grows by 1 m/s in each, the shoe rolls with 0.5 m/s."""
    samples = []
    for k in range(cycles * len(CYCLE)):
        kind = CYCLE[k % len(CYCLE)]
        stands = kind == "stands"
        reference = 0.0 if stands else 0.5 if kind == "rolls" else None
        samples.append(KnownSample(0.1 * k, 0.0 if stands else 0.1 * (k % len(CYCLE)), reference, stands))
    return samples


def test_zero_velocity_is_known_in_stance_and_the_rolling_shoe_adds_its_samples() -> None:
    # of ten samples of a stride two stand and two roll
    assert coverage(series(5)) == pytest.approx((20.0, 40.0))


def test_the_first_and_the_last_stride_do_not_count() -> None:
    samples = series(5)
    lost = [KnownSample(one.t, one.raw, None, False) if one.t < 0.5 or one.t > 4.2 else one for one in samples]
    assert coverage(lost) == pytest.approx((20.0, 40.0))


def test_zupt_takes_one_line_out_of_each_motion() -> None:
    # from 0 at the last sample of stance, 0.1 s, to 0.9 m/s at the last of the motion, 0.9 s
    velocity = without_drift(series(2), knows_rolling=False)
    assert [v for _, v in velocity[:2]] == [0.0, 0.0]
    assert velocity[5] == pytest.approx((0.5, 0.5 - 0.9 * 0.5))
    assert velocity[9] == pytest.approx((0.9, 0.0))


def test_kupt_takes_the_line_of_equation_8_out_of_the_swing_alone() -> None:
    # errors 0.2 - 0.5 = -0.3 at toe-off, 0.2 s, and 0.8 - 0.5 = 0.3 at heel-strike, 0.8 s: at 0.4 s -0.3 + 0.6 / 3
    velocity = without_drift(series(2), knows_rolling=True)
    assert [v for _, v in velocity[2:5]] == pytest.approx([0.5, 0.3 + 0.2, 0.4 + 0.1])
    assert [v for _, v in velocity[8:10]] == pytest.approx([0.5, 0.0])


def test_figures_10_and_11_are_drawn_for_both_feet_and_figure_14_shows_three_strides() -> None:
    fused = [
        StrideFused(
            t=float(k),
            known_at=float(k),
            foot=foot,
            number=k,
            stride_length=1.3,
            own_length=1.2,
            similarity=0.9,
            error_index=0.1 * k if k else None,
            coefficient=0.6,
            chosen=Foot.RIGHT,
            distance=1.3 * k,
            position=(1.3 * k, 0.0, 0.0),
        )
        for k in range(3)
        for foot in Foot
    ]
    events = [kind(t=t, known_at=t, foot=Foot.RIGHT) for kind, t in ((HeelStrike, 0.85), (ToeOff, 0.25))]
    seen = {foot: [evolve(one, cop=0.1 * one.t) for one in series(8)] for foot in Foot}
    drawn = {panel.title: panel.tracks for panel in panels(seen, [*fused, *events], [], [*fused])}
    assert [title.split("(fig. ")[1] for title in drawn] == [
        "10 a)", "10 b)", "11 a)", "11 c)", "11 e)", "11 b)", "11 d)", "11 f)", "14)",
    ]  # fmt: skip
    strikes, lifts = drawn["right foot (fig. 10 b)"][2:]
    assert strikes.points == (pytest.approx((0.85, 0.085)),) and lifts.points == (pytest.approx((0.25, 0.025)),)
    assert all(not curve.points for curve in drawn["left foot (fig. 10 a)"][2:])
    for letters in ("ce", "df"):
        weights, distance = (of for title, of in drawn.items() for letter in letters if title.endswith(f"11 {letter})"))
        similarity, index, coefficient = (curve.points for curve in weights)
        assert similarity == ((0.0, 0.9), (1.0, 0.9), (2.0, 0.9)) and index == ((1.0, 0.1), (2.0, 0.2))
        assert coefficient == ((0.0, 0.6), (1.0, 0.6), (2.0, 0.6))
        sums = {curve.name: curve.points for curve in distance}
        assert sums["KUPT + 1st stage DFPC"] == ((0.0, 1.3), (1.0, 2.6), (2.0, pytest.approx(3.9)))
        # the choice between the feet (13) is drawn after each stride of either foot
        assert sums["KUPT+DFPC"] == ((0.0, 0.0), (0.0, 0.0), (1.0, 1.3), (1.0, 1.3), (2.0, 2.6), (2.0, 2.6))
    shown, *_ = drawn["drift in three strides (fig. 14)"]
    assert [one.name for one in drawn["velocity (fig. 11 a)"]] == ["V-raw", "V-ref", "ZUPT", "KUPT"]
    stands = [t for t, v in shown.points if v == 0.0]
    assert len(stands) == 7 and shown.points[-1][0] - shown.points[0][0] == pytest.approx(3.0)

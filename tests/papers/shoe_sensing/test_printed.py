"""The printed corrector and detector of shoe sensing (Sensors 16, 1809, 2016, sections 3.1 to 3.4): nothing of ours."""

from __future__ import annotations

from math import pi, sin

import pytest

from solepath.foot.stance.stance import Stance
from solepath.papers.shoe_sensing.printed import GatedTilt
from solepath.papers.shoe_sensing.short_time_energy import ShortTimeEnergy, printed_energy
from solepath.types import Phase, Vec3
from solepath.types.vector import GRAVITY, IDENTITY, ZERO

STILL = Stance(ZERO, 0.01, 0.0, Phase.STATIONARY)
MOVING = Stance(ZERO, 9.0, 9.0, None)
UNCERTAIN = Stance(ZERO, 0.03, 9.0, None)
DT = 0.01


def standing_corrector() -> GatedTilt:
    one = GatedTilt()
    one.start(IDENTITY, 0.02)
    feed(one, [ZERO] * 20, STILL)
    return one


def feed(one: GatedTilt, accelerations: list[Vec3], stance: Stance) -> bool:
    corrected = False
    for x, y, z in accelerations:
        one.predict(DT, (x, y, z + GRAVITY), ZERO)
        corrected = one.correct(0.0, stance)
    return corrected


def feed_stride(one: GatedTilt, length: float, height: float, drift: Vec3 = ZERO) -> None:
    """Move the foot by `length` and `height` m in 0.8 s, with a constant error of the acceleration."""
    n = 80
    a, u = (2.0 * pi * way / (n * DT) ** 2 for way in (length, height))
    wave = [sin(2.0 * pi * (k + 0.5) / n) for k in range(n)]
    feed(one, [(a * w + drift[0], drift[1], u * w + drift[2]) for w in wave], MOVING)
    feed(one, [ZERO] * 20, STILL)


def test_a_linear_drift_is_taken_off_velocity_and_distance() -> None:
    one = standing_corrector()
    feed_stride(one, 0.6, 0.32, (0.3, 0.2, -0.2))
    assert one.velocity == ZERO
    assert one.position == pytest.approx((0.6, 0.0, 0.32), abs=8e-3)


def test_only_the_angle_decides_whether_a_height_stays() -> None:
    # 0.16 m in 1.1 m are 15 degrees/m, below 55.9: the first riser is lost, which ours keeps
    for length, height, kept in ((1.2, 0.05, 0.0), (1.1, 0.16, 0.0), (0.6, 0.32, 0.32), (0.6, -0.32, -0.32)):
        one = standing_corrector()
        feed_stride(one, length, height)
        assert one.position[2] == pytest.approx(kept, abs=5e-3)


def test_evidence_that_is_not_certain_is_no_stance() -> None:
    one = standing_corrector()
    feed(one, [ZERO] * 50, MOVING)
    assert not feed(one, [ZERO], UNCERTAIN) and not one.standing
    assert feed(one, [ZERO], STILL) and one.standing


def test_the_printed_detector_has_certain_evidence_or_none() -> None:
    both = ShortTimeEnergy(), printed_energy()
    hints = []
    for k in range(40):
        acc = (0.0, 0.0, GRAVITY * (1.0 if k >= 6 else 1.5))  # still from the seventh sample on
        ours, printed = (one.update(k * DT, DT, acc, ZERO, None) for one in both)
        assert printed.statistic == ours.statistic
        hints.append((ours.hint, ours.sigma < 1.0, printed.hint, printed.sigma < 1.0))
    assert (None, True, None, False) in hints
    assert hints[-1] == (Phase.STATIONARY, True, Phase.STATIONARY, True)
    assert all(hint is None or hint is Phase.STATIONARY for _, _, hint, _ in hints)
    assert all(sure == (hint is Phase.STATIONARY) for _, _, hint, sure in hints)

"""Vertical load under each foot, and its distribution over the sole.

The forces are vertical only. In walking the two feet together bear the weight times 1 + A cos, one period per step with
its maximum in the middle of double support. Each foot then shows the two maxima and the minimum of a force plate (about
1.1, 0.8 and 1.1 body weights at 1.3 m/s; Perry, Gait Analysis, 1992), and the mean over a step is the weight. In double
support the load moves from the trailing to the leading foot.

In running each foot bears half a sine wave from heel-strike to toe-off, and the load is 0 between (Alexander 1989,
Physiol. Rev. 69); its mean over a step is the weight, so its maximum is 2 to 3 body weights. In a lift the load changes
with the car's acceleration. On stairs the load lands on the forefoot.

Under the foot the load starts at the heel with heel-strike, reaches the forefoot with foot-flat, leaves the heel with
heel-off and ends under the toes with toe-off.

In a bend of radius r at speed v the line from the body's centre of mass along gravity and centrifugal force meets the
ground h v^2 / (r g) away from the point below the centre, to the outside of the turn. Leaning and placing the feet
compensate for most of that. LOAD_SHIFT_SHARE of it moves the load under each foot: to the right edge of both feet in a
turn to the left. Under the heels insoles show the same (Turcato et al. 2015, J NeuroEng Rehabil 12:4: the lateral heel
of the outer foot bears more, that of the inner foot less). Under the metatarsal heads they found the opposite, which is
not emulated."""

from __future__ import annotations

import numpy as np
from attrs import frozen
from numpy.typing import NDArray

from ...types import Foot, Layout
from ...types.vector import GRAVITY
from ..routes.lift import CarRide
from ..routes.styles import StrideKind, style_of
from .curves import Array, Rng
from .gait import SETTLE_TIME, PlannedStride, WalkPlan, Wearer
from .motion import FootMotion
from .zones import FOREFOOT, HEEL, MIDFOOT, TOES, pattern

BOUNCE = 0.17
"""Amplitude of the load about the weight at 1.3 m/s, as a share of it; it grows with the square of the speed."""
CATCH_TIME = 0.13
"""Time that the closing foot takes to take over the weight, s."""
LOAD_SHIFT_SHARE = 0.3
"""Share of h v^2 / (r g) by which the load moves under a foot (assumed).

At 1.1 m/s it is 18 mm at r = 2 m; the ankle can move the load sideways by about 20 mm (Hof et al. 2007, Gait & Posture
25)."""
_EVER = 1e6
"""Duration of the stances before the first and after the last stride, s."""
_BLOCK = 4096
"""Number of instants computed together: intermediate arrays need a hundred times the memory of one cell's loads."""


@frozen(eq=False)
class Loads:
    """The vertical load under both feet over time.

    In hand-overs the load moves from one foot to the other. Beats are the middles of double support and of flight."""

    weight: float
    """Weight of the body, N."""
    start: Array
    """Start of each hand-over, s."""
    end: Array
    """End of each hand-over, s."""
    before: Array
    """Share of the left foot before each hand-over."""
    after: Array
    """Share of the left foot after each hand-over."""
    beat: Array
    """Time of each beat, s."""
    bounce: Array
    """Amplitude of the load about the weight from each beat to the next, as a share of the weight."""
    runs: Array
    """Heel-strike after each beat in flight, and toe-off before the next beat in flight, s, (beats, 2); else 0."""
    stances: dict[Foot, Array]
    """Heel-strike, foot-flat, heel-off and toe-off of each stance, s, (n, 4)."""
    leans: dict[Foot, Array]
    """Shift of the load to the left in each stance, m, and time at which it decays as the walk ends, s, (n, 2)."""
    fronts: dict[Foot, Array]
    """Share of the load that lands on the forefoot in each stance, (n)."""
    rides: tuple[CarRide, ...] = ()
    """Lifts that the wearer takes."""

    def total(self, foot: Foot, t: Array) -> Array:
        """Return the load under one foot, N, (N)."""
        return np.asarray(self.share(foot, t) * self.body(t))

    def body(self, t: Array) -> Array:
        """Return the load under both feet together, N, (N)."""
        load = self._on_still_floor(t)
        for car in self.rides:
            load *= 1.0 + car.at(t)[2][:, 2] / GRAVITY
        return load

    def _on_still_floor(self, t: Array) -> Array:
        """Return the load under both feet together on a floor that does not move, N, (N)."""
        if len(self.beat) < 2:
            return np.full_like(t, self.weight)
        k = np.clip(np.searchsorted(self.beat, t, side="right") - 1, 0, len(self.beat) - 2)
        phase = np.clip((t - self.beat[k]) / (self.beat[k + 1] - self.beat[k]), 0.0, 1.0)
        # cos has zero slope at both ends of a step: the load is smooth at the start and the end of a bout.
        swing = (self.bounce[k] + (self.bounce[k + 1] - self.bounce[k]) * phase) * np.cos(2.0 * np.pi * phase)
        load = np.asarray(self.weight * (1.0 + swing))
        if self.runs.any():
            self._apply_flight(load, k, t)
        return load

    def _apply_flight(self, load: Array, k: NDArray[np.intp], t: Array) -> None:
        """Change the load, in place, where the body is in flight before or after a beat: it falls to 0."""
        strike, off = self.runs[k, 0], self.runs[k, 1]
        both = (strike > 0.0) & (off > 0.0)
        lasts = np.where(both, off - strike, 1.0)
        step = self.beat[np.minimum(k + 1, len(self.beat) - 1)] - self.beat[k]
        half = np.sin(np.pi * np.clip((t - strike) / lasts, 0.0, 1.0))
        load[both] = (self.weight * 0.5 * np.pi * step / lasts * half)[both]
        landing = (strike > 0.0) & ~both
        load[landing] *= hand_over((t - strike)[landing] / CATCH_TIME)
        leaving = (off > 0.0) & ~both
        load[leaving] *= hand_over((off - t)[leaving] / CATCH_TIME)

    def cells(self, layout: Layout, width: float, motion: FootMotion, t: Array) -> Array:
        """Return the load on every cell of `layout`, N, (N, cells); the sum of a row is the foot's total.

        Cells that end behind the middle of the foot bear only the load above them, and their sum is smaller."""
        foot = layout.foot
        shares = self.shares(foot, t)
        pitch = motion.pitch(t)
        heel = -0.035 * np.sin(np.maximum(pitch, 0.0)) / layout.length
        fore = 0.025 * np.sin(np.maximum(-pitch, 0.0)) / layout.length
        inward = -0.10 * fore / fore.max(initial=1e-9)
        total = self.total(foot, t)
        lean = self.lean(foot, t)
        found = np.zeros((len(t), len(layout.cells)))
        still = np.zeros_like(t)
        moves = ((HEEL, heel, still), (MIDFOOT, still, still), (FOREFOOT, fore, inward), (TOES, fore, still))
        for (zone, ahead, aside), share in zip(moves, shares, strict=True):
            loaded = np.flatnonzero(share * total > 0.0)
            for start in range(0, len(loaded), _BLOCK):
                some = loaded[start : start + _BLOCK]
                borne = pattern(layout, width, zone, ahead[some], aside[some], lean[some])
                found[some] += (share * total)[some, None] * borne
        return found

    def lean(self, foot: Foot, t: Array) -> Array:
        """Return the shift of the load to the left under a foot, m, (N); in a bend it is to the outside."""
        rows = np.maximum(np.searchsorted(self.stances[foot][:, 0], t, side="right") - 1, 0)
        shift, over = self.leans[foot][rows].T
        return np.asarray(shift * (1.0 - hand_over((t - over) / SETTLE_TIME)))

    def share(self, foot: Foot, t: Array) -> Array:
        """Return the share of a foot in the body's load, (N)."""
        if not len(self.start):
            return np.full_like(t, 0.5)
        k = np.searchsorted(self.start, t, side="right") - 1
        known = np.maximum(k, 0)
        s = (t - self.start[known]) / (self.end[known] - self.start[known])
        share = self.before[known] + (self.after[known] - self.before[known]) * hand_over(s)
        left = np.where(k < 0, self.before[0], share)
        return left if foot is Foot.LEFT else np.asarray(1.0 - left)

    def shares(self, foot: Foot, t: Array) -> Array:
        """Return the shares of heel, midfoot, forefoot and toes in the foot's load, (4, N); their sum is one."""
        stances = self.stances[foot]
        rows = np.maximum(np.searchsorted(stances[:, 0], t, side="right") - 1, 0)
        row = stances[rows]
        flat, lift, off = row[:, 1], row[:, 2], row[:, 3]
        ramp = np.minimum(lift - flat, SETTLE_TIME)
        rolled = 0.45 * hand_over((t - flat) / ramp) + 0.55 * hand_over((t - lift + ramp) / ramp)
        if self.fronts[foot].any():
            front = self.fronts[foot][rows]
            rolled += (1.0 - rolled) * front * (1.0 - hand_over((t - flat) / ramp))
        middle = 0.5 * rolled * (1.0 - rolled)
        front = rolled - 0.5 * middle
        toes = front * (0.05 + 0.10 * rolled + 0.60 * hand_over((t - lift) / (off - lift)))
        return np.stack((1.0 - rolled - 0.5 * middle, middle, front - toes, toes))


def loads(plan: WalkPlan, wearer: Wearer, rng: Rng) -> Loads:
    """Return the loads of a planned walk; `rng` draws the wearer's `load_variation` between steps."""
    hand_overs, beats = _hand_overs(plan)
    table = np.array(hand_overs).reshape(-1, 4)
    beat = np.array(beats).reshape(-1, 4)
    return Loads(
        weight=wearer.mass * GRAVITY,
        start=table[:, 0],
        end=table[:, 1],
        before=table[:, 2],
        after=table[:, 3],
        beat=beat[:, 0],
        bounce=np.minimum(BOUNCE * (beat[:, 1] / 1.3) ** 2, 0.35),
        runs=beat[:, 2:],
        stances={foot: _stances(plan, foot) for foot in Foot},
        leans={foot: _leans(plan, foot, wearer, rng) for foot in Foot},
        fronts={foot: np.array([0.0, *(_front(stride) for stride in plan.strides[foot])]) for foot in Foot},
        rides=plan.rides,
    )


def _front(stride: PlannedStride) -> float:
    """Return the share of the load that lands on the forefoot."""
    return 0.0 if stride.kind is StrideKind.WALK else style_of(stride.kind, stride.speed).front


def _equivalent_speed(stride: PlannedStride) -> float:
    """Return the speed, m/s, of level walking with the same amplitude of the load as in this stride."""
    if stride.kind is StrideKind.WALK or stride.kind is StrideKind.RUN:
        return stride.speed
    return 1.3 * float(np.sqrt(style_of(stride.kind, stride.speed).bounce / BOUNCE))


def hand_over(s: Array) -> Array:
    """Return a curve from 0 to 1 over the unit interval with a non-zero slope at both ends, as force plates show it."""
    s = np.clip(s, 0.0, 1.0)
    return np.asarray(0.5 * s + s * s * (1.5 - s))


def _hand_overs(plan: WalkPlan) -> tuple[list[tuple[float, ...]], list[tuple[float, ...]]]:
    """Return rows of (start, end, before, after), and rows of (beat, speed that sets the bounce, two of `runs`)."""
    strides = sorted((s.heel_strike, foot.value, s, foot) for foot in Foot for s in plan.strides[foot])
    steps = [(stride, foot) for _, _, stride, foot in strides]
    hand_overs: list[tuple[float, ...]] = []
    beats: list[tuple[float, ...]] = []
    level = 0.5
    for start, end in plan.bouts:
        bout = [(stride, foot) for stride, foot in steps if start <= stride.heel_strike <= end]
        first, mover = bout[0]
        away = 0.0 if mover is Foot.LEFT else 1.0
        hand_overs.append((start, first.toe_off, level, away))
        beats.append((start, 0.0, 0.0, 0.0))
        level = away
        for (stride, foot), (following, _) in zip(bout, bout[1:], strict=False):
            onto = 1.0 if foot is Foot.LEFT else 0.0
            strike, off = stride.heel_strike, following.toe_off
            hand_overs.append((min(strike, off), max(strike, off), level, onto))
            flown = off < strike
            if flown:
                # This beat is in flight: the step before it ends with a take-off, the next one starts with a landing.
                beats[-1] = (*beats[-1][:3], off)
            beats.append((0.5 * (strike + off), _equivalent_speed(stride), strike if flown else 0.0, 0.0))
            level = onto
        last, _ = bout[-1]
        # The closing foot takes over the weight as in a step, a little more than half of it, and then half.
        caught, settled = last.heel_strike + CATCH_TIME, last.heel_strike + SETTLE_TIME
        most = 0.6 if level == 0.0 else 0.4
        hand_overs.append((last.heel_strike, caught, level, most))
        hand_overs.append((caught, settled, most, 0.5))
        beats.append((last.heel_strike + 0.5 * SETTLE_TIME, 0.0, 0.0, 0.0))
        level = 0.5
    return hand_overs, beats


def _stances(plan: WalkPlan, foot: Foot) -> Array:
    strides = plan.strides[foot]
    lands = [(-_EVER, -_EVER), *((s.heel_strike, s.foot_flat) for s in strides)]
    leaves = [*((s.heel_off, s.toe_off) for s in strides), (_EVER, _EVER + 1.0)]
    return np.array([(*land, *leave) for land, leave in zip(lands, leaves, strict=True)])


def _leans(plan: WalkPlan, foot: Foot, wearer: Wearer, rng: Rng) -> Array:
    """Return for every stance the shift of the load, m, and the last heel-strike of its bout, s."""
    rows = [(0.0, -_EVER)]
    for stride in plan.strides[foot]:
        over = next(end for start, end in plan.bouts if start <= stride.heel_strike <= end) - SETTLE_TIME
        shift = -LOAD_SHIFT_SHARE * wearer.centre_height * stride.pace**2 * stride.curvature / GRAVITY
        rows.append((shift + wearer.load_variation * float(rng.standard_normal()), over))
    return np.array(rows)

"""Vertical load under each foot, and its distribution over the sole.

Only vertical forces are emulated. In walking both feet together bear the weight times 1 + A cos(phase). One period
lasts a step, and the maximum is in the middle of double support. The load of each foot then has two maxima and one
minimum, as on force plates (about 1.1, 0.8 and 1.1 body weights at 1.3 m/s; Perry, Gait Analysis, 1992). The
mean over a step is the weight. In double support the load moves from the trailing to the leading foot.

In running each foot bears half a sine wave from heel-strike to toe-off, and no load in flight (Alexander 1989,
Physiol. Rev. 69). The mean over a step is the weight, so the maximum is 2 to 3 body weights. In an elevator the load
changes with the car's acceleration. On stairs the load lands on the forefoot.

Under the foot the load starts at the heel with heel-strike, reaches the forefoot with foot-flat, leaves the heel with
heel-off and ends under the toes with toe-off.

In a bend of radius r at speed v the line from the body's centre of mass along gravity and centrifugal force meets the
ground h v^2 / (r g) away from the point below the centre, to the outside of the turn. The wearer leans and places the
feet so that most of this distance is compensated. The share LOAD_SHIFT_SHARE of it moves the load under each foot:
in a turn to the left, towards the right edge of both feet. Insoles show this under the heels (Turcato et al. 2015, J
NeuroEng Rehabil 12:4: the lateral heel of the outer foot bears more, the lateral heel of the inner foot less). Under
the metatarsal heads they show the opposite. So there are two laws (`LoadLaw`): by one the load moves outward under the
whole foot, by the other outward under the heel and, assumed as far, inward under forefoot and toes. Numbers without a
source were chosen by hand for plausible loads and not swept."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ...types import Foot, Layout
from ...types.vector import GRAVITY
from .curves import Array, Rng, hand_over
from .gait import SETTLE_TIME, LoadLaw, PlannedStride, WalkPlan, Wearer
from .motion import FootMotion
from .zones import FOREFOOT, HEEL, MIDFOOT, TOES, cell_shares

BOUNCE_AMPLITUDE = 0.17
"""Amplitude A of the load in walking at 1.3 m/s, as a share of the weight; A grows with the square of the speed."""
MAX_BOUNCE_AMPLITUDE = 0.35
"""Largest amplitude A at any speed."""
CATCH_TIME = 0.13
"""Time in which a foot gains or loses its load at a halt, at a runner's first landing and at the last take-off, s."""
LOAD_SHIFT_SHARE = 0.3
"""Share of h v^2 / (r g) by which the load moves under a foot in a bend (assumed).

It is 18 mm at a speed of 1.1 m/s and a radius of 2 m. The ankle can move the load sideways by about 20 mm (Hof et al.
2007, Gait & Posture 25)."""
ZONE_SHIFTS = {LoadLaw.OUTWARD: (1.0, 1.0, 1.0, 1.0), LoadLaw.HEEL_OUT_FOREFOOT_IN: (1.0, 0.0, -1.0, -1.0)}
"""Shift of the load in a bend under heel, midfoot, forefoot and toes, as a multiple of the outward shift, by law."""
_FOREVER = 1e6
"""Duration of the stances before the first and after the last stride, s."""
_BLOCK_SIZE = 4096
"""Number of instants computed at a time, because intermediate arrays need the memory of a hundred cells."""


class Loads:
    """The vertical load under both feet over time.

    A hand-over is a time in which load moves from one foot to the other. A beat is the middle of a double support or of
    a flight; a bout also has one at its start, and one half of SETTLE_TIME after its last heel-strike."""

    def __init__(self, plan: WalkPlan, wearer: Wearer, rng: Rng) -> None:
        """Take the loads of a planned walk; `rng` draws the lateral position of the load in each stance."""
        hand_overs, beats = _hand_overs(plan)
        self.weight = wearer.mass * GRAVITY
        """Weight of the body, N."""
        self.start, self.end, self.share_before, self.share_after = np.array(hand_overs).reshape(-1, 4).T
        """Start and end of each hand-over, s, and share of the left foot in the load before and after it."""
        self.beat_times, speeds, *contacts = np.array(beats).reshape(-1, 4).T
        """Time of each beat, s."""
        self.load_amplitude = np.minimum(BOUNCE_AMPLITUDE * (speeds / 1.3) ** 2, MAX_BOUNCE_AMPLITUDE)
        """Amplitude of the load about the weight from each beat to the next, as a share of the weight."""
        self.run_contacts = np.stack(contacts, axis=1)
        """Heel-strike after each beat, toe-off before the next, s, (beats, 2); 0 where that beat is not in flight."""
        self.stances = {foot: _stances(plan, foot) for foot in Foot}
        """Heel-strike, foot-flat, heel-off and toe-off of each stance, s, (n, 4)."""
        self.lateral_shifts = {foot: _lateral_shifts(plan, foot, wearer, rng) for foot in Foot}
        """Shift of the load to the left in each stance by the bend and by chance, m, and time at which it starts to
        decay at a halt, s, (n, 3)."""
        self.forefoot_shares = {
            foot: np.array([0.0, *(stride.style.forefoot_share for stride in plan.strides[foot])]) for foot in Foot
        }
        """Share of the load that lands on the forefoot in each stance, (n)."""
        self.rides = plan.moving_ground
        self.pad, self.law = wearer.pad, wearer.load_law

    def stance_rows(self, foot: Foot, t: Array) -> NDArray[np.intp]:
        """Return the number of the last stance that has begun at each of the times `t`, s, or 0."""
        return np.maximum(np.searchsorted(self.stances[foot][:, 0], t, side="right") - 1, 0)

    def total(self, foot: Foot, t: Array) -> Array:
        """Return the load under one foot at times `t`, s, in newtons, (N)."""
        return np.asarray(self.share(foot, t) * self.body(t))

    def body(self, t: Array) -> Array:
        """Return the load under both feet together at times `t`, s, in newtons, (N)."""
        load = self._on_still_floor(t)
        for car in self.rides:
            load *= 1.0 + car.at(t)[2][:, 2] / GRAVITY
        return load

    def _on_still_floor(self, t: Array) -> Array:
        """Return the load under both feet together, in newtons, (N), as if no elevator or escalator moved."""
        if len(self.beat_times) < 2:
            return np.full_like(t, self.weight)
        k = np.clip(np.searchsorted(self.beat_times, t, side="right") - 1, 0, len(self.beat_times) - 2)
        phase = np.clip((t - self.beat_times[k]) / (self.beat_times[k + 1] - self.beat_times[k]), 0.0, 1.0)
        # cos has zero slope at both ends of a step: the load is smooth at the start and the end of a bout.
        bounce = (self.load_amplitude[k] + (self.load_amplitude[k + 1] - self.load_amplitude[k]) * phase) * np.cos(
            2.0 * np.pi * phase
        )
        load = np.asarray(self.weight * (1.0 + bounce))
        if self.run_contacts.any():
            self._apply_flight(load, k, t)
        return load

    def _apply_flight(self, load: Array, k: NDArray[np.intp], t: Array) -> None:
        """Set the load, in place, in steps that start with a landing or end with a take-off; in flight it is 0."""
        strike, off = self.run_contacts[k, 0], self.run_contacts[k, 1]
        has_both_contacts = (strike > 0.0) & (off > 0.0)
        stance_time = np.where(has_both_contacts, off - strike, 1.0)
        step = self.beat_times[np.minimum(k + 1, len(self.beat_times) - 1)] - self.beat_times[k]
        half = np.sin(np.pi * np.clip((t - strike) / stance_time, 0.0, 1.0))
        load[has_both_contacts] = (self.weight * 0.5 * np.pi * step / stance_time * half)[has_both_contacts]
        landing = (strike > 0.0) & ~has_both_contacts
        load[landing] *= hand_over((t - strike)[landing] / CATCH_TIME)
        leaving = (off > 0.0) & ~has_both_contacts
        load[leaving] *= hand_over((off - t)[leaving] / CATCH_TIME)

    def cells(self, layout: Layout, width: float, motion: FootMotion, t: Array) -> Array:
        """Return the load on every cell of `layout` at times `t`, s, as an array (times, cells), N.

        The sum of a row is the foot's load. When all cells are in the rear half of the sole, they bear only the load
        above them, and the sum is smaller."""
        foot = layout.foot
        shares = self.zone_shares(foot, t)
        pitch = motion.pitch(t)
        # When the foot pitches, the load moves towards the end that stays down, and at push-off also to the big toe.
        heel = -0.035 * np.sin(np.maximum(pitch, 0.0)) / layout.length
        fore = 0.025 * np.sin(np.maximum(-pitch, 0.0)) / layout.length
        inward = -0.10 * fore / fore.max(initial=1e-9)
        total = self.total(foot, t)
        lateral_shifts = self.zone_shifts(foot, t)
        spread = np.ones_like(t)
        if self.pad is not None:
            heel += self.pad_shift(foot, shares[0], t) / layout.length
            spread = self.pad.spread(shares[0] * total / self.weight)
        cell_loads = np.zeros((len(t), len(layout.cells)))
        zero = np.zeros_like(t)
        moves = ((HEEL, heel, zero), (MIDFOOT, zero, zero), (FOREFOOT, fore, inward), (TOES, fore, zero))
        for (zone, ahead, aside), share, lateral_shift in zip(moves, shares, lateral_shifts, strict=True):
            loaded = np.flatnonzero(share * total > 0.0)
            for start in range(0, len(loaded), _BLOCK_SIZE):
                block = loaded[start : start + _BLOCK_SIZE]
                moved = (ahead[block], aside[block], lateral_shift[block], spread[block] if zone is HEEL else 1.0)
                cell_loads[block] += (share * total)[block, None] * cell_shares(layout, width, zone, *moved)
        return cell_loads

    def pad_shift(self, foot: Foot, heel_share: Array, t: Array) -> Array:
        """Return how far the pad lets the patch under a heel be ahead of its place at `t`, s, in m, (N)."""
        if self.pad is None or not len(self.start):
            return np.zeros_like(t)
        rows = self.stance_rows(foot, t)
        # the amplitude grows with the square of the speed
        speed = np.interp(t, self.beat_times, np.sqrt(self.load_amplitude / BOUNCE_AMPLITUDE))
        return self.pad.shift(self.stances[foot][rows], heel_share, self.weight, speed, t)

    def lateral_shift(self, foot: Foot, t: Array) -> Array:
        """Return the shift to the left of the load under a whole foot at `t`, s, in m, (N)."""
        return np.asarray(np.sum(self.zone_shares(foot, t) * self.zone_shifts(foot, t), axis=0))

    def zone_shifts(self, foot: Foot, t: Array) -> Array:
        """Return the shift to the left of the load under heel, midfoot, forefoot and toes at `t`, s, in m, (4, N)."""
        rows = self.stance_rows(foot, t)
        bend, chance, t_decay = self.lateral_shifts[foot][rows].T
        shifts = np.array(ZONE_SHIFTS[self.law])[:, None] * bend + chance
        return np.asarray(shifts * (1.0 - hand_over((t - t_decay) / SETTLE_TIME)))

    def share(self, foot: Foot, t: Array) -> Array:
        """Return the share of a foot in the load under both feet together at times `t`, s, (N)."""
        if not len(self.start):
            return np.full_like(t, 0.5)
        k = np.searchsorted(self.start, t, side="right") - 1
        row = np.maximum(k, 0)
        s = (t - self.start[row]) / (self.end[row] - self.start[row])
        share = self.share_before[row] + (self.share_after[row] - self.share_before[row]) * hand_over(s)
        left = np.where(k < 0, self.share_before[0], share)
        return left if foot is Foot.LEFT else np.asarray(1.0 - left)

    def zone_shares(self, foot: Foot, t: Array) -> Array:
        """Return the shares of heel, midfoot, forefoot and toes in the foot's load at `t`, s, (4, N)."""
        rows = self.stance_rows(foot, t)
        _, foot_flat, heel_off, off = self.stances[foot][rows].T
        ramp = np.minimum(heel_off - foot_flat, SETTLE_TIME)
        rolled_share = 0.45 * hand_over((t - foot_flat) / ramp) + 0.55 * hand_over((t - heel_off + ramp) / ramp)
        if self.forefoot_shares[foot].any():
            forefoot_share = self.forefoot_shares[foot][rows]
            rolled_share += (1.0 - rolled_share) * forefoot_share * (1.0 - hand_over((t - foot_flat) / ramp))
        midfoot_share = 0.5 * rolled_share * (1.0 - rolled_share)
        forefoot_share = rolled_share - 0.5 * midfoot_share
        toes = forefoot_share * (0.05 + 0.10 * rolled_share + 0.60 * hand_over((t - heel_off) / (off - heel_off)))
        return np.stack((1.0 - rolled_share - 0.5 * midfoot_share, midfoot_share, forefoot_share - toes, toes))


def _equivalent_speed(stride: PlannedStride) -> float:
    """Return the speed, m/s, of level walking whose load has the same amplitude as in this stride."""
    amplitude = stride.style.load_amplitude
    return 1.3 * float(np.sqrt(amplitude / BOUNCE_AMPLITUDE)) if amplitude else stride.speed


def _hand_overs(plan: WalkPlan) -> tuple[list[tuple[float, ...]], list[tuple[float, ...]]]:
    """Return rows of hand-overs (start, end, share before, share after), and rows of beats.

    A row of a beat is its time, the speed that sets the amplitude, and the two times of `Loads.run_contacts`."""
    strides = sorted((s.heel_strike, foot.value, s, foot) for foot in Foot for s in plan.strides[foot])
    steps = [(stride, foot) for _, _, stride, foot in strides]
    hand_overs: list[tuple[float, ...]] = []
    beats: list[tuple[float, ...]] = []
    left_share = 0.5
    for start, end in plan.bouts:
        bout = [(stride, foot) for stride, foot in steps if start <= stride.heel_strike <= end]
        first, first_foot = bout[0]
        other_foot_share = 0.0 if first_foot is Foot.LEFT else 1.0
        hand_overs.append((start, first.toe_off, left_share, other_foot_share))
        beats.append((start, 0.0, 0.0, 0.0))
        left_share = other_foot_share
        for (stride, foot), (following, _) in zip(bout, bout[1:], strict=False):
            target_share = 1.0 if foot is Foot.LEFT else 0.0
            strike, off = stride.heel_strike, following.toe_off
            hand_overs.append((min(strike, off), max(strike, off), left_share, target_share))
            in_flight = off < strike
            if in_flight:
                # The step before this beat ends with a take-off, the step after it starts with a landing.
                beats[-1] = (*beats[-1][:3], off)
            beats.append((0.5 * (strike + off), _equivalent_speed(stride), strike if in_flight else 0.0, 0.0))
            left_share = target_share
        last, _ = bout[-1]
        # The closing foot first takes a little more than half of the weight, as in a step, and then half of it.
        caught_time, settled_time = last.heel_strike + CATCH_TIME, last.heel_strike + SETTLE_TIME
        overshoot_share = 0.6 if left_share == 0.0 else 0.4
        hand_overs.append((last.heel_strike, caught_time, left_share, overshoot_share))
        hand_overs.append((caught_time, settled_time, overshoot_share, 0.5))
        beats.append((last.heel_strike + 0.5 * SETTLE_TIME, 0.0, 0.0, 0.0))
        left_share = 0.5
    return hand_overs, beats


def _stances(plan: WalkPlan, foot: Foot) -> Array:
    strides = plan.strides[foot]
    landings = [(-_FOREVER, -_FOREVER), *((s.heel_strike, s.foot_flat) for s in strides)]
    departures = [*((s.heel_off, s.toe_off) for s in strides), (_FOREVER, _FOREVER + 1.0)]
    return np.array([(*land, *leave) for land, leave in zip(landings, departures, strict=True)])


def _lateral_shifts(plan: WalkPlan, foot: Foot, wearer: Wearer, rng: Rng) -> Array:
    """Return for every stance the shifts to the left, m, and the last heel-strike of its bout, s."""
    rows = [(0.0, 0.0, -_FOREVER)]
    for stride in plan.strides[foot]:
        last_heel_strike = next(end for start, end in plan.bouts if start <= stride.heel_strike <= end) - SETTLE_TIME
        shift = -LOAD_SHIFT_SHARE * wearer.centre_height * stride.step_speed**2 * stride.curvature / GRAVITY
        rows.append((shift, wearer.load_variation * float(rng.standard_normal()), last_heel_strike))
    return np.array(rows)

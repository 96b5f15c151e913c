"""Scores heel-strike and toe-off against labels, switches and force. Scorers have the form described in datasets.py."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, pi
from pathlib import Path
from statistics import fmean, pstdev

import numpy as np

from solepath.events import HeelStrike, ToeOff
from solepath.types import Foot, Turn
from solepath.validate.alignment import at_times
from solepath.validate.foot_run import FootRun
from solepath.validate.matching import TOLERANCE, Errors, Matching, interval_errors, match

from ..measures.contacts import force_contacts, is_loaded, merged, switch_contacts
from ..measures.drift import drift_figures, drift_of_strides
from ..measures.legs import leg_errors, turn_times
from ..measures.score import Figures, Scored
from ..measures.strides import StrideScore, stride_score
from .insoles import force_sensors, switches
from .run import Meta, RecordingRun, RunSettings, run, truth_of

LEG_LENGTH = 10.0
"""Length of a leg in ipol_10m_uturn and gaitmap_examples, m."""
LEG_COUNT = 4
"""Number of legs in gaitmap_examples."""
LONGEST_STRIDE_TIME = 2.5
"""Longest stride time, s. Between heel-strikes further apart the foot stood still, or strides were not labelled."""


def score_swings(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against labels of every swing, from toe-off to heel-strike, and of the U-turn.

    The first leg goes from the start of the walk to the middle of the turn, the second one from there to the end. Legs
    are measured for each foot (leg) and for the wearer's position (body_leg). The wearer's position ends where it
    started. A foot does not: at the end the wearer faces the other way, so the feet have exchanged their places."""
    truth, result = truth_of(path), run(path, settings, body=True)
    swings = {foot: truth[f"gt_{foot.value}"] for foot in result.feet}
    heel_strikes = {foot: labels[:, 1].tolist() for foot, labels in swings.items()}
    t_start, t_end = truth["gt_trial"].tolist()
    times, lengths = [t_start, float(truth["gt_uturn"].mean()), t_end], [LEG_LENGTH, LEG_LENGTH]
    return Scored(
        path.stem,
        figures=_turn_figures(truth["gt_uturn"].tolist(), result) | _closing_figures(result, t_start, t_end),
        events=_contact_matches(result, heel_strikes, {foot: labels[:, 0].tolist() for foot, labels in swings.items()}),
        errors={
            "leg": sum([leg_errors(times, lengths, foot_run) for foot_run in result.feet.values()], Errors()),
            "body_leg": leg_errors(times, lengths, result.body),
            "stride_time": _stride_time_errors(result, heel_strikes),
        },
    )


EventTimes = Mapping[Foot, list[float]]
"""Times of the true heel-strikes, or of the true toe-offs, of each foot that has a truth, s."""


def _contact_matches(result: RecordingRun, heel_strikes: EventTimes, toe_offs: EventTimes) -> dict[str, Matching]:
    strikes = [match(true, result.feet[foot].times[HeelStrike]) for foot, true in heel_strikes.items()]
    offs = [match(true, result.feet[foot].times[ToeOff]) for foot, true in toe_offs.items()]
    return {"heel_strike": sum(strikes, Matching()), "toe_off": sum(offs, Matching())}


def _stride_time_errors(result: RecordingRun, heel_strikes: EventTimes) -> Errors:
    found = [(true, result.feet[foot].times[HeelStrike]) for foot, true in heel_strikes.items()]
    return sum([interval_errors(true, ours, longest=LONGEST_STRIDE_TIME) for true, ours in found], Errors())


def _closing_figures(result: RecordingRun, t_start: float, t_end: float) -> Figures:
    """Return the distance between the wearer's positions at `t_start` and `t_end` s, horizontal and in height, m."""
    if not len(result.body.t):
        return {}
    first, last = at_times(result.body.t, result.body.positions, np.array([t_start, t_end]))
    return {"end_error_2d": hypot(last[0] - first[0], last[1] - first[1]), "end_height": abs(float(last[2] - first[2]))}


def _turn_figures(span: list[float], result: RecordingRun) -> Figures:
    """Return the figures of the one U-turn that the wearer makes in the labelled `span`, s.

    The U-turn counts as found when a reported U-turn overlaps the span. The angle error, rad, is the difference
    between pi and the largest angle of a turn that overlaps the span, or pi without such a turn. Reported U-turns that
    do not overlap the span are invented."""
    t_start, t_end = span
    overlapping = [turn for turn in result.walk.made_turns if turn.t >= t_start and turn.t_start <= t_end]
    n_about = sum(turn.turn is Turn.ABOUT for turn in result.walk.made_turns)
    found = any(turn.turn is Turn.ABOUT for turn in overlapping)
    angle = max([abs(turn.angle) for turn in overlapping], default=0.0)
    return {
        "uturn_found": float(found),
        "uturn_angle": abs(pi - angle),
        "uturn_invented": float(n_about - sum(turn.turn is Turn.ABOUT for turn in overlapping)),
    }


def score_borders(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score heel-strikes and stride times, which are known only while the cameras see the walker, and legs.

    The walk has four legs to and fro. The times of the U-turns are not known, so each track is cut at its own turns
    (legs.turn_times). The protocol says that a leg is 10 m; nobody measured it. `leg_spread` does not depend on that
    length: it is the standard deviation of a foot's four legs relative to their mean, averaged over the feet."""
    truth, result = truth_of(path), run(path, settings, body=True)
    heel_strike, stride_times = Matching(), Errors()
    for foot, foot_run in result.feet.items():
        borders = [(float(a), float(b)) for a, b in truth[f"gt_borders_{foot.value}"]]
        visible = merged(borders)
        # a border that two strides share is one heel-strike
        heel_strikes = [at for at, _ in merged([(at, at) for border in borders for at in border])]
        heel_strike += match(heel_strikes, foot_run.times[HeelStrike], windows=visible)
        stride_times += interval_errors(heel_strikes, foot_run.times[HeelStrike], longest=LONGEST_STRIDE_TIME)
    feet = [_turned_legs(foot_run) for foot_run in result.feet.values() if len(foot_run.t)]
    spreads = [pstdev(errors.values) / (1.0 + fmean(errors.values)) for errors in feet]
    figures: Figures = {"leg_spread": fmean(spreads) if spreads else None}
    body_legs = Errors()
    if len(result.body.t):
        figures |= _closing_figures(result, float(result.body.t[0]), float(result.body.t[-1]))
        body_legs = _turned_legs(result.body)
    errors = {"leg": sum(feet, Errors()), "body_leg": body_legs, "stride_time": stride_times}
    return Scored(path.stem, figures=figures, events={"heel_strike": heel_strike}, errors=errors)


def _turned_legs(track: FootRun) -> Errors:
    """Return the relative errors of the legs between the turns of a track."""
    return leg_errors(turn_times(track, LEG_COUNT), [LEG_LENGTH] * LEG_COUNT, track)


def score_treadmill(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the contact times of a light barrier.

    Relative to the moving belt a standing foot does not move, so the stride lengths can be compared as they are.
    Positions in the laboratory cannot."""
    truth, result = truth_of(path), run(path, settings)
    strides, heel_strikes, toe_offs = StrideScore(), dict[Foot, list[float]](), dict[Foot, list[float]]()
    for foot, foot_run in result.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        strike_times = truth["gt_hs_t"][rows]
        heel_strikes[foot] = strike_times.tolist()
        toe_offs[foot] = (strike_times + truth["gt_contact_s"][rows]).tolist()
        # gt_stride_len[k] is of the stride that ends with heel-strike k; the found one ends at the foot-flat after that
        strides += stride_score(
            strike_times, truth["gt_stride_len"][rows][:-1], foot_run.stride_lengths, end_tolerance=-TOLERANCE
        )
    times = {"stride_time": _stride_time_errors(result, heel_strikes)}
    figures: Figures = {}
    feet = {foot: _drift_on_belt(one) for foot, one in result.feet.items()}
    for name in ("drift", "drift_stride"):
        known = [drift for one in feet.values() if (drift := one[name]) is not None]
        figures[name] = float(np.mean(known)) if known else None
    figures |= {f"drift_{foot.value}": one["drift"] for foot, one in feet.items()}
    events = _contact_matches(result, heel_strikes, toe_offs)
    return Scored(path.stem, figures=figures, events=events, strides=strides, errors=times)


def _drift_on_belt(run: FootRun) -> Figures:
    """Return the drift of a foot whose way over the belt is straight."""
    t, lengths = [stride.t_end for stride in run.strides], [stride.length for stride in run.strides]
    if len(t) < 2:
        return drift_figures(None, np.array(t))
    straight, ends = np.column_stack([np.cumsum(lengths), np.zeros(len(t))]), np.array(t)
    return drift_figures(drift_of_strides(ends, at_times(run.t, run.positions, ends), straight), ends)


def score_switches(path: Path, meta: Meta, settings: RunSettings, pressed: bool = False) -> Scored:
    """Score against the switches and, on a straight walk, against its length.

    A toe-off is the opening of the toe switch while the heel switch bears no load. A foot whose heel is on the ground
    does not leave it: so a standing wearer opens the toe switch, whose gyroscopes show no motion.

    The leg of a foot goes from its first to its last position. The wearer stood at both ends of the walk, but nobody
    recorded how near to the ends of the measured way.

    With `pressed`, the session receives the switches as an insole of two cells, otherwise inertial samples only."""
    truth = truth_of(path)
    result = run(path, settings, calibration=switches()) if pressed else run(path, settings, without_pressure=True)
    heel_strikes, toe_offs, legs = dict[Foot, list[float]](), dict[Foot, list[float]](), Errors()
    for foot, foot_run in result.feet.items():
        t, counts = truth[f"t_{foot.value}"], truth[f"pressure_{foot.value}"]
        if heel := switch_contacts(t, counts[:, 1]):
            heel_strikes[foot] = [start for start, _ in heel]
        if toe := switch_contacts(t, counts[:, 0]):
            toe_offs[foot] = [end for _, end in toe if not is_loaded(t, counts[:, 1], end)]
        if "straight_path_m" in meta and len(foot_run.t):
            legs += leg_errors(foot_run.t[[0, -1]], [float(meta["straight_path_m"])], foot_run)
    errors = {"leg": legs} if legs.values else {}
    return Scored(path.stem, events=_contact_matches(result, heel_strikes, toe_offs), errors=errors)


def score_force(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the force below each foot. The session receives only its eight sensors."""
    truth, result = truth_of(path), run(path, settings, calibration=force_sensors())
    forces = {foot: truth[f"pressure_{foot.value}"].sum(axis=1) for foot in result.feet}
    spans = {foot: force_contacts(truth["t"], force) for foot, force in forces.items()}
    heel_strikes = {foot: [start for start, _ in contacts] for foot, contacts in spans.items()}
    toe_offs = {foot: [end for _, end in contacts] for foot, contacts in spans.items()}
    return Scored(path.stem, events=_contact_matches(result, heel_strikes, toe_offs))


def score_insoles(path: Path, meta: Meta, settings: RunSettings, pressed: bool = False) -> Scored:
    """Score against the contacts and strides of the vendor.

    With `pressed`, the session receives the pressure too. It has to learn the layout of the cells, which is not
    known."""
    truth, strides, result = truth_of(path), StrideScore(), run(path, settings, without_pressure=not pressed)
    heel_strikes = {foot: truth[f"gt_ic_{foot.value}"].tolist() for foot in result.feet}
    toe_offs = {foot: truth[f"gt_to_{foot.value}"].tolist() for foot in result.feet}
    for foot, foot_run in result.feet.items():
        # gt_stride_length_*[k] is of the stride that starts with contact k; the found one ends after contact k + 1
        lengths = np.roll(truth[f"gt_stride_length_{foot.value}"], 1)[:-1]
        strides += stride_score(
            np.array(heel_strikes[foot]), lengths, foot_run.stride_lengths, end_tolerance=-TOLERANCE
        )
    times = {"stride_time": _stride_time_errors(result, heel_strikes)}
    return Scored(path.stem, events=_contact_matches(result, heel_strikes, toe_offs), strides=strides, errors=times)


def score_soles(path: Path, meta: Meta, settings: RunSettings, first: int = 0) -> Scored:
    """Score a sole of two cells of unknown places against contacts of the left foot, by speed of the belt.

    The truth is another program's. The contacts before number `first` of the recording, from 0, are left out."""
    truth, result = truth_of(path), run(path, settings, poses=False)
    strikes, offs = (truth[f"gt_{name}_left"].tolist()[first:] for name in ("heel_strike", "toe_off"))
    events = _contact_matches(result, {Foot.LEFT: strikes}, {Foot.LEFT: offs})
    return Scored(path.stem, events=events, groups=("all", f"{meta['speed_kmh']} km/h"))

"""Scores heel-strike and toe-off against labels, switches and force. Scorers have the form described in datasets.py."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot, pi
from pathlib import Path
from statistics import fmean, pstdev

import numpy as np

from ...events import HeelStrike, ToeOff
from ...types import Foot, Turn
from ..measures.alignment import at_times
from ..measures.contacts import force_contacts, merged, switch_contacts
from ..measures.legs import leg_errors, turned_about
from ..measures.matching import TOLERANCE, Errors, Matching, interval_errors, match
from ..measures.score import Figures, Scored
from ..measures.strides import StrideScore, stride_score
from .insoles import force_sensors, switches
from .run import Meta, RecordingRun, RunSettings, run, scored, truth_of

LEG = 10.0
"""Length of a leg in ipol_10m_uturn and gaitmap_examples, m."""
LEGS = 4
"""Number of legs in gaitmap_examples."""
LONGEST = 2.5
"""Longest stride, s; between heel-strikes further apart the foot stood still, or strides were not labelled."""


def score_swings(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against labels of every swing, which starts with toe-off and ends with heel-strike, and of the turn.

    One leg goes from the start of the walk to the middle of the turn, the other from there to the end of the walk. They
    are measured for each foot (leg) and for the session's position (body_leg). Both together are a closed loop, except
    that the wearer faces the other way at the end, with each foot beside the place where it started."""
    truth, result = truth_of(path), run(path, settings, body=True)
    swings = {foot: truth[f"gt_{foot.value}"] for foot in result.feet}
    strikes = {foot: of[:, 1].tolist() for foot, of in swings.items()}
    t_start, t_end = truth["gt_trial"].tolist()
    times, body = [t_start, float(truth["gt_uturn"].mean()), t_end], result.body
    legs = [leg_errors(times, [LEG, LEG], ran.t, ran.positions) for ran in result.feet.values()]
    of_body = Errors() if body is None else leg_errors(times, [LEG, LEG], body.t, body.positions)
    return scored(
        path,
        result,
        figures=_about_turn(truth["gt_uturn"].tolist(), result) | _ends(result, t_start, t_end),
        events=_contacts(result, strikes, {foot: of[:, 0].tolist() for foot, of in swings.items()}),
        errors={"leg": sum(legs, Errors()), "body_leg": of_body, "stride_time": _stride_times(result, strikes)},
    )


Contacts = Mapping[Foot, list[float]]
"""The true heel-strikes, or toe-offs, of each foot for which they are known, s."""


def _contacts(result: RecordingRun, strikes: Contacts, offs: Contacts) -> dict[str, Matching]:
    struck = [match(true, result.feet[foot].times[HeelStrike]) for foot, true in strikes.items()]
    left = [match(true, result.feet[foot].times[ToeOff]) for foot, true in offs.items()]
    return {"heel_strike": sum(struck, Matching()), "toe_off": sum(left, Matching())}


def _stride_times(result: RecordingRun, strikes: Contacts) -> Errors:
    found = [(true, result.feet[foot].times[HeelStrike]) for foot, true in strikes.items()]
    return sum([interval_errors(true, ours, longest=LONGEST) for true, ours in found], Errors())


def _ends(result: RecordingRun, t_start: float, t_end: float) -> Figures:
    """Return the distance of the wearer's last position from the first, horizontally and in height, m."""
    if result.body is None:
        return {}
    first, last = at_times(result.body.t, result.body.positions, np.array([t_start, t_end]))
    return {"end_error_2d": hypot(last[0] - first[0], last[1] - first[1]), "end_height": abs(float(last[2] - first[2]))}


def _about_turn(span: list[float], result: RecordingRun) -> Figures:
    """Return the figures of the one turn about that the wearer makes in the labelled `span`, s.

    It is found when a reported turn about overlaps the span. The angle error is the difference of the largest
    overlapping turn from half a turn (of 0 where no turn was reported). Turns about elsewhere are invented."""
    t_start, t_end = span
    there = [turn for turn in result.gathering.turns if turn.t >= t_start and turn.t_start <= t_end]
    about = sum(turn.turn is Turn.ABOUT for turn in result.gathering.turns)
    found = any(turn.turn is Turn.ABOUT for turn in there)
    angle = max([abs(turn.angle) for turn in there], default=0.0)
    return {
        "uturn_found": float(found),
        "uturn_angle": abs(pi - angle),
        "uturn_invented": float(about - sum(turn.turn is Turn.ABOUT for turn in there)),
    }


def score_borders(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score strides from heel-strike to heel-strike, known only while the walker is in view of the cameras.

    The walk has four legs to and fro. The times of the turns are not known, so each track is cut where the track itself
    turns about (legs.turned_about); only the protocol says that a leg is 10 m. The difference between the legs needs no
    such length: `leg_spread` is the standard deviation of a foot's four legs relative to their mean, averaged over the
    feet."""
    truth, result = truth_of(path), run(path, settings, body=True)
    heel_strike, strides = Matching(), Errors()
    for foot, ran in result.feet.items():
        borders = [(float(a), float(b)) for a, b in truth[f"gt_borders_{foot.value}"]]
        seen = merged(borders)
        # a border that two strides share is one heel-strike
        strikes = [at for at, _ in merged([(at, at) for border in borders for at in border])]
        heel_strike += match(strikes, ran.times[HeelStrike], windows=seen)
        strides += interval_errors(strikes, ran.times[HeelStrike], longest=LONGEST)
    tracks = [track for track in (*result.feet.values(), result.body) if track is not None and len(track.t)]
    legs = [leg_errors(turned_about(one.t, one.positions, LEGS), [LEG] * LEGS, one.t, one.positions) for one in tracks]
    each, body = (legs, Errors()) if result.body is None else (legs[:-1], legs[-1])
    spreads = [pstdev(errors.values) / (1.0 + fmean(errors.values)) for errors in each]
    figures: Figures = {"leg_spread": fmean(spreads) if spreads else None}
    if result.body is not None:
        figures |= _ends(result, float(result.body.t[0]), float(result.body.t[-1]))
    errors = {"leg": sum(each, Errors()), "body_leg": body, "stride_time": strides}
    return scored(path, result, figures=figures, events={"heel_strike": heel_strike}, errors=errors)


def score_treadmill(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the contact times of a light barrier.

    The belt is an inertial frame in which the standing foot does not move, so stride lengths compare as they are;
    positions in the room do not."""
    truth, result = truth_of(path), run(path, settings)
    strides, strikes, offs = StrideScore(), dict[Foot, list[float]](), dict[Foot, list[float]]()
    for foot, ran in result.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        struck = truth["gt_hs_t"][rows]
        strikes[foot], offs[foot] = struck.tolist(), (struck + truth["gt_contact_s"][rows]).tolist()
        # our stride ends at the foot-flat after the true one's heel-strike, well before the next heel-strike
        strides += stride_score(struck, truth["gt_stride_len"][rows][:-1], ran.step_lengths, slack=-TOLERANCE)
    times = {"stride_time": _stride_times(result, strikes)}
    return scored(path, result, events=_contacts(result, strikes, offs), strides=strides, errors=times)


def score_switches(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against heel and toe switches under the foot.

    The session receives no pressure, because the switches are the truth."""
    return _against_switches(path, meta, run(path, settings, without_pressure=True))


def score_pressed(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score a session that uses the switches as an insole of two cells, against the same switches."""
    return _against_switches(path, meta, run(path, settings, calibration=switches()))


def _against_switches(path: Path, meta: Meta, result: RecordingRun) -> Scored:
    """Score against the switches, and against the walked length of a straight walk.

    On a straight walk of known length the way of each foot from its first to its last position is a leg. The wearer
    stood at both ends, but nobody recorded how near to the lines."""
    truth = truth_of(path)
    strikes, offs, legs = dict[Foot, list[float]](), dict[Foot, list[float]](), Errors()
    for foot, ran in result.feet.items():
        t, counts = truth[f"t_{foot.value}"], truth[f"pressure_{foot.value}"]
        if heel := switch_contacts(t, counts[:, 1]):
            strikes[foot] = [start for start, _ in heel]
        if toe := switch_contacts(t, counts[:, 0]):
            offs[foot] = [end for _, end in toe]
        if "straight_path_m" in meta and len(ran.t):
            ends = [float(ran.t[0]), float(ran.t[-1])]
            legs += leg_errors(ends, [float(meta["straight_path_m"])], ran.t, ran.positions)
    errors = {"leg": legs} if legs.values else {}
    return scored(path, result, events=_contacts(result, strikes, offs), errors=errors)


def score_force(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the force below each foot. The session receives only its eight sensors."""
    truth, result = truth_of(path), run(path, settings, calibration=force_sensors())
    forces = {foot: truth[f"pressure_{foot.value}"].sum(axis=1) for foot in result.feet}
    spans = {foot: force_contacts(truth["t"], force) for foot, force in forces.items()}
    strikes = {foot: [start for start, _ in of] for foot, of in spans.items()}
    offs = {foot: [end for _, end in of] for foot, of in spans.items()}
    return scored(path, result, events=_contacts(result, strikes, offs))

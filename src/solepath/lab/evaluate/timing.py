"""Scores of heel-strike and toe-off against labels, switches and force. Scorers are as datasets.py says."""

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
"""m of ipol_10m_uturn and gaitmap_examples."""
LEGS = 4
"""of gaitmap_examples."""
LONGEST = 2.5
"""s that a stride may take; between heel-strikes further apart the foot rested, or strides were not labelled."""


def score_swings(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """Labels of every swing: it starts with toe-off and ends with heel-strike. And of the walk and its turn: a leg is
    from the beginning of the walk to the middle of the turn, the other from there to the end of the walk, by each foot
    (leg) and by the session's position (body_leg). Both together are a closed loop, but that the wearer stands the
    other way round, with each foot beside where it began."""
    truth, went = truth_of(path), run(path, how, body=True)
    swings = {foot: truth[f"gt_{foot.value}"] for foot in went.feet}
    strikes = {foot: of[:, 1].tolist() for foot, of in swings.items()}
    began, ended = truth["gt_trial"].tolist()
    times, body = [began, float(truth["gt_uturn"].mean()), ended], went.body
    legs = [leg_errors(times, [LEG, LEG], ran.t, ran.positions) for ran in went.feet.values()]
    of_body = Errors() if body is None else leg_errors(times, [LEG, LEG], body.t, body.positions)
    return scored(
        path,
        went,
        figures=_about_turn(truth["gt_uturn"].tolist(), went) | _ends(went, began, ended),
        events=_contacts(went, strikes, {foot: of[:, 0].tolist() for foot, of in swings.items()}),
        errors={"leg": sum(legs, Errors()), "body_leg": of_body, "stride_time": _stride_times(went, strikes)},
    )


Contacts = Mapping[Foot, list[float]]
"""The true heel-strikes, or toe-offs, of each foot of which they are known, s."""


def _contacts(went: RecordingRun, strikes: Contacts, offs: Contacts) -> dict[str, Matching]:
    struck = [match(true, went.feet[foot].times[HeelStrike]) for foot, true in strikes.items()]
    left = [match(true, went.feet[foot].times[ToeOff]) for foot, true in offs.items()]
    return {"heel_strike": sum(struck, Matching()), "toe_off": sum(left, Matching())}


def _stride_times(went: RecordingRun, strikes: Contacts) -> Errors:
    found = [(true, went.feet[foot].times[HeelStrike]) for foot, true in strikes.items()]
    return sum([interval_errors(true, ours, longest=LONGEST) for true, ours in found], Errors())


def _ends(went: RecordingRun, began: float, ended: float) -> Figures:
    """How far the wearer's position is at the end from where it was at the beginning, horizontally, and how much higher
    or lower, m."""
    if went.body is None:
        return {}
    first, last = at_times(went.body.t, went.body.positions, np.array([began, ended]))
    return {"end_error_2d": hypot(last[0] - first[0], last[1] - first[1]), "end_height": abs(float(last[2] - first[2]))}


def _about_turn(span: list[float], went: RecordingRun) -> Figures:
    """The wearer turned about once, in the `span` that is labelled, s. Found: an about turn was told that shares some
    of it. Its angle is that of the largest turn that does, by how much it differs from half a turn (from 0 where none
    was told). Invented: about turns elsewhere."""
    began, ended = span
    there = [turn for turn in went.said.turns if turn.t >= began and turn.t_start <= ended]
    about = sum(turn.turn is Turn.ABOUT for turn in went.said.turns)
    found = any(turn.turn is Turn.ABOUT for turn in there)
    angle = max([abs(turn.angle) for turn in there], default=0.0)
    return {
        "uturn_found": float(found),
        "uturn_angle": abs(pi - angle),
        "uturn_invented": float(about - sum(turn.turn is Turn.ABOUT for turn in there)),
    }


def score_borders(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """Strides from heel-strike to heel-strike, known only while the walker is in view of the cameras. Four legs to and
    fro: nothing says when the walker turned, so each track is cut where itself turned about (legs.turned_about), and
    that it is 10 m from there to there only the protocol says. By how much the legs differ among themselves needs no
    such number: `leg_spread` is the standard deviation of a foot's four legs relative to their mean, averaged over
    the feet."""
    truth, went = truth_of(path), run(path, how, body=True)
    heel_strike, strides = Matching(), Errors()
    for foot, ran in went.feet.items():
        borders = [(float(a), float(b)) for a, b in truth[f"gt_borders_{foot.value}"]]
        seen = merged(borders)
        # a border that two strides share is one heel-strike
        strikes = [at for at, _ in merged([(at, at) for border in borders for at in border])]
        heel_strike += match(strikes, ran.times[HeelStrike], windows=seen)
        strides += interval_errors(strikes, ran.times[HeelStrike], longest=LONGEST)
    tracks = [track for track in (*went.feet.values(), went.body) if track is not None and len(track.t)]
    legs = [leg_errors(turned_about(one.t, one.positions, LEGS), [LEG] * LEGS, one.t, one.positions) for one in tracks]
    each, body = (legs, Errors()) if went.body is None else (legs[:-1], legs[-1])
    spreads = [pstdev(errors.values) / (1.0 + fmean(errors.values)) for errors in each]
    figures: Figures = {"leg_spread": fmean(spreads) if spreads else None}
    if went.body is not None:
        figures |= _ends(went, float(went.body.t[0]), float(went.body.t[-1]))
    errors = {"leg": sum(each, Errors()), "body_leg": body, "stride_time": strides}
    return scored(path, went, figures=figures, events={"heel_strike": heel_strike}, errors=errors)


def score_treadmill(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """Contact times of a light barrier. The belt is an inertial frame of its own, in which the standing foot rests, so
    stride lengths compare as they are; positions in the room do not."""
    truth, went = truth_of(path), run(path, how)
    strides, strikes, offs = StrideScore(), dict[Foot, list[float]](), dict[Foot, list[float]]()
    for foot, ran in went.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        struck = truth["gt_hs_t"][rows]
        strikes[foot], offs[foot] = struck.tolist(), (struck + truth["gt_contact_s"][rows]).tolist()
        # the stride that a heel-strike ends, ours ending at the foot-flat after it: well before the next heel-strike
        strides += stride_score(struck, truth["gt_stride_len"][rows][:-1], ran.step_lengths, slack=-TOLERANCE)
    times = {"stride_time": _stride_times(went, strikes)}
    return scored(path, went, events=_contacts(went, strikes, offs), strides=strides, errors=times)


def score_switches(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """Heel and toe switches under the foot are the truth here, so the session does without them."""
    return _against_switches(path, meta, run(path, how, without_pressure=True))


def score_pressed(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """The same switches as the pressure cells of an insole of two: what a session makes of them, against themselves."""
    return _against_switches(path, meta, run(path, how, calibration=switches()))


def _against_switches(path: Path, meta: Meta, went: RecordingRun) -> Scored:
    """Where it was a straight walk of a known length, each foot's way from its first to its last position is a leg: the
    wearer stood at both ends, but nobody wrote down how near to the lines."""
    truth = truth_of(path)
    strikes, offs, legs = dict[Foot, list[float]](), dict[Foot, list[float]](), Errors()
    for foot, ran in went.feet.items():
        t, counts = truth[f"t_{foot.value}"], truth[f"pressure_{foot.value}"]
        if heel := switch_contacts(t, counts[:, 1]):
            strikes[foot] = [begin for begin, _ in heel]
        if toe := switch_contacts(t, counts[:, 0]):
            offs[foot] = [end for _, end in toe]
        if "straight_path_m" in meta and len(ran.t):
            ends = [float(ran.t[0]), float(ran.t[-1])]
            legs += leg_errors(ends, [float(meta["straight_path_m"])], ran.t, ran.positions)
    errors = {"leg": legs} if legs.values else {}
    return scored(path, went, events=_contacts(went, strikes, offs), errors=errors)


def score_force(path: Path, meta: Meta, how: RunSettings) -> Scored:
    """The force below each foot is the truth of contact, and its eight sensors are all that the session gets."""
    truth, went = truth_of(path), run(path, how, calibration=force_sensors())
    forces = {foot: truth[f"pressure_{foot.value}"].sum(axis=1) for foot in went.feet}
    spans = {foot: force_contacts(truth["t"], force) for foot, force in forces.items()}
    strikes = {foot: [begin for begin, _ in of] for foot, of in spans.items()}
    offs = {foot: [end for _, end in of] for foot, of in spans.items()}
    return scored(path, went, events=_contacts(went, strikes, offs))

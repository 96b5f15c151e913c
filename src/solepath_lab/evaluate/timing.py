"""Scores heel-strike and toe-off against labels, switches and force. Scorers have the form described in datasets.py."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot, pi
from pathlib import Path
from statistics import fmean, pstdev

import numpy as np
from attrs import frozen

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
from .run import Arrays, Meta, RecordingRun, RunSettings, run, truth_of

LEG_LENGTH = 10.0
"""Length of a leg in ipol_10m_uturn and gaitmap_examples, m."""
LEG_COUNT = 4
"""Number of legs in gaitmap_examples."""
LONGEST_STRIDE_TIME = 2.5
"""Longest stride time, s. Between heel-strikes further apart the foot stood still, or strides were not labelled."""


@frozen
class Contacts:
    """True contacts of a foot, s."""

    strikes: list[float]
    """Heel-strikes; none where the reference has none of this foot."""
    offs: list[float]
    """Toe-offs."""
    lengths: Mapping[float, float] = {}
    """Lengths of the cycles, m, by the heel-strikes with which they start, where they are known."""


FeetContacts = dict[Foot, Contacts]


def _labelled(truth: Arrays) -> FeetContacts:
    """Return the labels of ipol_10m_uturn, by hand."""
    return {foot: Contacts(*[truth[f"gt_{foot}"][:, i].tolist() for i in (1, 0)]) for foot in Foot}


def _on_treadmill(truth: Arrays) -> FeetContacts:
    """Return the contacts of a light barrier; a length in the file is of the cycle that ends with its heel-strike."""
    feet = {}
    for foot, number in ((Foot.LEFT, 0), (Foot.RIGHT, 1)):
        rows = truth["gt_foot"] == number
        strikes, lengths = truth["gt_hs_t"][rows], truth["gt_stride_len"][rows].tolist()
        starts = dict(zip(strikes.tolist(), lengths[1:], strict=False))
        feet[foot] = Contacts(strikes.tolist(), (strikes + truth["gt_contact_s"][rows]).tolist(), starts)
    return feet


def _switched(truth: Arrays) -> FeetContacts:
    """Return the contacts of the switches below heel and toes.

    A toe-off is the opening of the toe switch while the heel switch bears no load. A foot whose heel is on the ground
    does not leave it: so a standing wearer opens the toe switch, whose gyroscopes show no motion."""
    feet = {}
    for foot in Foot:
        t, counts = truth[f"t_{foot}"], truth[f"pressure_{foot}"]
        strikes = [start for start, _ in switch_contacts(t, counts[:, 1]) or []]
        ends = [end for _, end in switch_contacts(t, counts[:, 0]) or []]
        feet[foot] = Contacts(strikes, [end for end in ends if not is_loaded(t, counts[:, 1], end)])
    return feet


def _by_vendor(truth: Arrays) -> FeetContacts:
    """Return the contacts of the vendor; a length is of the cycle that starts with its heel-strike."""
    feet = {}
    for foot in Foot:
        strikes = truth[f"gt_ic_{foot}"].tolist()
        lengths = dict(zip(strikes, truth[f"gt_stride_length_{foot}"].tolist(), strict=False))
        feet[foot] = Contacts(strikes, truth[f"gt_to_{foot}"].tolist(), lengths)
    return feet


def _by_force(truth: Arrays) -> FeetContacts:
    """Return the contacts by the force below each foot."""
    spans = {foot: force_contacts(truth["t"], truth[f"pressure_{foot}"].sum(axis=1)) for foot in Foot}
    return {
        foot: Contacts([start for start, _ in contacts], [end for _, end in contacts])
        for foot, contacts in spans.items()
    }


CONTACTS: dict[str, Callable[[Arrays], FeetContacts]] = {
    "ipol_10m_uturn": _labelled,
    "tripod_treadmill": _on_treadmill,
    "marpino_heel_toe": _switched,
    "moticon_opengo": _by_vendor,
    "gaitpdb_vgrf": _by_force,
}
"""Contacts of both feet in the truth of a data set, by the name of its folder."""


def score_swings(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against labels of every swing, from toe-off to heel-strike, and of the U-turn.

    The first leg goes from the start of the walk to the middle of the turn, the second one from there to the end. Legs
    are measured for each foot (leg) and for the wearer's position (body_leg). The wearer's position ends where it
    started. A foot does not: at the end the wearer faces the other way, so the feet have exchanged their places."""
    truth, result = truth_of(path), run(path, settings, body=True)
    feet = _labelled(truth)
    t_start, t_end = truth["gt_trial"].tolist()
    times, lengths = [t_start, float(truth["gt_uturn"].mean()), t_end], [LEG_LENGTH, LEG_LENGTH]
    return Scored(
        path.stem,
        figures=_turn_figures(truth["gt_uturn"].tolist(), result) | _closing_figures(result, t_start, t_end),
        events=_contact_matches(result, feet),
        errors={
            "leg": sum([leg_errors(times, lengths, foot_run) for foot_run in result.feet.values()], Errors()),
            "body_leg": leg_errors(times, lengths, result.body),
            "stride_time": _stride_time_errors(result, feet),
        },
    )


def _contact_matches(result: RecordingRun, feet: FeetContacts) -> dict[str, Matching]:
    """Return the matches of the contacts that are known of the feet that were run."""
    known = [(true, result.feet[foot].times) for foot, true in feet.items() if foot in result.feet]
    strikes = [match(true.strikes, ours[HeelStrike]) for true, ours in known if true.strikes]
    offs = [match(true.offs, ours[ToeOff]) for true, ours in known if true.offs]
    return {"heel_strike": sum(strikes, Matching()), "toe_off": sum(offs, Matching())}


def _stride_time_errors(result: RecordingRun, feet: FeetContacts) -> Errors:
    found = [(true.strikes, result.feet[foot].times[HeelStrike]) for foot, true in feet.items() if foot in result.feet]
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
    strides, contacts = StrideScore(), _on_treadmill(truth)
    for foot, foot_run in result.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        # gt_stride_len[k] is of the stride that ends with heel-strike k; the found one ends at the foot-flat after that
        strides += stride_score(
            truth["gt_hs_t"][rows], truth["gt_stride_len"][rows][:-1], foot_run.stride_lengths, end_tolerance=-TOLERANCE
        )
    times = {"stride_time": _stride_time_errors(result, contacts)}
    figures: Figures = {}
    feet = {foot: _drift_on_belt(one) for foot, one in result.feet.items()}
    for name in ("drift", "drift_stride"):
        known = [drift for one in feet.values() if (drift := one[name]) is not None]
        figures[name] = float(np.mean(known)) if known else None
    figures |= {f"drift_{foot.value}": one["drift"] for foot, one in feet.items()}
    events = _contact_matches(result, contacts)
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

    The leg of a foot goes from its first to its last position. The wearer stood at both ends of the walk, but nobody
    recorded how near to the ends of the measured way.

    With `pressed`, the session receives the switches as an insole of two cells, otherwise inertial samples only."""
    truth = truth_of(path)
    result = run(path, settings, calibration=switches()) if pressed else run(path, settings, without_pressure=True)
    legs = Errors()
    for foot_run in result.feet.values():
        if "straight_path_m" in meta and len(foot_run.t):
            legs += leg_errors(foot_run.t[[0, -1]], [float(meta["straight_path_m"])], foot_run)
    errors = {"leg": legs} if legs.values else {}
    return Scored(path.stem, events=_contact_matches(result, _switched(truth)), errors=errors)


def score_force(path: Path, meta: Meta, settings: RunSettings) -> Scored:
    """Score against the force below each foot. The session receives only its eight sensors."""
    truth, result = truth_of(path), run(path, settings, calibration=force_sensors())
    return Scored(path.stem, events=_contact_matches(result, _by_force(truth)))


def score_insoles(path: Path, meta: Meta, settings: RunSettings, pressed: bool = False) -> Scored:
    """Score against the contacts and strides of the vendor.

    With `pressed`, the session receives the pressure too. It has to learn the layout of the cells, which is not
    known."""
    truth, strides, result = truth_of(path), StrideScore(), run(path, settings, without_pressure=not pressed)
    contacts = _by_vendor(truth)
    for foot, foot_run in result.feet.items():
        # gt_stride_length_*[k] is of the stride that starts with contact k; the found one ends after contact k + 1
        lengths = np.roll(truth[f"gt_stride_length_{foot.value}"], 1)[:-1]
        strides += stride_score(
            np.array(contacts[foot].strikes), lengths, foot_run.stride_lengths, end_tolerance=-TOLERANCE
        )
    times = {"stride_time": _stride_time_errors(result, contacts)}
    return Scored(path.stem, events=_contact_matches(result, contacts), strides=strides, errors=times)


def score_soles(path: Path, meta: Meta, settings: RunSettings, first: int = 0) -> Scored:
    """Score a sole of two cells of unknown places against contacts of the left foot, by speed of the belt.

    The truth is another program's. The contacts before number `first` of the recording, from 0, are left out."""
    truth, result = truth_of(path), run(path, settings, poses=False)
    strikes, offs = (truth[f"gt_{name}_left"].tolist()[first:] for name in ("heel_strike", "toe_off"))
    events = _contact_matches(result, {Foot.LEFT: Contacts(strikes, offs)})
    return Scored(path.stem, events=events, groups=("all", f"{meta['speed_kmh']} km/h"))

"""Scores of heel-strike and toe-off against labels, switches and force. Scorers are as datasets.py says."""

from __future__ import annotations

from math import pi
from pathlib import Path

from ..types import Foot, Turn
from .contacts import force_contacts, merged, switch_contacts
from .insoles import force_sensors, switches
from .matching import TOLERANCE, Matching, match
from .recorded import Meta, scored, truth_of
from .run import How, Run, run
from .score import Figures, Scored
from .strides import StrideScore, stride_score


def score_swings(path: Path, meta: Meta, how: How) -> Scored:
    """Labels of every swing: it starts with toe-off and ends with heel-strike."""
    truth, went = truth_of(path), run(path, how)
    heel_strike, toe_off = Matching(), Matching()
    for foot, ran in went.feet.items():
        swings = truth[f"gt_{foot.value}"]
        toe_off += match(swings[:, 0].tolist(), ran.toe_offs)
        heel_strike += match(swings[:, 1].tolist(), ran.heel_strikes)
    figures = _about_turn([float(at) for at in truth["gt_uturn"]], went)
    return scored(path, went, figures=figures, events={"heel_strike": heel_strike, "toe_off": toe_off})


def _about_turn(span: list[float], went: Run) -> Figures:
    """The wearer turned about once, in the `span` that is labelled, s. Found: an about turn was told that shares some
    of it. Its angle is that of the largest turn that does, by how much it differs from half a turn (from 0 where none
    was told). Invented: about turns elsewhere."""
    began, ended = span
    there = [turn for turn in went.turns if turn.t >= began and turn.t_start <= ended]
    about = sum(turn.turn is Turn.ABOUT for turn in went.turns)
    found = any(turn.turn is Turn.ABOUT for turn in there)
    angle = max([abs(turn.angle) for turn in there], default=0.0)
    return {
        "uturn_found": float(found),
        "uturn_angle": abs(pi - angle),
        "uturn_invented": float(about - sum(turn.turn is Turn.ABOUT for turn in there)),
    }


def score_borders(path: Path, meta: Meta, how: How) -> Scored:
    """Strides from heel-strike to heel-strike, known only while the walker is in view of the cameras."""
    truth, went = truth_of(path), run(path, how)
    heel_strike = Matching()
    for foot, ran in went.feet.items():
        borders = [(float(a), float(b)) for a, b in truth[f"gt_borders_{foot.value}"]]
        seen = merged(borders)
        # a border that two strides share is one heel-strike
        strikes = [at for at, _ in merged([(at, at) for border in borders for at in border])]
        heel_strike += match(strikes, ran.heel_strikes, windows=seen)
    return scored(path, went, events={"heel_strike": heel_strike})


def score_treadmill(path: Path, meta: Meta, how: How) -> Scored:
    """Contact times of a light barrier. The belt is an inertial frame of its own, in which the standing foot rests, so
    stride lengths compare as they are; positions in the room do not."""
    truth, went = truth_of(path), run(path, how)
    heel_strike, toe_off, strides = Matching(), Matching(), StrideScore()
    for foot, ran in went.feet.items():
        rows = truth["gt_foot"] == (0 if foot is Foot.LEFT else 1)
        strikes = truth["gt_hs_t"][rows]
        heel_strike += match(strikes.tolist(), ran.heel_strikes)
        toe_off += match((strikes + truth["gt_contact_s"][rows]).tolist(), ran.toe_offs)
        # the stride that a heel-strike ends, ours ending at the foot-flat after it: well before the next heel-strike
        strides += stride_score(strikes, truth["gt_stride_len"][rows][:-1], ran.step_lengths, slack=-TOLERANCE)
    return scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off}, strides=strides)


def score_switches(path: Path, meta: Meta, how: How) -> Scored:
    """Heel and toe switches under the foot are the truth here, so the session does without them."""
    return _against_switches(path, run(path, how, without_pressure=True))


def score_pressed(path: Path, meta: Meta, how: How) -> Scored:
    """The same switches as the pressure cells of an insole of two: what a session makes of them, against themselves."""
    return _against_switches(path, run(path, how, calibration=switches()))


def _against_switches(path: Path, went: Run) -> Scored:
    truth = truth_of(path)
    heel_strike, toe_off = Matching(), Matching()
    for foot, ran in went.feet.items():
        t, counts = truth[f"t_{foot.value}"], truth[f"pressure_{foot.value}"]
        heel, toe = switch_contacts(t, counts[:, 1]), switch_contacts(t, counts[:, 0])
        if heel:
            heel_strike += match([begin for begin, _ in heel], ran.heel_strikes)
        if toe:
            toe_off += match([end for _, end in toe], ran.toe_offs)
    return scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off})


def score_force(path: Path, meta: Meta, how: How) -> Scored:
    """The force below each foot is the truth of contact, and its eight sensors are all that the session gets."""
    truth, went = truth_of(path), run(path, how, calibration=force_sensors())
    heel_strike, toe_off = Matching(), Matching()
    for foot, ran in went.feet.items():
        contacts = force_contacts(truth["t"], truth[f"pressure_{foot.value}"].sum(axis=1))
        heel_strike += match([begin for begin, _ in contacts], ran.heel_strikes)
        toe_off += match([end for _, end in contacts], ran.toe_offs)
    return scored(path, went, events={"heel_strike": heel_strike, "toe_off": toe_off})

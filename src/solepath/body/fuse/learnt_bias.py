"""Correction of the errors that both tracks share (common_error.py) by a rest at which a foot learns its bias.

A foot that has learnt its bias at a rest, with a gain of 1 - q / p for the variance p before and q now, has measured it
with the variance p q / (p - q), and with it the rate by which its own strides have turned the heading since the last
rest. A bias far from the expected one has changed meanwhile, nobody knows when."""

from __future__ import annotations

from ...foot.navigate.bias import BIAS_WANDER, Bias
from .common_error import FEET, HEADING, MAX_TURN_BACK, NO_MOVE, CommonError, FootBias, Move

REST_GATE = 9.0
"""Largest squared difference of a measured bias from the expected one, divided by its variance: above it, the bias has
changed since the last rest."""


def has_rested(error: CommonError, foot: int, bias: Bias) -> bool:
    """Return whether foot 0 (left) or 1 has learnt its bias since its last stride."""
    newest = error.foot_biases[foot]
    return newest is None or (bias.spans, bias.device) != (newest.spans, newest.device)


def add_rest(error: CommonError, foot: int, t: float, bias: Bias) -> Move:
    """Take in the `bias` of foot 0 (left) or 1 at the end of a stride at `t`, s.

    Returns what is to be added to x and y, m, and to the heading of both tracks, rad."""
    newest, row, variance, p = error.foot_biases[foot], FEET[foot] + 2, bias.variances[0], error.covariance
    if newest is None or bias.device != newest.device:  # the first stride of this device
        error.foot_biases[foot] = FootBias(t, variance, bias.spans, bias.change, bias.device)
        _replace_bias(error, foot, variance)
        if bias.device:  # not the first device of this foot
            error.renew_foot(foot)
        return NO_MOVE
    wander = BIAS_WANDER * BIAS_WANDER * max(0.0, t - newest.t)
    before = newest.variance + wander
    p[row][row] += wander
    if bias.spans == newest.spans:
        error.foot_biases[foot] = FootBias(t, before, bias.spans, bias.change, bias.device)
        return NO_MOVE
    error.foot_biases[foot] = FootBias(t, variance, bias.spans, bias.change, bias.device)
    change, gain = bias.change - newest.change, 1.0 - variance / before
    if gain > 0.0:
        z, noise = -change / gain - error.bias[foot], variance / gain
        s = p[row][row] + noise
        if z * z > REST_GATE * s and not newest.spans and p[row][row] > 0.0:
            # the bias was not known at all, and is larger than usual
            _add_to_bias(error, row, p[row][row] * (z * z / s - 1.0), len(p))
            s = p[row][row] + noise
        if z * z <= REST_GATE * s and abs(p[HEADING][row] * z) <= MAX_TURN_BACK * s:
            move = error.correct(list(p[row]), z, s, 1.0)
            error.bias[foot] += change  # which the foot has removed
            return move
    elif change * change <= REST_GATE * p[row][row]:  # the rest was too restless to show anything
        error.bias[foot] += change
        return NO_MOVE
    _replace_bias(error, foot, variance, change + error.bias[foot])
    return NO_MOVE


def _replace_bias(error: CommonError, foot: int, variance: float, change: float = 0.0) -> None:
    """Replace the error of a foot's bias by a new one with its `variance`, (rad/s)^2.

    The old one has changed by `change`, rad/s, at some time since the last rest, with a variance of change^2 / 3."""
    p, row = error.covariance, FEET[foot] + 2
    if p[row][row] > 0.0:
        most = 2.0 * MAX_TURN_BACK * p[row][row] / (abs(p[HEADING][row]) + 1e-12)
        _add_to_bias(error, row, min(change * change / 3.0, most * most), HEADING + 1)
    error.renew(row, variance)
    error.bias[foot] = 0.0


def _add_to_bias(error: CommonError, row: int, variance: float, count: int) -> None:
    """Add `variance`, (rad/s)^2, to that of a bias, and what it has moved so far to the first `count` errors."""
    p = error.covariance
    moved = [value / p[row][row] for value in p[row][:count]]
    for i, one in enumerate(moved):
        for j, other in enumerate(moved):
            p[i][j] += one * other * variance

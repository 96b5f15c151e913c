"""A hidden Markov model followed online: forward filter, and the same with a fixed lag; plain floats, a few states.

Rabiner 1989, "A tutorial on hidden Markov models": alpha of equations (19) and (20), scaled to sum 1 as in its section
V.A, and beta of equations (24) and (25) over the lag only.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import exp, isfinite

from attrs import define, field

LEAST = 1e-12
"""No state is ever less likely than this beside the likeliest: it could not come back."""

Matrix = tuple[tuple[float, ...], ...]


def spread(log_likelihoods: Sequence[float]) -> tuple[float, ...]:
    """Likelihoods beside the largest, each in [LEAST, 1]; what is no number says nothing."""
    sound = [value if isfinite(value) else None for value in log_likelihoods]
    highest = max([value for value in sound if value is not None], default=0.0)
    return tuple([1.0 if value is None else max(LEAST, exp(max(-700.0, value - highest))) for value in sound])


def staying(stay: Sequence[float], to: Sequence[Sequence[float]]) -> Matrix:
    """Transitions that stay with probability `stay[i]` and share the rest among the others by the weights `to[i]`
    (`to[i][i]` is not used); rows are from, columns to."""
    rows = []
    for i, (keeps, weights) in enumerate(zip(stay, to, strict=True)):
        others = sum(weights) - weights[i]
        share = (1.0 - keeps) / others if others > 0.0 else 0.0
        row = [weight * share for weight in weights]
        row[i] = keeps if others > 0.0 else 1.0
        rows.append(tuple(row))
    return tuple(rows)


def forward(belief: Sequence[float], transitions: Matrix, likelihoods: Sequence[float]) -> tuple[float, ...]:
    """The belief one step later, with the likelihoods of what was seen then (`spread`); it sums to 1."""
    prior = [0.0] * len(belief)
    for held, row in zip(belief, transitions, strict=True):
        for j, p in enumerate(row):
            prior[j] += held * p
    return weighed(prior, likelihoods)


def weighed(prior: Sequence[float], likelihoods: Sequence[float]) -> tuple[float, ...]:
    """Bayes' rule; no state becomes impossible."""
    joint = [max(p * f, LEAST) for p, f in zip(prior, likelihoods, strict=True)]
    scale = 1.0 / sum(joint)
    return tuple([p * scale for p in joint])


def backward(after: Sequence[float], transitions: Matrix, likelihoods: Sequence[float]) -> tuple[float, ...]:
    """What was seen from a step on, per state one step earlier, up to a factor; `after`: the same per state of that
    step from the next on, `likelihoods`: of that step."""
    ahead = [f * b for f, b in zip(likelihoods, after, strict=True)]
    before = [sum([p * g for p, g in zip(row, ahead, strict=True)]) for row in transitions]
    scale = 1.0 / max(sum(before), LEAST)
    return tuple([b * scale for b in before])


@define
class ForwardFilter:
    """Feed it the log-likelihood of every state, one step of the chain at a time.

    `initial`: probabilities before anything was seen. `transitions`: rows are from, columns to, each row sums to 1.
    `lag`: how many updates `settled` looks back; 0 is the filter itself. An update costs O(states^2), `settled`
    O(lag x states^2).
    """

    initial: tuple[float, ...]
    transitions: Matrix
    lag: int = 0
    # state
    belief: tuple[float, ...] | None = field(default=None, init=False)
    """Probability of each state now, given all up to now; None before any update."""
    earlier: deque[tuple[float, ...]] = field(factory=deque, init=False)
    """The belief after each of the last `lag` + 1 updates, oldest first."""
    seen: deque[tuple[float, ...]] = field(factory=deque, init=False)
    """The likelihoods of those updates."""

    def update(self, log_likelihoods: Sequence[float]) -> tuple[float, ...]:
        """One step; returns the belief, which sums to 1."""
        likely = spread(log_likelihoods)
        if self.belief is None:
            self.belief = weighed(self.initial, likely)
        else:
            self.belief = forward(self.belief, self.transitions, likely)
        self.earlier.append(self.belief)
        self.seen.append(likely)
        if len(self.seen) > self.lag + 1:
            self.earlier.popleft()
            self.seen.popleft()
        return self.belief

    @property
    def settled(self) -> tuple[float, ...] | None:
        """Probability of each state `lag` updates ago, given all up to now; None before there were so many."""
        return self.smoothed(self.lag)

    def smoothed(self, ago: int) -> tuple[float, ...] | None:
        """The same `ago` updates ago, at most `lag`; None before there were so many."""
        if not 0 <= ago < len(self.seen):
            return None
        newest = len(self.seen) - 1
        after: tuple[float, ...] = (1.0,) * len(self.initial)
        for i in range(newest, newest - ago, -1):
            after = backward(after, self.transitions, self.seen[i])
        return weighed(self.earlier[newest - ago], after)

    def anew(self) -> None:
        """Forget what was seen."""
        self.belief = None
        self.earlier.clear()
        self.seen.clear()

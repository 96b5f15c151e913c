"""Turns of the body from the steps of its feet (Liu et al. 2015, IEEE MASS, section IV.D).

Turning steps are told from steps straight on (body/gait/turning_steps.py). "For a n-step turning process, we then sum
the alpha_i up to get the turning degree alpha for one foot. Then we use the mean of the two feet as the turning
degree." By theorem 1 the feet may point anywhere, as long as they keep doing so. Works on the steps of any recipe.

Who turns on the spot steps with hardly any swing: a foot that was flat, left the ground unseen and is flat again,
turned, has pivoted. That is no step, but part of a turn.
"""

from __future__ import annotations

from math import pi

from ...events import StrideTaken
from ...types import Foot
from ...types.attrs import define, field, frozen
from .turning_steps import NO_TURN, TurningSteps

STANDS = 2.0
"""Who turns and then stands has turned, when no foot has come down for so long, s, or for as long as the last turning
step took with what went before it, but not for longer than"""
PATIENCE = 4.0
"""s."""
STRAIGHT = 3
"""So many steps straight on end a turn, of both feet where both are heard: one foot may step twice on the spot while
the other turns."""


@frozen
class TurnProcess:
    """A turning process that is over. `left`, `right`: sum of each foot's turns, rad; None of a foot not heard."""

    t_start: float
    t_end: float
    left: float | None
    right: float | None

    @property
    def angle(self) -> float:
        """Mean of the feet that were heard, rad, counter-clockwise positive."""
        known = [one for one in (self.left, self.right) if one is not None]
        return sum(known) / len(known)


@define
class FootTurn:
    """What one foot turned so far in the turning process under way."""

    turning: TurningSteps = field(factory=TurningSteps)
    stepped: float | None = None
    """When its last step ended, s."""
    angle: float = 0.0
    """rad."""
    straight: int = 0
    """Steps straight on since its last turning step."""


@define
class Direction:
    """Steps in, whole turns out. Latency: a turn is known when the feet have gone straight on for `STRAIGHT` steps (two
    where only one is heard), or have stood for `STANDS`."""

    left: FootTurn = field(factory=FootTurn, init=False)
    right: FootTurn = field(factory=FootTurn, init=False)
    began: float | None = field(default=None, init=False)
    """When the first turning step of the process did, s; None while the wearer goes straight on."""
    ended: float = field(default=0.0, init=False)
    """When the last one did, s."""
    stands: float = field(default=STANDS, init=False)
    told: float | None = field(default=None, init=False)
    """When the last turn that was told was over, s."""

    def step(self, taken: StrideTaken) -> TurnProcess | None:
        """One step of either foot, in the order in which they became known; the turn that is over by it."""
        foot, other = self._feet(taken.foot)
        angle = foot.turning.turn(taken.heading_change)
        foot.stepped = taken.t_end
        if angle != 0.0:
            return self._turning(foot, other, taken.t_start, taken.t_end, angle)
        foot.straight += 1
        if self.began is None:
            return None
        if other.stepped is None or taken.t_end - other.stepped > self.stands:
            return self._over() if foot.straight > 1 else None
        both = other.straight > 0 and foot.straight + other.straight >= STRAIGHT
        return self._over() if both or foot.straight >= STRAIGHT else None

    def pivot(self, foot: Foot, t_start: float, t_end: float, angle: float) -> TurnProcess | None:
        """A foot that took no step from one foot-flat to the next, s, has turned by `angle`, rad: as above, but when it
        is no turning step it is nothing."""
        this, other = self._feet(foot)
        if abs(angle) <= NO_TURN:
            return None
        this.stepped = t_end
        return self._turning(this, other, t_start, t_end, angle)

    def _feet(self, foot: Foot) -> tuple[FootTurn, FootTurn]:
        return (self.left, self.right) if foot is Foot.LEFT else (self.right, self.left)

    def _turning(
        self, foot: FootTurn, other: FootTurn, t_start: float, t_end: float, angle: float
    ) -> TurnProcess | None:
        over = None
        if self.began is not None and t_start - self.ended > self.stands:
            over = self._over()
        if self.began is None:
            # who stood for long did not turn meanwhile, nor before the last turn was over
            began = max(t_start, t_end - PATIENCE)
            self.began = self.ended = began if self.told is None else max(began, min(self.told, t_end))
            foot.angle = other.angle = 0.0
        foot.angle += angle
        foot.straight = other.straight = 0
        self.ended = max(self.ended, t_end)
        self.stands = min(max(STANDS, 0.8 * self.stands, t_end - t_start), PATIENCE)
        return over

    def stood(self, t: float) -> TurnProcess | None:
        """It is `t` s; the turn that is over because nobody has stepped since."""
        if self.began is None or t - self.ended <= self.stands:
            return None
        newest = max(-1e12 if foot.stepped is None else foot.stepped for foot in (self.left, self.right))
        return self._over() if t - newest > self.stands else None

    def finish(self) -> TurnProcess | None:
        """The turn under way, which nobody will go on with."""
        return None if self.began is None else self._over()

    def reset(self, foot: Foot) -> None:
        """The clock of a foot begins anew: a turn under way has no length, and is forgotten."""
        self.began = self.told = None
        (self.left if foot is Foot.LEFT else self.right).stepped = None

    def _over(self) -> TurnProcess:
        began = self.ended if self.began is None else self.began
        found = TurnProcess(began, self.ended, *agreed(self._part(self.left, began), self._part(self.right, began)))
        self.began, self.told = None, self.ended
        self.left.angle = self.right.angle = 0.0
        self.left.straight = self.right.straight = 0
        return found

    @staticmethod
    def _part(foot: FootTurn, began: float) -> float | None:
        return None if foot.stepped is None or foot.stepped < began else foot.angle


def agreed(left: float | None, right: float | None) -> tuple[float | None, float | None]:
    """What the feet turned, rad. A step's turn is known but for whole ones (StrideTaken.heading_change), and who turns
    about may swing a foot by more than half of one: feet that are further apart than that do not mean it."""
    if left is None or right is None or abs(left - right) <= pi:
        return left, right
    whole = 2.0 * pi if left < right else -2.0 * pi
    to_left, to_right = (left + whole, right), (left, right - whole)
    return to_left if abs(sum(to_left)) <= abs(sum(to_right)) else to_right

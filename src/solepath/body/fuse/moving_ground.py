"""Ground that moves under the wearer, as a moving walkway or an escalator does.

A foot that stands has the velocity 0 for a navigation that knows of no other ground. When the wearer steps onto a
walkway, the integrated velocity of each foot at its first stance there is that of the walkway, once; when the wearer
steps off, it is the opposite. An error of a single foot, or of both with different velocities, is something else."""

from __future__ import annotations

from math import hypot

from ...events import StrideTaken
from ...types import OTHER, PerFoot, Vec2, Vec3, per_foot
from ...types.attrs import define, field

LEAST_SPEED = 0.35
"""Least error of the velocity of both feet that shows moving ground, m/s; walkways run at 0.5 to 0.75 (EN 115-1)."""
MOST_SPEED = 1.2
"""Largest speed of ground that a person steps onto, m/s; express walkways exceed the 0.75 of EN 115-1."""
LARGEST_DIFFERENCE = 0.25
"""Largest difference of the velocity errors of both feet, m/s.

Of 8,800 pairs of strides on still ground (recordings of six data sets), 428 had errors above `LEAST_SPEED` that were as
similar, nearly all of them on sensors that clip at 2 g, and 1 of these was not usual for that walk."""
UNUSUAL = 4.0
"""Least ratio of such an error to the usual one of the foot."""
LEAST_STRIDES = 6
"""Number of strides of a foot after which its usual error is known."""
USUAL_RATE = 0.1
"""Rate at which a stride changes the usual error."""
LONGEST_STEP = 1.5
"""Longest time between the stances of both feet that are compared, s."""
LONGEST_RIDE = 300.0
"""Time after which ground that was not seen to stop counts as still, s: 200 m of walkway at 0.65 m/s."""


STILL: Vec2 = (0.0, 0.0)
"""Velocity of ground that does not move, and error of a usual stride, m/s."""


@define
class FootVelocity:
    """The velocity errors of one foot."""

    count: int = 0
    usual: float = 0.0
    """Usual size of the error, m/s."""
    t: float = 0.0
    """End of the newest stride, s."""
    error: Vec2 = STILL
    """Error at the newest stride, along it and to the left of it, m/s; 0 unless it is unusual."""

    def add(self, t: float, error: Vec2) -> None:
        """Add the error at the end of a stride."""
        size = hypot(*error)
        self.t, is_unusual = t, self.count >= LEAST_STRIDES and size > UNUSUAL * self.usual
        self.error = error if is_unusual and LEAST_SPEED < size < MOST_SPEED else STILL
        self.count += 1
        if not is_unusual or self.error == STILL:
            self.usual += max(USUAL_RATE, 1.0 / self.count) * (size - self.usual)


@define
class MovingGround:
    """The ground's velocity, from the strides of both feet."""

    feet: PerFoot[FootVelocity] = field(factory=lambda: per_foot(FootVelocity))
    velocity: Vec2 = STILL
    """Velocity of the ground, along the strides and to the left of them, m/s."""
    since: float | None = None
    """Time since which the ground moves, s; None while it stands still."""
    t: float = 0.0
    """Time up to which `variance` was given, s."""

    def add_stride(self, event: StrideTaken, velocity_error: Vec3) -> str | None:
        """Add a stride; return a sentence if it shows that the ground starts or stops to move.

        `velocity_error` is the integrated velocity of the foot when it came to stand, m/s."""
        this, other = self.feet[event.foot], self.feet[OTHER[event.foot]]
        (dx, dy, _), (ex, ey, _) = event.displacement, velocity_error
        length = hypot(dx, dy)
        if length <= 0.0:
            return None
        this.add(event.t_end, ((dx * ex + dy * ey) / length, (dx * ey - dy * ex) / length))
        if self.since is not None and not 0.0 <= event.t_end - self.since < LONGEST_RIDE:
            self.velocity, self.since = STILL, None
        (ax, ay), (bx, by), is_step = this.error, other.error, 0.0 <= this.t - other.t < LONGEST_STEP
        if STILL in (this.error, other.error) or not is_step or hypot(ax - bx, ay - by) > LARGEST_DIFFERENCE:
            return None
        this.error = other.error = STILL
        (vx, vy), x, y, started = self.velocity, 0.5 * (ax + bx), 0.5 * (ay + by), self.since
        self.t, speed = this.t, hypot(vx, vy)
        if started is not None and hypot(vx + x, vy + y) < speed:
            self.velocity, self.since = STILL, None
            distance = speed * (this.t - started)
            return f"the ground stands still again; the track lacks about {distance:.0f} m that it has moved"
        self.velocity, self.since = (x, y), this.t
        text = "as a moving walkway does; the track lacks the way by which it carries the wearer"
        return f"the ground moves by {hypot(x, y):.1f} m/s, {text}"

    def variance(self, t: float) -> float:
        """Return what to add to the variance of the position, m^2, for the ground's motion since the last call."""
        if self.since is None or t <= self.t:
            return 0.0
        square = self.velocity[0] ** 2 + self.velocity[1] ** 2
        before, now, self.t = self.t - self.since, t - self.since, t
        return square * (now * now - before * before)

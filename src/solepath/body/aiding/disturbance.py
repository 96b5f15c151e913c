"""Size of the disturbance of the magnetic field by a building: usually, and about the newest stances.

Steel makes the disturbance much stronger in some places than in others, so a stretch of clean ones shows the heading
best. The field of sources below the floor has no divergence and no curl there, so the vertical axis is disturbed as
much as both horizontal axes together: all three show the size of the disturbance."""

from __future__ import annotations

from ...types.attrs import define, field

FIRST_DISTURBANCE = 7.0
"""Standard deviation of the disturbance of a horizontal axis before any was seen, uT: 20 degrees of 20 uT."""
USUAL_MEMORY, NEAR_MEMORY = 300.0, 4.0
"""Number of stances of both feet, 200 m, over which the usual disturbance is averaged, and number of stances of a foot,
5 m, over which the near one is."""
FIRST_STANCES = 20
"""Number of stances before the first that is averaged, because the field and the iron are not known yet."""
VERTICAL_MEMORY = 50
"""Number of stances over which the vertical field of a foot is averaged."""
LEAST = 0.1
"""Least square of a residual that is averaged, uT^2: the noise of a magnetometer, 0.3 uT (MAG3110)."""
LARGEST = 9.0
"""Largest square of a residual that is averaged, as a multiple of the variance: three standard deviations."""
USUAL_SHARE = 0.1
"""Share of the usual variance in that about the newest stances, which few stances show."""
TAIL = 4.0
"""Degrees of freedom of the t distribution by which a stance weighs, no unit: heavy tails."""
MOST_OF_FIELD = 0.5
"""Largest disturbance of a place that shows the heading, as a share of the horizontal field: 26 degrees. Chosen on
tuning walks."""
STRANGE, STRANGE_FIELD = 1.5, 0.6
"""Least disturbance of a strange place: its variance as a multiple of the usual one, or its standard deviation as a
share of the horizontal field (31 degrees)."""
CHANGED = 6.0
"""Ratio of the near disturbance of a foot to that of the other one, and to the usual one, if its iron has changed."""


@define
class Disturbance:
    """Variances of the disturbance of a horizontal axis, uT^2."""

    usual: float = field(default=FIRST_DISTURBANCE * FIRST_DISTURBANCE, init=False)
    near: list[float] = field(factory=lambda: [FIRST_DISTURBANCE * FIRST_DISTURBANCE] * 2, init=False)
    """Variance about the newest stances of the left and of the right foot, uT^2."""
    changed: list[int] = field(factory=lambda: [0, 0], init=False)
    """Number of stances in a row of the left and of the right foot that show a change of its iron."""
    count: int = field(default=0, init=False)
    """Number of stances so far."""
    vertical: list[tuple[int, float]] = field(factory=lambda: [(0, 0.0), (0, 0.0)], init=False)
    """Number of stances and mean vertical field of the left and of the right foot, uT."""

    @property
    def here(self) -> float:
        """Variance about the newest stances of both feet, uT^2."""
        (left, right), usual = self.near, self.usual
        largest = LARGEST * usual
        both = (left if left < largest else largest) + (right if right < largest else largest)
        return USUAL_SHARE * usual + (1.0 - USUAL_SHARE) * 0.5 * both

    def add_stance(self, foot: int, residual: tuple[float, float], vertical: float) -> float:
        """Add a stance of foot 0 (left) or 1 and return its weight, up to 1.

        `residual` is how far the horizontal flux density is from the field, and `vertical` the vertical one, uT."""
        number, mean = self.vertical[foot]
        (x, y), z = residual, vertical - mean if number else 0.0
        number = min(number + 1, VERTICAL_MEMORY)
        self.vertical[foot] = (number, mean + (vertical - mean) / number)
        square = 0.25 * (x * x + y * y + z * z)  # of two parts of four in the horizontal axes, and two in the vertical
        self.count += 1
        if self.count > FIRST_STANCES:
            square = max(square, LEAST)
            self.usual += (min(square, LARGEST * self.usual) - self.usual) / USUAL_MEMORY
            self.near[foot] += (square - self.near[foot]) / NEAR_MEMORY
        return min(1.0, (TAIL + 4.0) / (TAIL + 4.0 * square / self.here))

    def has_changed(self, foot: int) -> bool:
        """Return whether something magnetic came to foot 0 (left) or 1, or left it: the other foot sees nothing.

        Call it after each stance; two of a foot must show it, because one foot is the first to step into a lift."""
        shows = self.near[foot] > CHANGED * max(self.usual, self.near[1 - foot])
        self.changed[foot] = self.changed[foot] + 1 if shows else 0
        return self.changed[foot] >= 2

    def judge(self, horizontal: tuple[float, float]) -> tuple[bool, bool]:
        """Return whether this place shows the heading, and whether it is strange; `horizontal` is the field, uT.

        It shows the heading if it is no more disturbed than usual."""
        (x, y), here = horizontal, self.here
        square = x * x + y * y
        shows = here <= min(self.usual, MOST_OF_FIELD * MOST_OF_FIELD * square)
        return shows, here > min(STRANGE * self.usual, STRANGE_FIELD * STRANGE_FIELD * square)

"""A hand that turns a sensor: rests in many orientations, and turns about horizontal axes, for `calibrate sensor`.

    hand = Handling(seed=7)
    samples = Insole().samples(hand, Site.RIGHT_FOOT, device_rng(7, Site.RIGHT_FOOT))

A hand is no turntable. It turns the sensor grip by grip, each at its own speed and about its own axis near the intended
one, overshoots or stops short of whole turns, wobbles about all axes on every way, trembles at 8 to 12 Hz, and moves
the sensor through the room meanwhile. A turn starts and ends in a rest. What should be a rest is a sensor that leans on
a thing or is held against one: it creeps by a fraction of a degree, about the vertical too, and trembles a little.

The motion is a composition of rotations with smooth courses. Angular rate and acceleration are differences of it over a
hundredth of the time between the fine instants of an emulated device, and no equation of the calibration is in it.

Idealised: the hand is patient enough for the range of usual gyroscopes, rests nowhere on anything that shakes, and the
sensor is rigid. Chips have what parts.py lists; their scale does not depend on the temperature or the rate."""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt

import numpy as np
from attrs import field, frozen

from solepath.emulate.sensors.magnetic_field import UNDISTURBED
from solepath.emulate.wearers.curves import BUMP, Array, Rng, evaluate, join
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.motion import Kinematics
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting
from solepath.emulate.wearers.turning import from_rotation_vectors, matrices, multiply_quaternions
from solepath.emulate.wearers.walker import Walker
from solepath.types import Foot, Layout
from solepath.types.vector import GRAVITY

STEP = 1e-5
"""Half of the time over which the motion is differentiated, s."""
TREMOR_RATES = (8.0, 12.0)
"""Least and largest frequency of physiological tremor, Hz (Elble and Koller 1990, Tremor)."""
PROGRESS = join((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), 1.0)
"""Share of a move that is done, over the share of its time: slope and curvature are 0 at both ends."""
GRIP = radians(150.0)
"""Mean angle by which a hand turns before it grips again, rad (assumed)."""
FACES = np.concatenate((np.eye(3), -np.eye(3)))
"""Directions of the sensor that point upwards when a box lies on each of its faces, (6, 3)."""


@frozen
class Clumsiness:
    """Clumsiness of a hand; all figures are assumed, for a person who was shown the task once."""

    off_axis: float = radians(8.0)
    """Standard deviation of each grip's axis about the intended one, rad, on either axis across it."""
    off_level: float = radians(8.0)
    """Standard deviation of the tilt of a turn's axis out of the horizontal, rad."""
    off_face: float = radians(12.0)
    """Standard deviation of a rest's orientation about the intended one, rad."""
    off_whole: float = radians(25.0)
    """Standard deviation of the end of five turns about whole turns, rad."""
    wobble: float = radians(10.0)
    """Standard deviation of the wobble in the middle of a way or a grip, rad."""
    tremor: float = radians(0.15)
    """Amplitude of the tremor about each axis while the hand moves the sensor, rad."""
    shake: float = 0.0003
    """Amplitude of the tremor of the place while the hand moves the sensor, m."""
    resting_share: float = 0.05
    """Share of both tremors that is left at rest, where the sensor leans on a thing."""
    creep: float = radians(0.3)
    """Standard deviation of the turn during a rest about each axis, rad."""
    travel: float = 0.15
    """Standard deviation of the displacement on a way, m."""
    pace: float = radians(130.0)
    """Mean angular rate of a grip, rad/s; each is at 0.6 to 1.4 times this."""
    rest: tuple[float, float] = (2.5, 5.0)
    """Shortest and longest rest, s."""


CLUMSY = Clumsiness()
"""A clumsy hand."""
STEADY = Clumsiness(
    off_axis=radians(2.0), off_level=radians(2.0), off_whole=radians(5.0), wobble=radians(3.0), tremor=radians(0.05),
    shake=0.0001, resting_share=0.0, creep=0.0,
)  # fmt: skip
"""A practised hand, which puts the sensor down for every rest."""


@frozen(eq=False)
class HandMove:
    """A part of the motion, in which the sensor turns by a rotation vector and wobbles on the way."""

    start: float
    """Start of the move, s."""
    duration: float
    """Duration of the move, s."""
    before: Array
    """Attitude at the start, w x y z, sensor to world, (4)."""
    turn: Array
    """Rotation vector of the whole move, world frame, rad, (3)."""
    wobble: Array
    """Rotation vectors of the wobble's two sines, world frame, rad, (2, 3)."""
    place: Array
    """Position of the hand at the start, world frame, m, (3)."""
    travel: Array
    """Displacement of the hand, m, (3)."""
    tremor: float
    """Share of the tremor of a moving hand in the middle of the move, beyond that at rest."""

    def share(self, t: Array) -> Array:
        """Return the share of the move's time that has passed at times `t`, s, (N)."""
        return np.clip((t - self.start) / self.duration, 0.0, 1.0)

    def attitude(self, t: Array) -> Array:
        """Return the attitude without tremor at times `t`, s, (N, 4)."""
        s = self.share(t)
        way = from_rotation_vectors(evaluate(PROGRESS, s)[:, None] * self.turn)
        window = evaluate(BUMP, s)[:, None]
        sines = np.stack((np.sin(pi * s), np.sin(3.0 * pi * s)), axis=1)
        aside = from_rotation_vectors(window * (sines @ self.wobble))
        return multiply_quaternions(aside, multiply_quaternions(way, self.before[None, :]))

    def hand(self, t: Array) -> Array:
        """Return the position of the hand at times `t`, s, (N, 3), m."""
        return np.asarray(self.place + evaluate(PROGRESS, self.share(t))[:, None] * self.travel)

    @property
    def after(self) -> Array:
        """Attitude at the end, (4)."""
        return np.asarray(self.attitude(np.array([self.start + self.duration]))[0])


class Handling(Walker):
    """A sensor in a hand: any device of `emulate` measures this motion in place of that of a foot.

    There are `pauses` rests, then for each direction of the sensor in `axes` `turns` turns about it, held horizontal,
    between two more rests. With `orientations`, (N, 3), the rests have these directions of the sensor upwards;
    otherwise they are faces and edges of a box in a random order. Cells bear no load."""

    def __init__(
        self,
        seed: int = 1,
        clumsiness: Clumsiness = CLUMSY,
        *,
        pauses: int = 12,
        turns: float = 5.0,
        axes: tuple[tuple[float, float, float], ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
        orientations: Array | None = None,
    ) -> None:
        self.seed, self.wearer, self.field = seed, Wearer(), UNDISTURBED
        rng = np.random.default_rng([seed, 50])
        composing = _Composing(rng, clumsiness)
        for up in _orientations(pauses, rng) if orientations is None else orientations:
            composing.go(np.asarray(up, dtype=np.float64))
            composing.lie()
        for axis in axes if turns else ():
            composing.turn(np.array(axis), turns)
        self.moves = composing.moves
        self._least_tremor = clumsiness.resting_share
        self._starts = np.array([move.start for move in self.moves])
        self._tremor = clumsiness.tremor * rng.standard_normal((3, 3)), clumsiness.shake * rng.standard_normal((3, 3))
        self._pulses = 2.0 * pi * rng.uniform(*TREMOR_RATES, 3), rng.uniform(0.0, 2.0 * pi, 3)
        self._place = 0.04 * rng.standard_normal(3)  # m: the sensor is not where the hand turns

    @property
    def duration(self) -> float:
        """Duration of the handling, s."""
        return self.moves[-1].start + self.moves[-1].duration

    def cell_loads(self, layout: Layout, t: Array) -> Array:
        """Return no load on any cell."""
        return np.zeros((len(t), len(layout.cells)))

    def kinematics(self, foot: Foot, t: Array, mounting: Mounting = IN_SOLE) -> Kinematics:
        """Return the motion of the sensor at increasing times `t`, s; neither foot nor mounting matters to a hand."""
        (before, place_before), (attitude, place), (after, place_after) = (self._pose(t + k * STEP) for k in (-1, 0, 1))
        inverse = before * (1.0, -1.0, -1.0, -1.0)
        difference = multiply_quaternions(inverse, after)
        rate = difference[:, 1:] * np.sign(difference[:, :1]) / STEP
        velocity = (place_after - place_before) / (2.0 * STEP)
        wide = 100.0 * STEP
        earlier, later = self._pose(t - wide)[1], self._pose(t + wide)[1]
        acceleration = (later - 2.0 * place + earlier) / (wide * wide)
        force = np.einsum("nji,nj->ni", matrices(attitude), acceleration + (0.0, 0.0, GRAVITY))
        return Kinematics(t, place, velocity, acceleration, attitude, rate, force)

    def _pose(self, t: Array) -> tuple[Array, Array]:
        """Return attitude, (N, 4), and position, m, (N, 3), of the sensor at increasing times `t`, s."""
        attitude, place, share = np.empty((len(t), 4)), np.empty((len(t), 3)), np.empty(len(t))
        edges = [0, *np.searchsorted(t, self._starts[1:]).tolist(), len(t)]
        for move, first, end in zip(self.moves, edges, edges[1:], strict=False):
            rows = slice(first, end)
            attitude[rows], place[rows] = move.attitude(t[rows]), move.hand(t[rows])
            share[rows] = self._least_tremor + move.tremor * evaluate(BUMP, move.share(t[rows]))
        pulses, phases = self._pulses
        sines = np.sin(t[:, None] * pulses + phases) * share[:, None]
        attitude = multiply_quaternions(attitude, from_rotation_vectors(sines @ self._tremor[0]))
        place = place + sines @ self._tremor[1] + np.einsum("nij,j->ni", matrices(attitude), self._place)
        return attitude, place


@frozen(eq=False)
class _Composing:
    """A motion that is composed move by move."""

    rng: Rng
    clumsiness: Clumsiness
    moves: list[HandMove] = field(factory=list)

    def go(self, up: Array) -> None:
        """Turn the sensor until its direction `up` points upwards, with any heading and an error."""
        clumsy, rng = self.clumsiness, self.rng
        if not self.moves:
            self._first(up)
            return
        attitude = self.moves[-1].after
        here = matrices(attitude[None, :])[0] @ up  # where the direction points now, world frame
        axis, angle = np.cross(here, (0.0, 0.0, 1.0)), float(np.arctan2(sqrt(here[0] ** 2 + here[1] ** 2), here[2]))
        length = float(np.linalg.norm(axis))
        axis = np.array([1.0, 0.0, 0.0]) if length < 1e-6 else axis / length
        off, heading = clumsy.off_face * rng.standard_normal(3), np.array([0.0, 0.0, rng.uniform(-1.5, 1.5)])
        ways = from_rotation_vectors(np.array([off, heading, angle * axis]))
        turn = _rotation_vector(multiply_quaternions(ways[:1], multiply_quaternions(ways[1:2], ways[2:])))
        self._add(turn, float(np.linalg.norm(turn)) / self._pace() + 0.5, clumsy.wobble, clumsy.travel, 1.0)

    def lie(self) -> None:
        """Leave the sensor where it is for a rest."""
        clumsy = self.clumsiness
        creep = clumsy.creep * self.rng.standard_normal(3)
        self._add(creep, float(self.rng.uniform(*clumsy.rest)), 0.3 * clumsy.creep, 0.0, 0.0)

    def turn(self, axis: Array, turns: float) -> None:
        """Bring a direction of the sensor to the horizontal, rest, turn about it grip by grip, and rest."""
        clumsy, rng = self.clumsiness, self.rng
        across = np.cross(axis, rng.standard_normal(3))
        self.go(across / np.linalg.norm(across))
        self.lie()
        tilt = clumsy.off_level * rng.standard_normal()
        left = 2.0 * pi * turns * float(rng.choice((-1.0, 1.0)))
        left += clumsy.off_whole * float(rng.standard_normal())
        while abs(left) > 1e-9:
            grip = float(np.clip(GRIP * rng.uniform(0.6, 1.4), 0.0, abs(left))) * (1.0 if left > 0.0 else -1.0)
            left -= grip
            pointing = matrices(self.moves[-1].after[None, :])[0] @ axis
            level = np.array([pointing[0], pointing[1], 0.0]) / sqrt(pointing[0] ** 2 + pointing[1] ** 2)
            about = level * cos(tilt) + np.array([0.0, 0.0, sin(tilt)])
            about = about + clumsy.off_axis * rng.standard_normal(3)
            turn = grip * about / np.linalg.norm(about)
            self._add(turn, abs(grip) / self._pace() + 0.05, 0.3 * clumsy.wobble, 0.2 * clumsy.travel, 1.0)
        self.lie()

    def _pace(self) -> float:
        return self.clumsiness.pace * float(self.rng.uniform(0.6, 1.4))

    def _first(self, up: Array) -> None:
        """Start with the direction `up` upwards."""
        z = np.array([0.0, 0.0, 1.0])
        half = up / np.linalg.norm(up) + z
        half = np.array([1.0, 0.0, 0.0]) if np.linalg.norm(half) < 1e-6 else half / np.linalg.norm(half)
        attitude = np.concatenate(([0.0], half))  # half a turn about the middle of both directions
        self.moves.append(HandMove(0.0, 0.5, attitude, np.zeros(3), np.zeros((2, 3)), np.zeros(3), np.zeros(3), 0.0))

    def _add(self, turn: Array, duration: float, wobble: float, travel: float, tremor: float) -> None:
        last = self.moves[-1]
        sides = wobble * self.rng.standard_normal((2, 3)) * np.array([[1.0], [0.4]])
        way = travel * self.rng.standard_normal(3)
        start = last.start + last.duration
        self.moves.append(HandMove(start, duration, last.after, turn, sides, last.place + last.travel, way, tremor))


def _rotation_vector(q: Array) -> Array:
    """Return the shortest rotation vector, rad, (3), of one unit quaternion, (1, 4)."""
    scalar, vector = float(q[0, 0]), q[0, 1:]
    sine = float(np.linalg.norm(vector))
    angle = 2.0 * float(np.arctan2(sine, abs(scalar)))
    return np.asarray(np.sign(scalar) * vector * (2.0 if sine < 1e-9 else angle / sine))


def _orientations(count: int, rng: Rng) -> Array:
    """Return directions of the sensor that point upwards: faces of a box first, then edges, in a random order."""
    edges = np.array([a + b for i, a in enumerate(FACES) for b in FACES[i + 1 :] if abs(float(a @ b)) < 0.5])
    rng.shuffle(edges)
    chosen = np.concatenate((FACES, edges / sqrt(2.0)))[:count]
    rng.shuffle(chosen)
    return np.asarray(chosen)

"""Feet of somebody on wheels: on a bicycle, in a car or a bus, on inline skates, in a wheelchair.

The vehicle moves along a way with a speed and a heading that are drawn; the feet move in it. The unevenness of a road
has the spectrum of ISO 8608: G(n) = G0 (n / 0.1)^-2 m^3 over the waves per metre n, with G0 = 16 to 64e-6 for good
roads (classes A to B) and 256e-6 for class C. At v m/s it shakes the wheel with G0 0.01 v / f^2 m^2/Hz. Its way to the
feet is a quarter of a car (300 kg on 20 kN/m and 1.5 kNs/m, wheel of 40 kg on 180 kN/m: Wong 2008, Theory of Ground
Vehicles) or, on rigid frames, one mass on tyres.

Idealised: wheels keep the ground; a vehicle does not pitch over bumps, but leans and dives with its acceleration by a
few degrees; shaking is vertical alone; shoes do not slip on pedals and rests. Numbers without a source are assumed."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
from attrs import frozen

from solepath.emulate.wearers.curves import Array, Rng
from solepath.emulate.wearers.limbs import SIDE_SIGNS
from solepath.emulate.wearers.turning import rotation
from solepath.types import Foot
from solepath.types.vector import GRAVITY

from .courses import STILL, Course, Frames, Key, Pose, Spectrum, Vibration, Way, carried
from .on_the_spot import HALF_WIDTH, LAST_MOVE, Posing, fidgeting, posing

REFERENCE_WAVE = 0.1
"""Waves per metre for which ISO 8608 states G0, 1/m."""
LEAST_FREQUENCY = 0.4
"""Least frequency of shaking, Hz; slower waves of a road are hills."""


def road(roughness: float, passes: Spectrum) -> Spectrum:
    """Return the spectrum of the height of a vehicle at 1 m/s on a road with G0 = `roughness` m^3, m^2/Hz.

    `passes` is the share of an amplitude that reaches the vehicle, by frequency."""
    return lambda f: roughness * REFERENCE_WAVE**2 / f**2 * passes(f) ** 2


def quarter_car(f: Array) -> Array:
    """Return the ratio of the height of a car's body to that of the road, by frequency, Hz."""
    body, wheel, spring, damper, tyre = 300.0, 40.0, 20e3, 1.5e3, 180e3
    w = 2j * pi * f
    strut = spring + damper * w
    return np.asarray(np.abs(tyre * strut / ((strut + body * w**2) * (strut + tyre + wheel * w**2) - strut**2)))


def on_tyres(resonance: float, damping: float) -> Spectrum:
    """Return the ratio of the heights of a frame on tyres and of the road; `resonance` in Hz, `damping` as a ratio."""

    def passes(f: Array) -> Array:
        r = f / resonance
        return np.abs((1.0 + 2j * damping * r) / (1.0 - r**2 + 2j * damping * r))

    return passes


@frozen(eq=False)
class Vehicle:
    """A vehicle on its way."""

    way: Way
    shaking: Vibration
    """Height at 1 m/s; it grows with the root of the speed."""
    dive: float = 0.0
    """Pitch by which it dives when it brakes, rad per m/s^2."""
    lean: float = 0.0
    """Roll to the outside of a bend, rad per m/s^2; a bicycle leans to the inside."""
    idling: float = 0.0
    """Amplitude of the acceleration by its engine, m/s^2, at `ENGINE_RATE`."""

    def pose(self, t: Array) -> Pose:
        """Return position and attitude at times `t`, s."""
        along, aside = self.way.pull(t)
        place = self.way.place(t)
        # 0.01 keeps the root smooth where the vehicle stops
        place[:, 2] = np.sqrt(np.sqrt(self.way.speed.at(t) ** 2 + 1e-4)) * self.shaking.at(t)
        place[:, 2] += self.idling / (2.0 * pi * ENGINE_RATE) ** 2 * np.sin(2.0 * pi * ENGINE_RATE * t)
        return place, rotation(self.way.heading.at(t), -self.dive * along, self.lean * aside)


ENGINE_RATE = 25.0
"""Rate of the shaking by an engine that idles, Hz: 750 revolutions a minute of four cylinders."""


def town_way(rng: Rng, duration: float, speeds: tuple[float, float], stops: tuple[float, float]) -> Way:
    """Return a way through a town: again and again it speeds up, bends once or more, brakes and stops.

    `speeds` are the least and largest speed, m/s, `stops` the shortest and longest stop, s. It speeds up at 0.7 to 2
    m/s^2 and brakes at 0.8 to 2.5."""
    t, heading = rng.uniform(0.5, 3.0), 0.0
    speed_keys, heading_keys = list[Key]([(0.0, 0.0)]), list[Key]([(0.0, 0.0)])
    while t < duration:
        speed, pull, brake = rng.uniform(*speeds), rng.uniform(0.7, 2.0), rng.uniform(0.8, 2.5)
        speed_keys.append((t, 0.0))
        t += 1.9 * speed / pull  # the largest acceleration of a quintic is 1.9 times the mean
        speed_keys.append((t, speed))
        for _ in range(int(rng.integers(1, 4))):
            t += rng.uniform(3.0, 10.0)
            heading_keys.append((t, heading))
            heading += float(rng.choice((-1.0, 1.0, 0.2))) * 0.5 * pi * rng.uniform(0.1, 1.0)
            t += 4.0 + 0.3 * speed
            heading_keys.append((t, heading))
            speed_keys.append((t, speed * rng.uniform(0.8, 1.0)))
        t += 1.9 * speed / brake
        speed_keys.append((t, 0.0))
        t += rng.uniform(*stops)
    return Way.along(Course.through(*speed_keys), Course.through(*heading_keys), duration)


def _car(rng: Rng, duration: float, *, bus: bool = False) -> Vehicle:
    way = town_way(rng, duration, (5.0, 12.0) if bus else (6.0, 22.0), (8.0, 20.0) if bus else (2.0, 15.0))
    shaking = Vibration.drawn(road(rng.uniform(16e-6, 128e-6), quarter_car), LEAST_FREQUENCY, 40.0, rng)
    return Vehicle(way, shaking, rng.uniform(0.008, 0.02), rng.uniform(0.005, 0.015), rng.uniform(0.02, 0.2))


def riding_along(rng: Rng, duration: float) -> Posing:
    """Return the feet of a passenger of a car who moves the legs every 6 s or so."""
    return _inside(_car(rng, duration), fidgeting(rng, duration, 6.0))


def riding_bus(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who sits in a bus, which stops often, and moves the legs every 6 s or so."""
    return _inside(_car(rng, duration, bus=True), fidgeting(rng, duration, 6.0))


def _inside(vehicle: Vehicle, feet: Posing) -> Posing:
    return lambda foot, t: carried(vehicle.pose(t), feet(foot, t))


def driving(rng: Rng, duration: float) -> Posing:
    """Return the feet of a driver: the right heel rests and the foot turns between the pedals and presses them.

    It presses one every 1 to 5 s, by 0.1 to 0.3 rad, and changes the pedal every third time, by 0.3 rad; the left foot
    moves every 15 s or so."""
    frames = Frames(x=0.0, y=-HALF_WIDTH, pitch=0.6, yaw=0.0)
    t, yaw = 1.0, 0.0
    while t < duration - LAST_MOVE:
        move, pressed = rng.uniform(0.2, 0.8), 0.6 - rng.uniform(0.0, 0.3)
        if rng.uniform() < 0.33:
            frames.add(t + 0.25, yaw=yaw, pitch=0.65)
            yaw = 0.0 if yaw else 0.3
            t += 0.65
            frames.add(t, yaw=yaw, pitch=0.65)
        frames.add(t + move, pitch=pressed)
        t += move + rng.uniform(1.0, 5.0)
        frames.add(t - 0.01, pitch=pressed)
    right, left = posing({Foot.RIGHT: frames.motion()}), fidgeting(rng, duration, 15.0)
    return _inside(_car(rng, duration), lambda foot, t: (right if foot is Foot.RIGHT else left)(foot, t))


CRANK = 0.17
"""Length of a crank, m."""


def cycling(rng: Rng, duration: float) -> Posing:
    """Return the feet of a cyclist with 50 to 100 turns of the cranks a minute and 4 to 6.5 m for each turn.

    The rider starts from a stand, out of the saddle, with the left foot on the ground and the right one on the upper
    pedal; then rides, and coasts for 3 to 8 s now and then with level cranks. The foot turns with the crank by 0.15 to
    0.35 rad about a toe that points down by 0.1 to 0.4 rad (Cavanagh and Sanderson 1986, The biomechanics of cycling),
    and a little about the other axes. The frame is a mass on tyres with 9 to 14 Hz."""
    usual, gear = rng.uniform(50.0, 100.0) / 60.0, rng.uniform(4.0, 6.5)
    t, rates = 3.0, list[Key]([(0.0, 0.0), (3.0, 0.0)])
    rates.append((t + 4.0, 0.8 * usual))
    speeds: list[Key] = [(0.0, 0.0), (t, 0.0), (t + 6.0, usual * gear)]
    t += 8.0
    rates.append((t, usual))
    while t < duration:
        pace, end = usual * rng.uniform(0.9, 1.1), t + rng.uniform(10.0, 35.0)
        rates.append((t + 1.5, pace))
        speeds.append((t + 4.0, pace * gear))
        rates.append((end, pace))
        t = end + rng.uniform(0.6, 1.2)
        speeds.append((end + 0.3, pace * gear))
        rates.append((t, 0.0))
        t += rng.uniform(3.0, 8.0)
        speeds.append((t, 0.85 * pace * gear))
        rates.append((t, 0.0))
        t += 1.0
    turning = Way.along(Course.through(*rates), STILL, duration)  # of the cranks: x is their angle, in turns
    heading, bend = list[Key]([(0.0, 0.0)]), 0.0
    for at in np.arange(10.0, duration, 12.0).tolist():
        heading.append((at, bend))
        bend += 0.6 * rng.standard_normal()
        heading.append((at + 6.0, bend))
    way = Way.along(Course.through(*speeds), Course.through(*heading), duration)
    shaking = Vibration.drawn(road(rng.uniform(16e-6, 100e-6), on_tyres(rng.uniform(9.0, 14.0), 0.25)), 1.0, 60.0, rng)
    frame = Vehicle(way, shaking, lean=-1.0 / GRAVITY)
    droop, ankling, lag = rng.uniform(0.1, 0.4), rng.uniform(0.15, 0.35), rng.uniform(-0.5, 0.5)
    sway, toe, phase = rng.uniform(0.0, 0.05), rng.uniform(0.0, 0.12), rng.uniform(0.0, 2.0 * pi)
    rocking = rng.uniform(0.05, 0.15)
    out_of_saddle = Course.through((0.0, 1.0), (3.0, 1.0), (9.0, 0.0))  # 1 while the rider stands on the pedals
    mounts = Course.through((0.0, 0.0), (3.5, 0.0), (4.6, 1.0))  # the left foot goes from the ground to its pedal

    def pose(foot: Foot, t: Array) -> Pose:
        angle = 2.0 * pi * turning.x.at(t) + (0.3 if foot is Foot.RIGHT else pi + 0.3)
        # an angle of 0 is the crank ahead, from where it goes down
        x, z = 0.05 + CRANK * np.cos(angle), 0.28 - CRANK * np.sin(angle)
        roll = sway * np.sin(angle + phase)
        pitch = -droop + ankling * np.cos(angle + lag)
        y = np.full_like(t, 1.2 * SIDE_SIGNS[foot] * HALF_WIDTH)
        if foot is Foot.LEFT:
            share = mounts.at(t)
            x, y, z = share * x - (1.0 - share) * 0.1, share * y + (1.0 - share) * 0.3, share * z
            pitch, roll = share * pitch, share * roll
        turn = rotation(np.full_like(t, -SIDE_SIGNS[foot] * toe), -pitch, roll)
        inner = np.stack((x, y, z), axis=1) - turn @ np.array((0.19, 0.0, 0.0)), turn
        tilt = rocking * out_of_saddle.at(t) * np.sin(2.0 * pi * turning.x.at(t))
        lean = np.zeros_like(t), rotation(np.zeros_like(t), np.zeros_like(t), tilt)
        return carried(frame.pose(t), carried((np.zeros((len(t), 3)), lean[1]), inner))

    return pose


def skating(rng: Rng, duration: float) -> Posing:
    """Return the feet of an inline skater at 3 to 7 m/s, whose feet push aside in turn, 1.5 to 2.4 s apart each.

    A foot glides outwards for 70 to 78 % of the cycle, turned out by 0.2 to 0.4 rad, and leans on its inner edge at the
    end of the push; then it is lifted by 4 to 12 cm and set down beside the other one. Small wheels on asphalt shake it
    up to 50 Hz while it is on the ground, and it rolls without a stop."""
    cycle, glide = rng.uniform(1.5, 2.4), rng.uniform(0.70, 0.78)
    top, out, width, lift = (rng.uniform(*one) for one in ((3.0, 7.0), (0.2, 0.4), (0.25, 0.5), (0.04, 0.12)))
    edge = rng.uniform(0.15, 0.4)
    way = Way.along(
        Course.through(
            (0.0, 0.0),
            (2.0, 0.0),
            (10.0, top),
            *[(t, top * rng.uniform(0.9, 1.1)) for t in range(16, int(duration), 6)],
        ),
        Course.through((0.0, 0.0), *[(t, float(0.3 * rng.standard_normal())) for t in range(10, int(duration), 8)]),
        duration,
    )
    shaking = Vibration.drawn(road(rng.uniform(8e-6, 32e-6), on_tyres(35.0, 0.4)), 3.0, 80.0, rng)
    motions, grounded = {}, {}
    for foot in Foot:
        side, t = SIDE_SIGNS[foot], 2.0 + (0.5 * cycle if foot is Foot.RIGHT else 0.0)
        near, keys = side * 0.08, list[Key]([(0.0, 1.0)])
        frames = Frames(x=0.0, y=near, z=0.0, pitch=0.0, roll=0.0, yaw=0.0)
        while t < duration - LAST_MOVE:
            period = cycle * rng.normal(1.0, 0.04)
            push, end = t + glide * period, t + period
            far = near + side * width * rng.normal(1.0, 0.1)
            frames.add(t, x=0.1, y=near, z=0.0, pitch=0.0, yaw=side * 0.3 * out, roll=0.0)
            frames.add(push - 0.4, yaw=side * out, roll=0.0)
            frames.add(push, x=-0.15, y=far, z=0.0, roll=side * edge, pitch=-0.03)
            frames.add(0.5 * (push + end), z=lift, pitch=-0.25, roll=0.0, yaw=side * out)
            keys += [(t, 1.0), (push, 1.0), (push + 0.05, 0.0), (end - 0.03, 0.0)]
            t = end + 0.01
        frames.add(t, x=0.0, y=near, z=0.0, pitch=0.0, roll=0.0, yaw=0.0)
        keys.append((t, 1.0))
        motions[foot], grounded[foot] = frames.motion(), Course.through(*keys)

    def pose(foot: Foot, t: Array) -> Pose:
        place, turn = motions[foot].pose(t)
        place[:, 2] += 0.09 + grounded[foot].at(t) * np.sqrt(np.sqrt(way.speed.at(t) ** 2 + 1e-4)) * shaking.at(t)
        return carried((way.place(t), rotation(way.heading.at(t), np.zeros_like(t), np.zeros_like(t))), (place, turn))

    return pose


CASTOR = 0.07
"""Radius of the front wheels of a wheelchair, m; one climbs over a height h within sqrt(2 r h)."""


def wheeling(rng: Rng, duration: float) -> Posing:
    """Return the feet of somebody who pushes a wheelchair, on its rests: 0.6 to 1.2 pushes a second, 0.5 to 1.4 m/s.

    Each push of 0.35 s speeds up by what rolling takes until the next one, 0.15 to 0.4 m/s (Vanlandewijck et al. 2001,
    Sports Med. 31). The chair turns on the spot, stops, and goes over thresholds of 0.5 to 2 cm, every 5 s or so; small
    solid wheels shake it. The feet are moved on the rests every 15 s or so."""
    gap, usual, change = 1.0 / rng.uniform(0.6, 1.2), rng.uniform(0.5, 1.4), rng.uniform(0.15, 0.4)
    t, heading, bump = 3.0, 0.0, 5.0
    speeds, headings = list[Key]([(0.0, 0.0)]), list[Key]([(0.0, 0.0)])
    while t < duration - LAST_MOVE:
        speeds.append((t, 0.0))
        for _ in range(int(rng.integers(6, 20))):
            low, high = usual - 0.5 * change, usual + 0.5 * change
            speeds += [(t + 0.35, high, -change / gap), (t + gap, low, -change / gap)]
            t += gap * rng.uniform(1.0, 1.08)
        t += 1.2
        speeds.append((t, 0.0))
        if rng.uniform() < 0.6:
            headings.append((t + 0.3, heading))
            heading += rng.uniform(-pi, pi)
            t += 0.3 + 1.0 + rng.uniform(0.5, 1.5)
            headings.append((t, heading))
        t += rng.uniform(0.3, 2.5)
    heights: list[Key] = [(0.0, 0.0)]
    while bump < duration:
        height = rng.uniform(0.005, 0.02)
        climb = sqrt(2.0 * CASTOR * height) / usual
        heights += [(bump, 0.0), (bump + climb, height), (bump + 2.0 * climb, 0.0)]
        bump += rng.exponential(5.0) + 0.5
    way = Way.along(Course.through(*speeds), Course.through(*headings), duration)
    shaking = Vibration.drawn(road(rng.uniform(4e-6, 32e-6), on_tyres(25.0, 0.3)), 3.0, 60.0, rng)
    chair, jolts, rest = Vehicle(way, shaking), Course.through(*heights), rng.uniform(0.0, 0.5)
    feet = fidgeting(rng, duration, 15.0)

    def pose(foot: Foot, t: Array) -> Pose:
        place, turn = chair.pose(t)
        jolt = jolts.at(t) * np.tanh(way.speed.at(t) / 0.3)
        place[:, 2] += jolt
        still = np.zeros_like(t)
        # the rests are half a metre ahead of the axle, about which the chair tilts, and slope
        tilted = turn @ rotation(still, -jolt / 0.5, still) @ rotation(np.zeros(1), np.array([-rest]), np.zeros(1))
        return carried((place, tilted), feet(foot, t))

    return pose

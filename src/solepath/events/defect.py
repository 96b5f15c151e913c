"""Events of what is wrong: data that contradict themselves or physics, cells that fail, sensors worn wrongly.

The session continues without the faulty data."""

from __future__ import annotations

from enum import Enum

from ..types import Foot, Site
from ..types.attrs import frozen
from .happening import BaseEvent


class Defect(Enum):
    """A kind of wrong data of a sensor; the values are words for people and files."""

    TIME_UNIT = "unit of time"
    """The times of the samples are not in seconds."""
    ACC_UNIT = "unit of specific force"
    """The specific force is not in m/s^2."""
    GYRO_UNIT = "unit of angular rate"
    """The angular rate is not in rad/s."""
    PRESSURE_UNIT = "unit of pressure"
    """The pressure of the cells is not in the unit that its layout or calibration says."""
    NO_GRAVITY = "gravity removed"
    """The specific force lacks gravity, which many devices subtract before they send."""
    WRONG_SCALE = "scale"
    """The specific force of a foot that stands is not 1 g."""
    CLIPPED = "range"
    """The motion is larger than the range of the sensor, so its peaks are cut off."""
    LOW_RATE = "rate"
    """Too few samples a second for steps to be found or for an impact to be followed."""
    BANDWIDTH = "bandwidth"
    """A sensor is filtered or averaged so much that it does not follow a step."""
    BURSTS = "times in bursts"
    """Several samples carry nearly the same time, that of the packet which brought them."""
    REPEATED = "repeated samples"
    """One sensor or both repeat values more often than they measure, or none of the values changes at all."""
    AXES = "axes"
    """The axes of the gyroscope are mirrored or exchanged against those of the accelerometer."""
    CONTRADICTION = "motion of the two sensors"
    """The gyroscope and the accelerometer describe different motions, which no exchange of axes explains.

    The times of the samples may be wrong by a factor, or the scale of the gyroscope."""
    CLOCKS = "clocks of the feet"
    """The times of the two feet are not on one clock."""
    IMPOSSIBLE_MOTION = "motion"
    """A speed, an angle or a height that no person has."""
    LOOSE = "mounting"
    """The sensor moves against the shoe, because it came loose."""
    MOVING_GROUND = "moving ground"
    """The ground carries the wearer, as a moving walkway or an escalator does."""
    CALIBRATION = "calibration of the heading"
    """Straight ways contradict the calibration of the heading: it is of other shoes or sensors, or too old."""
    COMPASS = "compass"
    """The magnetic field is none of the earth, or turns with the foot."""
    AIR_PRESSURE = "air pressure"
    """The air pressure changes by more or less than the height of the strides: by doors, or a faulty barometer."""


@frozen(kw_only=True)
class DefectFound(BaseEvent):
    """The data of a sensor contradict themselves or physics, so what follows from them cannot be trusted.

    `t` is the time of the sample or stride that showed it, with which it is reported. While a defect that `spoils`
    lasts, the strides of the foot are marked degraded: until another device is connected there, or the clock of the
    device restarts. Until then each defect of a site is reported once, but AXES once more when the correction is known,
    IMPOSSIBLE_MOTION when most strides are impossible, CLIPPED when it becomes frequent, CLOCKS whenever the offset has
    changed, and MOVING_GROUND whenever the ground starts or stops to move."""

    site: Site
    """Site whose data are wrong; for clocks, the right foot, whose times would have to be shifted."""
    defect: Defect
    what: str
    """Sentences for the person who wears or mounts the sensor: the fault, and what to do about it."""
    spoils: bool = True
    """Flag: strides and gait parameters cannot be right; False for a defect that only makes them less accurate."""
    axes: tuple[int, int, int] | None = None
    """Correction of AXES: number of the gyroscope's axis, 1 to 3, that belongs to each axis of the accelerometer.

    A negative number means that this axis has the wrong sign. None for other defects."""
    offset: float | None = None
    """Correction of CLOCKS: time to add to the times of this foot, s, except for whole gait cycles.

    None for other defects, and for clocks that may be seconds apart."""
    sigma: float | None = None
    """Standard deviation of `offset`, s; None without an offset."""

    @property
    def spoilt_foot(self) -> Foot | None:
        """Foot that nothing can be taken from; None for another site and a defect that costs less.

        A peak that is cut off has its time: the strides of such a foot are degraded, and it goes on to count."""
        return self.site.foot if self.spoils and self.defect is not Defect.CLIPPED else None

    @property
    def separates_feet(self) -> bool:
        """True when the times of the feet cannot be compared: clocks are apart, or a foot's data cannot be right."""
        return self.spoilt_foot is not None or self.defect is Defect.CLOCKS

    @property
    def needs_action(self) -> bool:
        """True when results are wrong until somebody acts on `what`; False for a mere loss of accuracy."""
        return self.spoils or self.defect is Defect.CLOCKS


class CellFault(Enum):
    """Fault of a pressure cell."""

    DEAD = "dead"
    """The cell shows no load although its neighbours do."""
    STUCK = "stuck"
    """The cell's value never changes."""
    SATURATED = "saturated"
    """The cell's value stays at the end of its range."""
    INVERTED = "inverted"
    """The cell's value falls under load."""
    NOISY = "noisy"
    """The cell's value jumps from sample to sample, as that of an open input or with hum of the mains."""
    MISSING = "missing"
    """The cell's value is not a number."""


@frozen(kw_only=True)
class CellsFailed(BaseEvent):
    """Some cells have a fault and are not used from `t` on; it is reported once for each fault and set of cells.

    `t` is the end of the second of two successive windows of walking that show the fault, at which it is reported; a
    window has at least four swings and 3 s. MISSING is reported after 1 s."""

    site: Site
    fault: CellFault
    """Fault of the cells."""
    cells: tuple[int, ...]
    """Numbers of the cells in the layout's order, from 0."""


@frozen(kw_only=True)
class InsoleNeverUnloads(BaseEvent):
    """The insole shows load all the time while the foot walks: it is jammed, or the shoe presses on it too hard.

    While that lasts, phases come from the inertial sensor. `t` is the end of the second of two successive windows of
    walking in which the load never ended, at which it is reported; a window has at least four swings and 3 s."""

    site: Site
    seconds: float
    """Time for which the load has lasted so far, s."""


@frozen(kw_only=True)
class FeetSwapped(BaseEvent):
    """The data of each foot look like those of the other foot, so the sensors or insoles may be on the wrong feet.

    It is reported once, and the session does not exchange the feet. `t` is the time at which it is reported: when the
    layouts of both insoles show it, else after at least 8 strides of each foot, by the way in which the feet roll or
    load moves over the soles. It is reported late or never for a wearer who hardly rolls the feet."""


@frozen(kw_only=True)
class FootSilent(BaseEvent):
    """One foot continues to walk while no data come from the other foot.

    `t` is the walking foot's first sample after three of its strides and 3 s without a sample of the silent foot. It is
    reported with that sample."""

    foot: Foot
    """Foot without data."""
    silent_for: float
    """Time since the last sample of `foot`, s."""


@frozen(kw_only=True)
class FootResumed(BaseEvent):
    """Samples of a foot came again after FootSilent; `t` is the first of them, with which it is reported."""

    foot: Foot
    """Foot that was silent."""
    silent_for: float
    """Time from the last sample of `foot` before the silence to the first sample after it, s."""

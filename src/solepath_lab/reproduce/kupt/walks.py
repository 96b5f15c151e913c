"""One emulated walk of the experiment, the shoes and sensors that it may have, and the recipes that run on it."""

from __future__ import annotations

from math import inf
from pathlib import Path
from tempfile import TemporaryDirectory

from attrs import evolve, frozen

from solepath.calibration import Calibration
from solepath.calibration.records import merged
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX, MPU9250, WORN_RESISTIVE, Imu
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.gait import Wearer
from solepath.emulate.wearers.shoe import Shoe
from solepath.papers.kupt_dfpc.known_velocity import KnownVelocity, KnownVelocitySettings
from solepath.papers.kupt_dfpc.noise import pressure_noise
from solepath.papers.kupt_dfpc.recipe import KUPT
from solepath.papers.kupt_dfpc.shoe.fit import fit_shoe
from solepath.papers.kupt_dfpc.soft_swing import DriftTime, SoftSwing
from solepath.papers.kupt_dfpc.swing_drift import SwingDedrift
from solepath.types import SITE_OF_FOOT, Foot
from solepath.types.attrs import state, stateful

from ...emulated.laps import corridor, straight
from ...emulated.postures import postures, write_postures
from ...emulated.soles import SLIPPING, WORN
from ..walks import WalkParts, cut_walk, find_halt, join_routes

RATE = 30.0
"""Sampling rate, Hz (section III-A)."""
SPEED = 1.3
"""Comfortable walking speed, m/s."""
WALK_LENGTH = 20.0
"""Length of a walk, m."""
CORRIDOR_LENGTH = 91.0
"""Length of the corridor walk, m (section IV-C)."""
NOISE_WALK = straight(20.0 * SPEED, SPEED).stand(4.0)
"""Route of 20 s of walking to measure the pressure noise, and a halt."""


@frozen
class Setting:
    """The shoe and the sensors of a walk, in which it differs from a worn shoe with filtered sensors."""

    name: str
    """Name in the table."""
    contact: GroundContact = WORN
    """Contact of the sole with the ground."""
    bandwidth: float | None = None
    """Low pass before sampling, Hz (`Insole.bandwidth`)."""
    chip: Imu = LSM6DSOX
    """Chip of the IMU."""


STANDARD = Setting("worn sole")
SETTINGS = (
    Setting("rigid sole", RIGID),
    Setting("pivot +2 cm", evolve(WORN, pivot_shift=0.02)),
    Setting("slip 2 cm", SLIPPING),
    Setting("no low pass", bandwidth=inf),
    Setting("MPU-9250", chip=MPU9250),
)
"""Settings of the sensitivity block; each differs from STANDARD in one thing."""


@stateful
class EvenDrift(DriftTime):
    """Time of the drift in swing that is not learnt: the drift is linear, as in (8)."""

    def add(self, rise: float, slope: float) -> None:
        return


@stateful
class LinearSwing(SoftSwing):
    """Ours without the learnt time of the drift."""

    drift_time: DriftTime = state(factory=EvenDrift)


@stateful
class UnbiasedSwing(SoftSwing):
    """Ours without the bias of the accelerometer."""

    def scaled(self, scale: float) -> None:
        return


NOT_ROLLING = KnownVelocity(KnownVelocitySettings(rolling_sigma=inf))
"""Detector whose velocities of a rolling shoe nobody uses."""
SAME = "ZUPT, same additions"
VARIANTS = {
    "KUPT as printed, our load": evolve(KUPT, corrector=SwingDedrift()),
    "KUPT, no bias": evolve(KUPT, corrector=UnbiasedSwing()),
    "KUPT, linear in swing": evolve(KUPT, corrector=LinearSwing()),
    SAME: evolve(KUPT, detector=NOT_ROLLING),
}
"""Ours without one addition, and our additions without any velocity of a rolling shoe."""


@frozen(eq=False)
class PreparedWalk:
    """An emulated walk, cut at the halt before its measured part, with what was calibrated before."""

    walk: EmulatedWalk
    parts: WalkParts
    t_halt: float
    """Time of the halt, s."""
    calibration: Calibration
    """Shoe from static postures and pressure noise from the first part."""

    def true_distance(self, foot: Foot) -> float:
        """Return the true sum of the stride lengths of a foot after the halt, m."""
        return sum(one.length for one in self.walk.truth.strides(foot) if one.t_heel_off > self.t_halt)


def prepare(seed: int, setting: Setting, in_corridor: bool) -> PreparedWalk:
    """Emulate one walk and calibrate on its first part."""
    route = corridor(CORRIDOR_LENGTH, SPEED) if in_corridor else straight(WALK_LENGTH, SPEED)
    insole = Insole(rate=RATE, cell_part=WORN_RESISTIVE, bandwidth=setting.bandwidth, chip=setting.chip)
    wearer = Wearer(shoe=Shoe(contact=setting.contact))
    devices = {SITE_OF_FOOT[foot]: insole for foot in Foot}
    walk = emulate(join_routes(NOISE_WALK, route), wearer=wearer, devices=devices, seed=seed)
    t_halt = find_halt(walk.walker, NOISE_WALK)
    parts = cut_walk(walk, t_halt)
    calibration = merged(merged(parts.layouts, measured_shoe(seed)), pressure_noise(parts.before))
    return PreparedWalk(walk, parts, t_halt, calibration)


def measured_shoe(seed: int) -> Calibration:
    """Return the calibration that rulers and static postures give for the shoe."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "postures.csv"
        write_postures(file, postures(seed=seed))
        return fit_shoe(file).calibration

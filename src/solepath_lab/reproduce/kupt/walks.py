"""One emulated walk of the experiment, the shoes and sensors that it may have, and the recipes that run on it."""

from __future__ import annotations

from math import inf, radians
from pathlib import Path
from tempfile import TemporaryDirectory

from attrs import evolve, frozen

from solepath.calibration import Calibration
from solepath.calibration.records import merged
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.parts import LSM6DSOX, MPU9250, WORN_RESISTIVE, Imu
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.emulate.wearers.contact import RIGID, GroundContact
from solepath.emulate.wearers.gait import LoadLaw, Wearer
from solepath.emulate.wearers.shoe import IN_SOLE, Mounting, Shoe
from solepath.papers.kupt_dfpc.fusion import DoubleFoot, FusionSettings
from solepath.papers.kupt_dfpc.noise import pressure_noise
from solepath.papers.kupt_dfpc.recipe import KUPT, KUPT_DFPC
from solepath.papers.kupt_dfpc.shoe.fit import fit_shoe
from solepath.papers.kupt_dfpc.swing.dedrift import SwingDedrift
from solepath.papers.kupt_dfpc.swing.settings import PRINTED, SoftSwingSettings
from solepath.papers.kupt_dfpc.swing.soft import SoftSwing
from solepath.types import SITE_OF_FOOT, Foot, Vec3
from solepath.types.attrs import define
from solepath.types.vector import from_rotation_vector

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
    tilt: float = 0.0
    """Tilt of the IMU in the sole about the axis across the foot, rad; nobody knows it."""
    bounce_speed: float = SPEED
    """Walking speed, m/s: the load's peaks grow with its square, the steps with its root."""
    load_law: LoadLaw = LoadLaw.OUTWARD
    """Law by which the load moves in a bend; a straight walk has none."""
    with_additions: bool = False
    """True if these walks, too, have a row for each of our additions."""


STANDARD = Setting("worn sole", with_additions=True)
SETTINGS = (
    Setting("rigid sole", RIGID),
    Setting("pivot -1 cm", evolve(WORN, pivot_shift=-0.01)),
    Setting("pivot +1 cm", evolve(WORN, pivot_shift=0.01)),
    Setting("pivot +2 cm", evolve(WORN, pivot_shift=0.02), with_additions=True),
    Setting("slip 2 cm", SLIPPING),
    Setting("impact 14 ms", evolve(WORN, impact_time=0.014, impact_variation=0.0)),
    Setting("impact 50 ms", evolve(WORN, impact_time=0.05, impact_variation=0.0)),
    Setting("tilt 5 deg", tilt=radians(5.0)),
    Setting("no low pass", bandwidth=inf),
    Setting("MPU-9250", chip=MPU9250),
    Setting("slow, flat load", bounce_speed=0.9),
)
"""Settings of the sensitivity block; each differs from STANDARD in one thing."""
OTHER_LAW = Setting("load heel out, forefoot in", load_law=LoadLaw.HEEL_OUT_FOREFOOT_IN)
"""Setting of the corridor, the walk with bends, in which the load moves by the other law."""


@define
class ZuptBias(SoftSwing):
    """ZUPT with one linear drift for each motion, to which only the accelerometer's bias is added."""

    def _calibrated_displacement(self, duration: float) -> Vec3 | None:
        return None


ABLATIONS = {
    "KUPT as printed, our load": evolve(KUPT, corrector=SwingDedrift(PRINTED)),
    "KUPT + slide": evolve(KUPT, corrector=SwingDedrift()),
    "KUPT + soft": evolve(
        KUPT, corrector=SoftSwing(SoftSwingSettings(bias_share=0.0, learns_rolling=False, learns_time=False))
    ),
    "KUPT + pivot, slide": evolve(KUPT, corrector=SoftSwing(SoftSwingSettings(bias_share=0.0, learns_time=False))),
    "KUPT + time": evolve(KUPT, corrector=SoftSwing(SoftSwingSettings(bias_share=0.0))),
    "KUPT (+ bias)": KUPT,
    "ZUPT + bias only": evolve(KUPT, corrector=ZuptBias()),
    "ZUPT + soft": evolve(
        KUPT, corrector=SoftSwing(SoftSwingSettings(bias_share=0.0, uses_rolling=False, learns_time=False))
    ),
    "ZUPT + time": evolve(KUPT, corrector=SoftSwing(SoftSwingSettings(bias_share=0.0, uses_rolling=False))),
}
"""Our additions to KUPT, one after the other, and those additions to ZUPT, which has no velocity of a rolling shoe."""
SAME_ADDITIONS = evolve(KUPT_DFPC, corrector=SoftSwing(SoftSwingSettings(uses_rolling=False)))
"""ZUPT with all our additions to KUPT, fused: unlike in `KUPT_DFPC` no velocity of a rolling shoe corrects the track.

Error indices (10) still tell which strides are normal; `DoubleFoot` leaves the others alone."""
BY_ERROR_INDEX = KUPT_DFPC.replace_part(
    DoubleFoot, DoubleFoot(FusionSettings(by_variance=False)), "KUPT+DFPC by error index"
)
"""Our KUPT with strides weighted by their error indices, as in (11)."""


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
    speed = setting.bounce_speed
    route = corridor(CORRIDOR_LENGTH, speed) if in_corridor else straight(WALK_LENGTH, speed)
    tilted = Mounting(IN_SOLE.position, from_rotation_vector((0.0, setting.tilt, 0.0)))
    insole = Insole(
        rate=RATE, cell_part=WORN_RESISTIVE, bandwidth=setting.bandwidth, chip=setting.chip, mounting=tilted
    )
    wearer = Wearer(shoe=Shoe(contact=setting.contact), load_law=setting.load_law)
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

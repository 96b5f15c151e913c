"""Errors of sensor chips, pressure cells and whole devices, from their data sheets.

A tolerance of +-x in a sheet is taken as two standard deviations between specimens. No sheet specifies how a bias
changes over time. Here it changes slowly, as if with the temperature; its standard deviation is the sheet's drift per
kelvin times WARMING. Comments name what is assumed. (*) marks figures that have not been compared with the sheet."""

from __future__ import annotations

from math import inf, radians

from attrs import evolve, frozen

from ...types.vector import GRAVITY

WARMING = 2.0
"""Standard deviation of the temperature of a worn device, K (assumed)."""

_G = GRAVITY
_MG = 1e-3 * GRAVITY
_DPS = radians(1.0)


@frozen
class TriadErrors:
    """The errors of a three-axis sensor, as standard deviations between specimens.

    The unit u is m/s^2 for accelerometers, rad/s for gyroscopes and T for magnetometers."""

    density: float
    """White noise density, u/sqrt(Hz)."""
    bias: float
    """Constant bias, u."""
    drift: float
    """Variation of the bias over time, u: a first-order Gauss-Markov process with this standard deviation."""
    scale: float
    """Relative scale error, no unit."""
    cross: float
    """Relative cross-axis error, no unit."""
    bandwidth: float
    """Bandwidth of the sensor's own second-order low pass, Hz."""
    correlation_time: float = 300.0
    """Correlation time of `drift`, s."""
    bits: int = 16
    """Number of bits of a reading."""
    g_effect: float = 0.0
    """False output per specific force along the same axis, u per m/s^2; its sign is random."""
    bias_limit: float = inf
    """Largest bias, u, where a sheet guarantees a limit."""
    specimen: int | None = None
    """Number of a specimen, which has the same scale, axes and signs of `g_effect` in every walk; None: random."""
    bias_change: float = 1.0
    """Share of `bias` that is another one in every walk; the rest is the specimen's own, the squares add up to 1.

    Sheets give the spread of specimens alone, so that 1.0 supposes nothing about the days of one specimen."""


@frozen
class Imu:
    """The errors of the accelerometer and the gyroscope of a device."""

    name: str
    """Name of the chip or chips."""
    acc: TriadErrors
    """Errors of the accelerometer, unit m/s^2."""
    gyro: TriadErrors
    """Errors of the gyroscope, unit rad/s."""


def _gyro(
    density: float, bias: float, drift: float, scale: float, cross: float, bandwidth: float, g_effect: float = 0.0
) -> TriadErrors:
    """Return the errors of a gyroscope in rad/s.

    `density` is in degrees/s/sqrt(Hz), `bias` in degrees/s, `drift` in degrees/s/K, `g_effect` in degrees/s/g."""
    return TriadErrors(
        density * _DPS, bias * _DPS, drift * WARMING * _DPS, scale, cross, bandwidth, g_effect=g_effect * _DPS / _G
    )


LSM6DSOX = Imu(
    "LSM6DSOX",
    # ST DS12814, table 2 (typical): noise density 110 ug/sqrt(Hz) at +-16 g, zero-g offset +-20 mg, 0.1 mg/K,
    # sensitivity tolerance +-1 %; the low pass at ODR/2 is set by the device. Cross axis is not given: 1 % assumed.
    TriadErrors(
        density=110e-6 * _G, bias=10 * _MG, drift=0.1 * WARMING * _MG, scale=0.005, cross=0.005, bandwidth=400.0
    ),
    # Same table: 3.8 mdps/sqrt(Hz), zero-rate level +-1 dps, 0.010 dps/K, sensitivity tolerance +-1 %.
    _gyro(density=3.8e-3, bias=0.5, drift=0.010, scale=0.005, cross=0.005, bandwidth=400.0),
)

MPU9250 = Imu(
    "MPU-9250",
    # InvenSense PS-MPU-9250A-01 rev. 1.0, table 2: 300 ug/sqrt(Hz), zero-g +-60 mg (x, y) and +-80 mg (z) of which the
    # smaller is used for all, 1.5 mg/K, initial tolerance +-3 %, cross axis +-2 %, low pass up to 260 Hz.
    TriadErrors(
        density=300e-6 * _G, bias=30 * _MG, drift=1.5 * WARMING * _MG, scale=0.015, cross=0.010, bandwidth=260.0
    ),
    # Table 1: 0.01 dps/sqrt(Hz), ZRO +-5 dps, +-30 dps over 125 K (0.24 dps/K as the extreme, half of it as sigma),
    # scale +-3 %, cross axis +-2 %, low pass up to 250 Hz.
    _gyro(density=0.01, bias=2.5, drift=0.12, scale=0.015, cross=0.010, bandwidth=250.0),
)

MPU6050 = Imu(
    "MPU-6050",
    # InvenSense PS-MPU-6000A rev. 3.4, section 6.2 (*): 400 ug/sqrt(Hz), zero-g +-50 mg (x, y) and +-80 mg (z) of which
    # the smaller is used for all, +-35 mg over 70 K (0.5 mg/K), initial tolerance +-3 %, cross axis +-2 %, low pass up
    # to 260 Hz.
    TriadErrors(
        density=400e-6 * _G, bias=25 * _MG, drift=0.5 * WARMING * _MG, scale=0.015, cross=0.010, bandwidth=260.0
    ),
    # Section 6.1 (*): 0.005 dps/sqrt(Hz), the 18 degrees/h/sqrt(Hz) that Sensors 2016, 16, 1809 names; initial ZRO
    # +-20 dps, +-20 dps over 125 K (half of the extreme as sigma), scale +-3 %, cross axis +-2 %, linear acceleration
    # sensitivity 0.1 dps/g, low pass up to 256 Hz.
    _gyro(density=0.005, bias=10.0, drift=0.08, scale=0.015, cross=0.010, bandwidth=256.0, g_effect=0.1),
)

KXTJ9_IMU3000 = Imu(
    "KXTJ9 and IMU-3000",
    # Kionix KXTJ9 (*): 8 bits a reading; zero-g offset +-125 mg at the most, 0.2 mg/K, cross axis 2 %, ODR 50 Hz at
    # reset, low pass at ODR/2. Noise 750 ug/sqrt(Hz) and scale +-3 % are figures of the family, and far below one
    # count of 1/16 g. The maximum of the offset is a limit, which no chip that is sold exceeds.
    TriadErrors(
        density=750e-6 * _G,
        bias=60 * _MG,
        drift=0.2 * WARMING * _MG,
        scale=0.015,
        cross=0.010,
        bandwidth=25.0,
        bits=8,
        bias_limit=125 * _MG,
    ),
    # InvenSense PS-IMU-3000A rev. 1.1 (*): 0.01 dps/sqrt(Hz), initial ZRO +-20 dps, +-0.03 dps/K, scale +-3 %,
    # cross axis 2 %, linear acceleration sensitivity 0.1 dps/g, low pass up to 256 Hz.
    _gyro(density=0.01, bias=10.0, drift=0.03, scale=0.015, cross=0.010, bandwidth=188.0, g_effect=0.1),
)

AK8963 = TriadErrors(density=0.15e-6, bias=10e-6, drift=0.2e-6, scale=0.025, cross=0.01, bandwidth=50.0)
"""Errors of the AK8963 in the MPU-9250, AKM MS1356-E (*): 0.15 uT per count, scale +-5 %. Iron (bias) is assumed."""

MAG3110 = TriadErrors(density=0.25e-6, bias=10e-6, drift=0.2e-6, scale=0.025, cross=0.01, bandwidth=40.0)
"""Errors of the Freescale MAG3110 (*): 0.25 uT rms, 0.1 uT per count, cross axis +-1 %. Iron (bias) is assumed."""


@frozen
class BarometerErrors:
    """The errors of a barometer, as standard deviations."""

    name: str
    """Name of the chip."""
    noise: float
    """Noise of one reading, Pa rms."""
    offset: float
    """Constant offset, between specimens, Pa."""
    drift: float = 8.0
    """Variation over time, weather included, Pa."""
    correlation_time: float = 600.0
    """Correlation time of `drift`, s."""


BMP280 = BarometerErrors("BMP280", noise=1.3, offset=50.0)
"""Bosch BST-BMP280-DS001: absolute accuracy +-1 hPa; 1.3 Pa rms in standard resolution without filter (*)."""

T5400 = BarometerErrors("T5400", noise=6.0, offset=50.0)
"""EPCOS T5400 (*): absolute accuracy +-1 hPa; the noise of a low-power reading is taken as 6 Pa (0.5 m)."""


@frozen
class CellErrors:
    """The errors of a pressure cell that a 12-bit converter reads, as standard deviations between cells.

    In swing the foot still touches the insole and presses on it (`relief_per_g`, `contact_noise`). The load of a cell
    is never negative."""

    name: str
    """Name of the cell."""
    gain: float
    """Relative spread of the gain, no unit."""
    preload: float
    """Mean of the constant load of a cell in the shoe, N; cells have values from 0 to twice the mean, uniformly."""
    noise: float
    """Noise of a reading, N rms."""
    lag: float
    """Time constant of the cell and its foam, s."""
    relief_per_g: float = 0.0
    """Share of the preload that is relieved in swing per g of upward specific force above 1 g; below 1 g it adds."""
    contact_noise: float = 0.0
    """Load that varies as the foot shifts in the shoe in swing, N rms."""
    contact_correlation_time: float = 0.05
    """Correlation time of `contact_noise`, s."""


RESISTIVE = CellErrors("FSR", gain=0.03, preload=0.5, noise=0.12, lag=0.003)
"""Interlink FSR 400 series integration guide (*): part-to-part repeatability +-6 %, break force 0.2 N.

Noise of 2 to 3 counts, the lag of the cover and the in-shoe preload are assumed."""

WORN_RESISTIVE = evolve(RESISTIVE, name="FSR in a laced shoe", relief_per_g=0.3, contact_noise=0.2)
"""Errors of resistive cells with the contact of the foot in swing.

Neither sheets nor papers give figures. Assumed: each g relieves 0.3 of the preload (a laced foot presses with about
50 N in all), and the load of a cell varies by 0.4 of its mean preload."""


@frozen
class AttitudeErrors:
    """The errors of the attitude that a device estimates, as standard deviations.

    The accuracy of a sheet is taken as one standard deviation; the makers who define it do the same."""

    name: str
    """Name of the device."""
    tilt: float
    """Error about either horizontal axis, rad."""
    heading: float
    """Error about the vertical axis, rad."""
    correlation_time: float = 30.0
    """Correlation time of the errors, s (assumed)."""
    steady_tilt: float = 0.0
    """Tilt that stays the same about either horizontal axis of the device's world, rad, added to `tilt`.

    A device that takes away gravity in a wrong direction has such an error: the false acceleration then has a fixed
    direction in the world."""


CRE_CC02 = AttitudeErrors("CRE-CC02", tilt=radians(0.81), heading=radians(0.81))
"""Nine-axis unit of Gong et al. 2023, Sensors 23, 5417, section 3.1: absolute angle accuracy 0.81 degrees."""

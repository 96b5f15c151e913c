"""Bias of the accelerometer, estimated while the foot stands: equations (4) to (10) of Bebek et al. 2010.

"Personal navigation via high-resolution gait-corrected inertial measurement units" (IEEE Trans. Instrum. Meas. 59,
2010). All vectors are in the sensor frame, in which the bias is constant. a_m is the measured acceleration without
gravity (4), a_b the bias and a_n the noise. A standing foot has a_m + a_b + a_n = 0 (6)(7), so -a_m is a measurement of
z = a_b (8)(9). With F = I, H = I, G_1 = I and no input (A = B = 0) the Kalman filter is

    measurement   z_hat = z_bar + P Sigma_v^-1 (-a_m - z_bar),   P = M - M (M + Sigma_v)^-1 M
    time          z_bar = z_hat,   M = P + Sigma_w

P and M are the covariances after and before a measurement. They start as multiples of the identity and stay so; one
number stands for three axes. (10) as printed, a_a = a_m - R a_b, contradicts (6), a_a = a_m + R a_b + R a_n. Since -a_m
measures a_b, (10) would double the error instead of removing it. The sign here is that of (6)."""

from __future__ import annotations

from ...types import Vec3
from ...types.attrs import stateful
from ...types.vector import ZERO, add

BIAS_SIGMA = 0.098
"""Standard deviation of the bias before anything is known, m/s^2."""
SAMPLE_NOISE = 0.0076
"""Square root of Sigma_v, the noise of one sample, m/s^2."""
BIAS_WANDER = 1.6e-4
"""Square root of Sigma_w for one second, m/s^2/sqrt(s): sqrt(2 / 300 s) 0.2 mg."""


@stateful
class AccelerometerBias:
    """Kalman filter for the bias of three equal axes, m/s^2, sensor frame.

    The numbers are those of the ST LSM6DSOX (DS12814, table 2): a zero-g offset of +-20 mg, taken as two sigma; noise
    of 110 ug/sqrt(Hz) over the bandwidth of 50 Hz at 100 samples a second; a drift of 0.1 mg/K over 2 K in 300 s. The
    paper estimates both covariances from an hour at rest, and does not say how; because the filter gains nothing here,
    no calibration does."""

    bias: Vec3 = ZERO
    """Estimated bias z_hat, m/s^2, sensor frame."""
    variance: float | None = None
    """Variance M of the bias, (m/s^2)^2; None before the first sample."""

    @property
    def _prior(self) -> float:
        return BIAS_SIGMA * BIAS_SIGMA if self.variance is None else self.variance

    def propagate(self, dt: float) -> None:
        """Propagate the variance by `dt` s: M[k + 1] = P[k] + Sigma_w; z_bar[k + 1] = z_hat[k]."""
        self.variance = self._prior + BIAS_WANDER * BIAS_WANDER * dt

    def correct(self, measured: Vec3) -> None:
        """Correct the bias by one sample of a standing foot.

        `measured` is a_m, the measured acceleration without gravity, sensor frame, m/s^2."""
        prior = self._prior
        sigma_v = SAMPLE_NOISE * SAMPLE_NOISE
        posterior = prior - prior * prior / (prior + sigma_v)
        gain = posterior / sigma_v
        self.bias = add(self.bias, add(measured, self.bias), -gain)
        self.variance = posterior

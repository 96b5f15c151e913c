"""Quantiles of the chi-squared and Student's t distribution, without a library and without random numbers."""

from __future__ import annotations

from math import exp, lgamma, log, sqrt

Z = 1.959963984540054
"""Quantile 0.975 of the normal distribution: two-sided intervals at 95 %."""
MAX_TERMS = 10_000
"""Largest number of terms of a series or continued fraction; hundreds are needed for thousands of strides."""
TOLERANCE = 1e-12
"""Relative error at which a series, a continued fraction or a search ends."""


def student_quantile(degrees: float) -> float:
    """Return the quantile 0.975 of Student's t with `degrees` of freedom, at least 1.

    It is the expansion 26.7.5 of Abramowitz and Stegun 1964, whose error is 0.1 % with 3 degrees and 4 % with 2."""
    z, v = Z, max(degrees, 1.0)
    terms = (
        (z**3 + z) / 4.0,
        (5.0 * z**5 + 16.0 * z**3 + 3.0 * z) / 96.0,
        (3.0 * z**7 + 19.0 * z**5 + 17.0 * z**3 - 15.0 * z) / 384.0,
        (79.0 * z**9 + 776.0 * z**7 + 1482.0 * z**5 - 1920.0 * z**3 - 945.0 * z) / 92160.0,
    )
    value = z
    for power, term in enumerate(terms, start=1):
        value += term / v**power
    return value


def chi_squared_quantile(share: float, degrees: float) -> float:
    """Return the value below which a `share` of the chi-squared distribution with `degrees` of freedom lies.

    A bisection of the distribution function, between bounds that hold for shares from 0.001 to 0.999."""
    low, high = 0.0, degrees + 10.0 * sqrt(2.0 * degrees) + 20.0
    while high - low > TOLERANCE * high:
        middle = 0.5 * (low + high)
        if lower_gamma(0.5 * degrees, 0.5 * middle) < share:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)


def lower_gamma(a: float, x: float) -> float:
    """Return the regularised lower incomplete gamma function P(a, x), a > 0 (Abramowitz and Stegun 1964, 6.5).

    Below a + 1 by the series 6.5.29, above by the continued fraction 6.5.31."""
    if x <= 0.0:
        return 0.0
    scale = exp(a * log(x) - x - lgamma(a))
    if x < a + 1.0:
        term = total = 1.0 / a
        for n in range(1, MAX_TERMS):
            term *= x / (a + n)
            total += term
            if term < TOLERANCE * total:
                break
        return scale * total
    # modified Lentz: Thompson and Barnett 1986, J. Comput. Phys. 64
    b = x + 1.0 - a
    c, d = 1e300, 1.0 / b
    value = d
    for n in range(1, MAX_TERMS):
        factor = -n * (n - a)
        b += 2.0
        d = 1.0 / (factor * d + b)
        c = b + factor / c
        value *= c * d
        if abs(c * d - 1.0) < TOLERANCE:
            break
    return 1.0 - scale * value

"""Quantiles of the chi-squared and Student's t distribution, without a library and without random numbers."""

from __future__ import annotations

from math import exp, fsum, lgamma, log, sqrt

Z = 1.959963984540054
"""Quantile 0.975 of the normal distribution: two-sided intervals at 95 %."""
MAX_TERMS = 10_000
"""Largest number of terms of a series; hundreds are needed for thousands of strides."""
TOLERANCE = 1e-12
"""Relative error at which a series or a search ends."""
STUDENT_TERMS = (2.372271230298562, 2.8224986157396112, 2.555849679507722, 1.5895340533938225)
"""Terms of the expansion 26.7.5 of Abramowitz and Stegun 1964 at the quantile Z, in one over the degrees of freedom:
(z^3 + z) / 4, (5 z^5 + 16 z^3 + 3 z) / 96, (3 z^7 + 19 z^5 + 17 z^3 - 15 z) / 384, and
(79 z^9 + 776 z^7 + 1482 z^5 - 1920 z^3 - 945 z) / 92160."""


def student_quantile(degrees: float) -> float:
    """Return the quantile 0.975 of Student's t with `degrees` of freedom, at least 1.

    The error of the expansion is 0.1 % with 3 degrees and 4 % with 2."""
    return Z + fsum([term / max(degrees, 1.0) ** power for power, term in enumerate(STUDENT_TERMS, start=1)])


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
    """Return the regularised lower incomplete gamma function P(a, x), a and x > 0.

    The series 6.5.29 of Abramowitz and Stegun 1964."""
    term = total = 1.0 / a
    for n in range(1, MAX_TERMS):
        term *= x / (a + n)
        total += term
        if term < TOLERANCE * total:
            break
    return exp(a * log(x) - x - lgamma(a)) * total

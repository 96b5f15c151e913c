"""Figures of the papers, as printed.

Chen et al. 2019: D. Chen and others, "Smart Insole-Based Indoor Localization System for Internet of Things
Applications", IEEE Internet of Things Journal. Bebek et al. 2010: O. Bebek and others, "Personal Navigation via
High-Resolution Gait-Corrected Inertial Measurement Units", IEEE Transactions on Instrumentation and Measurement. Gong
et al. 2023: "Improving Accuracy of Real-Time Positioning and Path Tracking by Using an Error Compensation Algorithm
against Walking Modes", Sensors. Liu et al. 2015: C. Liu and others, "Track Your Foot Step: Anchor-free Indoor
Localization based on Sensing Users' Foot Steps", IEEE MASS. Li et al. 2016: F. Li and others, "3D Tracking via Shoe
Sensing", Sensors 16, 1809."""

from __future__ import annotations

from attrs import frozen

from solepath.papers.walking_modes import compensation
from solepath.types import Foot, WalkingMode

from .tables import Statistics, Table, statistics

KUPT_DFPC_TITLE = "Chen et al. 2019, table I"

KUPT_DFPC: Table = {
    "ZUPT-L": Statistics(20.97, 1.84, 19.74, 21.17, 22.56),
    "ZUPT-R": Statistics(21.16, 0.73, 20.61, 21.07, 21.62),
    "KUPT-L": Statistics(19.58, 1.24, 18.67, 19.64, 20.77),
    "KUPT-R": Statistics(20.44, 0.5, 20.14, 20.36, 20.52),
    "KUPT+DFPC": Statistics(20.08, 0.51, 19.74, 20.06, 20.46),
}
"""Table I: walked distance, m, in 20 walks of 20 m, by method and foot (L, R)."""

KUPT_DFPC_ROWS: Table = {
    **KUPT_DFPC,
    "KUPT-L, printed": KUPT_DFPC["KUPT-L"],
    "KUPT-R, printed": KUPT_DFPC["KUPT-R"],
    "KUPT+DFPC, printed": KUPT_DFPC["KUPT+DFPC"],
    "known by ZUPT %": Statistics(mean=24.0),
    "known by KUPT %": Statistics(mean=62.0),
}
"""Table I beside our KUPT and KUPT as printed, and the shares of a gait cycle in which the velocity is known, %."""

KUPT_L_MEAN_IN_TEXT = 19.68
"""Mean of KUPT-L in the text below table I, m. Only the mean in the table gives the stated error of 2.1 %."""

CORRIDOR_DRIFT = {"ZUPT-L": 11.15, "ZUPT-R": 7.43, "KUPT+DFPC": 0.78}
"""Error of the total walking distance after about 91 m, m (section IV-C; fig. 13 draws the tracks)."""


PRESSURE_CONTOUR_TITLE = "Bebek et al. 2010, table I"


@frozen
class Loop:
    """A half-hour walk of table I: its length and its loop-closing errors, m."""

    distance: float
    gyroscope: float
    pressure: float


LOOPS = (
    Loop(987.0, 1.97, 2.96),
    Loop(656.0, 4.98, 6.14),
    Loop(930.0, 6.45, 4.90),
    Loop(1056.0, 2.52, 1.04),
    Loop(1848.0, 3.89, 1.45),
    Loop(1811.0, 9.39, 9.33),
)
"""Experiments 1 to 6 of table I.

The fourth is the square of fig. 14, the fifth the random walk of figs. 15 and 16. The paper does not describe the
others."""


PRESSURE_CONTOUR: Table = {
    "Gyroscope m": statistics([loop.gyroscope for loop in LOOPS]),
    "Pressure m": statistics([loop.pressure for loop in LOOPS]),
    "Gyroscope %": statistics([100.0 * loop.gyroscope / loop.distance for loop in LOOPS]),
    "Pressure %": statistics([100.0 * loop.pressure / loop.distance for loop in LOOPS]),
}
"""Statistics of LOOPS: loop-closing error in m and in % of the path.

Means and standard deviations in m are those that the paper prints (4.87 +- 2.75 and 4.30 +- 3.15). The paper's mean
percentages, 0.40 and 0.35, are its mean errors divided by its mean distance instead."""


PRESSURE_VELOCITY: Table = {"Pressure mm/s": Statistics(mean=4.0)}
"""Table II: "zero-velocity sensing bias per step", mm/s, which the paper calls limited by its images.

The table has 28 mm/s for the state of the art, whatever its detector."""


WALKING_MODES_TITLE = "Gong et al. 2023, table 4"


XY = tuple[float, float]

CORNERS: dict[str, dict[str, tuple[XY, XY, XY]]] = {
    "A": {
        "I": ((0.1556, -0.1141), (0.1569, -0.1134), (0.0298, 0.0225)),
        "II": ((-0.0267, -0.1606), (-0.0286, -0.1579), (0.0154, 0.0322)),
        "III": ((0.0073, -0.1733), (0.009, -0.1717), (0.0149, 0.0373)),
        "IV": ((-0.0063, -0.0289), (-0.008, -0.0289), (0.0152, 0.0162)),
    },
    "B": {
        "I": ((0.1226, 0.0865), (0.1247, 0.0872), (0.0317, 0.0283)),
        "II": ((0.068, 0.034), (0.0709, 0.029), (0.0234, 0.0212)),
        "III": ((0.0844, 0.0461), (0.0824, 0.0452), (0.0255, 0.0202)),
        "IV": ((0.017, -0.0208), (0.0152, -0.0204), (0.0202, 0.0198)),
    },
    "C": {
        "I": ((0.0478, 0.2299), (0.0483, 0.2207), (0.0287, 0.039)),
        "II": ((0.0071, 0.043), (0.0077, 0.0379), (0.0259, 0.0333)),
        "III": ((0.0259, 0.1708), (0.0273, 0.1704), (0.0286, 0.0415)),
        "IV": ((0.0029, 0.015), (0.0007, 0.0217), (0.0283, 0.0309)),
    },
    "D": {
        "I": ((0.0103, 0.1145), (0.0048, 0.1132), (0.0216, 0.031)),
        "II": ((-0.0197, 0.0274), (-0.0166, 0.0286), (0.0203, 0.019)),
        "III": ((-0.0181, 0.0846), (-0.0178, 0.0825), (0.0177, 0.0247)),
        "IV": ((-0.0044, 0.01), (-0.0007, 0.0075), (0.0176, 0.0178)),
    },
}
"""Mean, median and standard deviation of the position error (x, y) by corner and touchdown method, m (table 4).

The heading of the table says mm. Nobody steps on a mark to some hundredths of a millimetre and no inertial sensor
resolves that, so the figures are taken for m here."""


def corner_row(point: str, method: str, axis: str) -> str:
    """Return the name of the row of a corner, a touchdown method and an axis ("x" or "y")."""
    return f"{point} {method} {axis}"


WALKING_MODES: Table = {
    corner_row(point, method, axis): Statistics(mean=mean[k], std=std[k], median=median[k])
    for point, methods in CORNERS.items()
    for method, (mean, median, std) in methods.items()
    for k, axis in enumerate("xy")
}
"""Table 4 as rows, m. It has no quartiles; its variances are the squares of its deviations."""


def table_1_row(foot: Foot, mode: WalkingMode, axis: str) -> str:
    """Return the name of the row of a foot, a walking mode and an axis ("x" to the right or "y" ahead) of table 1."""
    return f"table 1 {foot.value} {mode.value} {axis}"


TABLE_1: Table = {
    table_1_row(foot, mode, axis): Statistics(mean=value)
    for foot, row in compensation.TABLE_1.items()
    for mode, (forward, left) in row.items()
    for axis, value in (("x", -left), ("y", forward))
}
"""Table 1 of Gong et al. 2023 as rows, m, read as cm."""


FOOTSTEP_TRACKER_TITLE = "Liu et al. 2015, section V and fig. 13"

FOOTSTEP_TRACKER: Table = {
    "corridor, one foot %": Statistics(mean=14.65),
    "corridor, by height %": Statistics(mean=14.60),
    "corridor, two feet %": Statistics(mean=4.19),
    "activities %": Statistics(mean=96.2),
    "activities, printed %": Statistics(mean=96.2),
    "corridor's end, one foot %": Statistics(mean=14.65),
    "corridor's end, one-metre rule %": Statistics(mean=4.19),
    "corridor, printed %": Statistics(mean=14.65),
    "turn classes %": Statistics(mean=98.3),
    "place m": Statistics(mean=1.0),
    "place, case study, printed m": Statistics(mean=1.0),
    "steps until decided": Statistics(mean=6.0),
}
"""Figures in the text of sections V-C to V-F.

The corridor's percentages are the printed errors of 9.23 m, 9.2 m and 2.64 m divided by 63 m. The paper also has "a
location error in 1m" on average and "the initial location is determined after six steps" for one user."""


SHOE_SENSING_TITLE = "Li et al. 2016, tables 1 and 2, figs. 21 to 35"

_SHOE_SENSING: Table = {
    "plane, {} deg/m": Statistics(3.935, 6.435),
    "upstairs, {} deg/m": Statistics(107.904, 36.465),
    "downstairs, {} deg/m": Statistics(-89.464, 34.907),
    "walking, height before, {} m": Statistics(0.1186, 0.0582),
    "walking, height after, {} m": Statistics(0.02, 0.06),
    "jogging, height before, {} m": Statistics(0.17, 0.22),
    "jogging, height after, {} m": Statistics(0.01, 0.06),
    "walking, length, {} m": Statistics(0.11, 0.08),
    "jogging, length, {} m": Statistics(0.13, 0.11),
    "upstairs, length, {} m": Statistics(0.09, 0.06),
    "upstairs, height, {} m": Statistics(0.04, 0.03),
    "downstairs, length, {} m": Statistics(0.12, 0.08),
    "downstairs, height, {} m": Statistics(0.07, 0.06),
    "walking, table 2, {} %": Statistics(0.40),
    "jogging, table 2, {} %": Statistics(0.36),
    "upstairs, table 2, {} %": Statistics(0.56),
    "downstairs, table 2, {} %": Statistics(0.88),
    "walking, 19.2 m, {} m": Statistics(17.3),
    "walking, course, {} deg": Statistics(5.65, 3.88),
    "jogging, course, {} deg": Statistics(7.09, 6.94),
}
SHOE_SENSING: Table = {
    row.format(method): figures for row, figures in _SHOE_SENSING.items() for method in ("printed", "ours")
}
"""Tables 1 and 2; sections 3.4.2, 4.2.3 (figs. 13, 14, 23, 24), 4.2.4 (figs. 25 to 32) and 4.2.5 (figs. 33, 34).

They stand beside the printed method and beside ours. Errors are magnitudes for single strides, which the paper calls
steps. What the text calls variance or mean square error is taken for the standard deviation. Of 19.2 m the paper has a
single estimate."""

TABLE_2_DIVISOR = 22.5
"""Number by which table 2 divides the mean error of a stride relative to its length.

"The accuracy of the two sensors differ 22.5-fold": 9.17 % / 22.5 = 0.41 % for walking. The other errors before the
division are 8.13 % jogging, 20.0 % downstairs and, of the height instead of the length, 12.5 % upstairs."""

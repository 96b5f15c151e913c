"""Bebek et al. 2010: zero velocity while the contours of heel pressure stand still.

"Personal navigation via high-resolution gait-corrected inertial measurement units", IEEE Trans. Instrum. Meas. 59. The
paper's sections, in their order:

    II, III  zero-velocity updates with an IMU (fig. 2)       foot/navigate/dedrift.py
    IV       contours and their velocity (1) (2), figs. 3, 4  contour.py
             zero velocity (3)                                contour_stance.py
    V.A      acceleration and position (4) to (6), fig. 8     bias_zupt.py, foot/navigate/strapdown.py
             bias filter (7) to (10)                          acc_bias.py
    V.B      square laps (figs. 11, 12)                       square.py
    V.C, D   experiments                                      solepath_lab/reproduce/pressure_contour.py

recipe.py has the recipes as printed and with our additions; printed_checks.py keeps the printed recipe from blaming the
data. docs/papers/pressure-contour.md has every equation with its check."""

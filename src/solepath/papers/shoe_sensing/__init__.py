"""Li et al. 2016: stance by short-time energy, tilt feedback in stance, stairs by angle per metre.

"3D tracking via shoe sensing", Sensors 16, 1809. The paper's sections, in their order:

    3.1.1    gait information: place of sensor (figs. 1, 2)   solepath_lab/reproduce/shoe/variants.py: `TILTED`
    3.1.2    stationary by short-time energy (figs. 3, 4)     short_time_energy.py
    3.2      posture: C, gb, e, Runge and Kutta               posture.py
             first attitude, Q_n (figs. 6, 7)                 posture.py, printed.py
             feedback in stance, gyro' = gyro - Kp e          printed.py
    3.3      velocity and distance, v(T), S(T)                foot/navigate/strapdown.py: `integrate`
             their drift taken off, V(T)                      printed.py
    3.4.1    walking states by theta'                         steepness.py, walking_state.py
    3.4.2    height, S_z(T)                                   printed.py
    4.1      sensor node, MPU-6050 (fig. 18)                  emulate/sensors/parts.py
    4.2      experiments                                      solepath_lab/reproduce/shoe_sensing.py

additions.py has our additions, recipe.py both recipes; docs/papers/shoe-sensing.md has every equation with its check.
"""

"""Chen et al. 2019: velocity known while the shoe rolls over heel and forefoot, and strides of both feet fused.

"Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal 6.
The paper's sections, in their order:

    III.A    hardware (figs. 1, 2): 96 cells                  emulate/sensors/insole_device.py, insoles.py
             30 Hz                                            solepath_lab/reproduce/kupt/walks.py
    III.B    pressure noise (1)                               noise.py
             taken off each cell                              foot/pressure/insole.py
    III.C.1  stationary epoch, two areas (fig. 3)             known_velocity.py
             the areas' edge                                  recipe.py: `BOARD_SHARE`
             their loads                                      foot/pressure/insole.py
    III.C.2  centre of pressure (2) (3)                       foot/pressure/insole.py
             heel-strike and toe-off (fig. 4)                 cop_cues.py
    III.C.3  rolling shoe (4) to (7), figs. 5 to 7            kinematics.py; its five postures: shoe/
             L_r = 12.5 cm, H_imu = 2.9 cm, curves            calibration/records.py: `ShoeGeometry`
             drift in swing (8), fig. 8                       swing_drift.py; ours: soft_swing.py
    III.C.4  error index (10)                                 swing_drift.py; ours: soft_swing.py
             similarity (9), fusion (11) to (13), fig. 9      fusion.py
    IV, V    experiments, figs. 10 to 14, table I             solepath_lab/reproduce/kupt_dfpc.py, kupt/

recipe.py has the recipes as printed and with our additions; docs/papers/kupt-dfpc.md has every equation with its
check."""

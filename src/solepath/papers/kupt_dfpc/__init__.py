"""Chen et al. 2019: velocity known while the shoe rolls over heel and forefoot, and strides of both feet fused.

"Smart insole-based indoor localization system for Internet of Things applications", IEEE Internet of Things Journal 6.
The paper's sections, in their order:

    III.A    hardware: 96 cells, 30 Hz (figs. 1, 2)           emulate/sensors/insole_device.py
    III.B    pressure noise (1)                               noise.py
    III.C.1  stationary epoch, two areas (fig. 3)             known_velocity.py
    III.C.2  centre of pressure (2) (3)                       foot/pressure/insole.py
             heel-strike and toe-off (fig. 4)                 cop_cues.py
    III.C.3  rolling shoe (4) to (7), figs. 5 to 7            kinematics.py; its five postures: shoe/
             drift in swing (8), error index (10)             swing_drift.py; ours: soft_swing.py
    III.C.4  similarity (9), fusion (11) to (13), fig. 9      fusion.py
    IV       experiments                                      solepath_lab/reproduce/kupt_dfpc.py

recipe.py has the recipes as printed and with our additions; docs/papers/kupt-dfpc.md has every equation with its
check."""

"""Gong et al. 2023: walks by touchdowns, each foot measured from the other over the legs, compensated by walking mode.

"Improving accuracy of real-time positioning and path tracking by using an error compensation algorithm against walking
modes", Sensors 23, 5417. Where the paper's sections are:

- 2, (1) to (6), touchdown methods I to III: touchdown.py; where a sign fails: signs.py
- 3.1, figs. 3 to 5, seven sensors and two insoles: emulate/sensors/suit.py; fig. 6, counts to newtons: newton.py
- 3.2.1, fig. 7, error in P_change: emulate/routes/footfalls.py
- 3.2.2, (7), fig. 8, chain of the legs: limbs/limbs.py; a sensor on its segment: limbs/segment.py; N-pose: standing.py
- 3.2.2, fig. 9, the foot moves in the shoe: emulate/wearers/limbs.py
- 3.3, fig. 10, pressure over the gait cycle: emulate/wearers/load.py
- 3.3, (8), fig. 12, the flow of method IV: modes.py (the track); places of both feet: places.py
- 3.3, fig. 11, table 1, compensation and how it is measured: compensation.py, calibrate.py
- 3.3, fig. 13, table 2, walking modes: mode.py (one contact); when they are known, and ours by turning: recognition.py
- 3.4, 4, experiments: solepath_lab/reproduce/walking_modes.py

recipe.py has what is printed and what is ours; docs/papers/walking-modes.md has checks, verdicts and claims."""

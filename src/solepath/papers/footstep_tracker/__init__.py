"""Liu et al. 2015: strides of a 20 Hz SensorTag (the paper's steps), turns, activities, a Snake game on the plan.

"Track your foot step: anchor-free indoor localization based on sensing users' foot steps", IEEE MASS 2015. Where the
paper's sections are:

- III, IV, figs. 1 to 3, framework and sensor: recipe.py, link/devices/cc2541.py
- IV.A, fig. 5, table I, activity classifier: activity/two_second_windows.py (tree, elevator), hmm.py, window_model.py
- IV.B, fig. 7, step segmentation: static_zones.py, segment.py
- IV.C, fig. 8, algorithm 1, critical times: critical_times.py; as gait events: critical_cues.py
- IV.C, (1) to (6), fig. 10, step length: stride_length.py; ours: closed_stride.py; on the ground: projection.py
- IV.C, double feet, one metre: footsteps.py
- IV.D, theorem 1, (7), moving direction: stride_length.py (`swing_turn`); turning strides: body/gait/turns.py
- IV.E, fig. 14, Snake game: snake.py
- V, experiments: solepath_lab/reproduce/footstep_tracker.py

recipe.py has what is printed and what is ours; docs/papers/footstep-tracker.md has checks, verdicts and claims."""

"""Scores recipes on recorded data with a truth, by the same rules for all recipes.

`jobs.evaluate` runs the whole evaluation; alignment, matching, strides and contacts are the rules, on plain arrays."""

"""Scores recipes on recorded data with a reference ("truth"), by the same rules for all recipes.

`jobs.evaluate` runs the whole evaluation. The rules are in lab/measures."""

"""How accurate a recipe is on recorded data with a truth, by the same rules for all of them.

`jobs.evaluate` does it all; alignment, matching, strides and contacts are the rules, on plain arrays.
"""

"""One track from two feet.

Read in this order: position.py (the mean of both feet), both_feet.py (the part), error_filter.py (in what their tracks
differ), common_error.py (the errors that both share), straight_ways.py, moving_ground.py, compass.py, walked_path.py
and reported_position.py (what shows these)."""

"""Liu et al. 2015: strides of a 20 Hz SensorTag (the paper's steps), turns, activities, a Snake game on the plan."""

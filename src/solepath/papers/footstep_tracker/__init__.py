"""Liu et al. 2015: steps between static zones on a 20 Hz SensorTag, turns, activities, a Snake game on the plan."""

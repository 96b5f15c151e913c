"""Bebek et al. 2010: zero velocity by the contours of heel pressure, accelerometer bias, laps around a square."""

"""Li et al. 2016: stance by short-time energy, tilt feedback in stance, stairs by angle per metre."""

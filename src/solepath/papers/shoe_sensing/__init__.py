"""Li et al. 2016: stance by short-time energy, tilt fed back in stance, stairs by angle per metre."""

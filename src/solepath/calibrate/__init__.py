"""From a recording, or a table that somebody measured, to a Calibration with just the part that it tells of."""

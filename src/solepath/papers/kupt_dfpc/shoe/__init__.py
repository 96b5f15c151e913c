"""The wearer's own shoe: its pitch in static postures, and the geometry that is fitted to these."""

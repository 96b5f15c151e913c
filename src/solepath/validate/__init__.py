"""What a session found against the truth: events matched one to one, tracks aligned, strides and places compared."""

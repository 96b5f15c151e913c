"""Adds the parts of a report to its page, in the order in which they are read."""

"""Marks of fields that schema.py reads; they load nothing else."""

NOT_SAVED = {"saving": "not saved"}
"""Mark of a field that is in no snapshot and in no packed state: it has its default after loading."""
MADE_AGAIN = {"saving": "made again"}
"""Mark of a field of state whose parts are made again by their holder."""

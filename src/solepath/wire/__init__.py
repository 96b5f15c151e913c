"""Bytes to records and back: one construct definition of each format does both (protocol/ is the norm)."""

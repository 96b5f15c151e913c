"""Conversion of bytes to records and back: one construct of each format does both (protocol/ defines the formats)."""

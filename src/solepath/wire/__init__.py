"""Conversion of bytes to records and back: one definition of each format does both (protocol/ defines the formats)."""

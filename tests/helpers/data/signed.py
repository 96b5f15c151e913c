"""Damaged packed sessions with a valid checksum."""

from __future__ import annotations

from binascii import crc32

from solepath.session.packed import HEADER


def signed(data: bytes) -> bytes:
    """Return the data with a valid checksum, so that the damage behind it is reached."""
    magic, form, version, made_with, _ = HEADER.unpack_from(data)
    start = HEADER.pack(magic, form, version, made_with, 0)
    return HEADER.pack(magic, form, version, made_with, crc32(data[HEADER.size :], crc32(start))) + data[HEADER.size :]

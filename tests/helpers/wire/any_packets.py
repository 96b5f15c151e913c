"""Hypothesis strategies: any frame of an insole, and any damage to a packet."""

from __future__ import annotations

import json
from binascii import crc_hqx

from formats import VECTORS
from hypothesis import strategies as st

U8, U16, U32 = st.integers(0, 255), st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1)


def packets_of(name: str) -> list[bytes]:
    """Return the packets of the vectors of a format."""
    file = json.loads((VECTORS / f"{name}.json").read_text("utf-8"))
    return [bytes.fromhex(vector["hex"]) for vector in file["vectors"]]


@st.composite
def damaged(draw: st.DrawFn, seeds: list[bytes], resealed: bool) -> bytes:
    """Draw a packet with some bytes changed, cut or appended; with `resealed` its CRC fits the damaged bytes."""
    data = bytearray(draw(st.sampled_from(seeds)))
    for position, value in draw(st.lists(st.tuples(st.integers(0, 599), st.integers(0, 255)), max_size=4)):
        if position < len(data):
            data[position] = value
    ending = draw(st.sampled_from(["as it is", "cut", "lengthened"]))
    if ending == "cut":
        del data[draw(st.integers(0, len(data))) :]
    elif ending == "lengthened":
        data += draw(st.binary(max_size=20))
    if resealed and len(data) >= 2:
        data[-2:] = crc_hqx(bytes(data[:-2]), 0xFFFF).to_bytes(2, "little")
    return bytes(data)

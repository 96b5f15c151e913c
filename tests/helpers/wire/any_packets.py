"""Hypothesis strategies: any frame of an insole, and any damage to a packet."""

from __future__ import annotations

import json
from binascii import crc_hqx

from formats import VECTORS
from hypothesis import assume
from hypothesis import strategies as st

from solepath.types import Foot
from solepath.wire import cells, insole

I16 = st.integers(-32768, 32767)
U8, U16, U32 = st.integers(0, 255), st.integers(0, 2**16 - 1), st.integers(0, 2**32 - 1)
FOOT = st.sampled_from(Foot)


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


@st.composite
def frames(draw: st.DrawFn) -> insole.InsoleFrame:
    """Draw a frame of up to 128 cells that fits an attribute value."""
    count, imu, quat = draw(st.integers(0, 128)), draw(st.booleans()), draw(st.booleans())
    size = cells.packed_size(count) + 12 * imu + 8 * quat
    assume(size > 0)
    sample = st.builds(
        insole.InsoleSample,
        cells=st.lists(st.integers(0, 4095), min_size=count, max_size=count).map(tuple),
        imu=st.tuples(*[I16] * 6) if imu else st.none(),
        quat=st.tuples(*[I16] * 4) if quat else st.none(),
    )
    max_samples = min(255, (512 - 16) // size)
    samples = draw(st.lists(sample, min_size=1, max_size=min(max_samples, 4)))
    if draw(st.booleans()):
        samples = (samples * max_samples)[:max_samples]
    return insole.InsoleFrame(
        draw(FOOT),
        draw(U8),
        draw(U16),
        draw(U32),
        draw(st.integers(1, 65535)),
        tuple(samples),
        draw(st.booleans()),
        draw(st.booleans()),
    )

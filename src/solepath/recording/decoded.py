"""The samples of a recording of either kind."""

from __future__ import annotations

from collections.abc import Iterable

from attrs import frozen

from ..events import LayoutKnown
from ..link.decoder import Decoder
from ..types import Foot, Layout, Packet, Sample, Site


@frozen
class DecodedRecording:
    """Samples in the order in which they became known, and the layouts that the insoles reported."""

    samples: tuple[Sample, ...]
    layouts: dict[Foot, Layout]


def decode_recording(items: Iterable[Packet | Sample]) -> DecodedRecording:
    """Return the samples of packets, decoded, and samples as they are. Packets that cannot be used are skipped."""
    samples: list[Sample] = []
    layouts: dict[Foot, Layout] = {}
    decoders: dict[Site, Decoder] = {}

    def add_all(found: Iterable[object]) -> None:
        for one in found:
            if isinstance(one, Sample):
                samples.append(one)
            elif isinstance(one, LayoutKnown):
                layouts[one.layout.foot] = one.layout

    for item in items:
        if isinstance(item, Sample):
            samples.append(item)
        else:
            add_all(decoders.setdefault(item.site, Decoder(item.site)).feed(item))
    for decoder in decoders.values():
        add_all(decoder.finish())
    return DecodedRecording(tuple(samples), layouts)

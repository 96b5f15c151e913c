"""The samples of a recording of packets or of samples."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from attrs import frozen

from ..events import Event, LayoutKnown
from ..link.decoder import Decoder
from ..link.kinds import BUILT_IN_KINDS, DeviceKinds
from ..types import Foot, Layout, Packet, Sample, Site


@frozen
class DecodedRecording:
    """Samples in the order in which they became known, and the newest layout that each foot's insole reported."""

    samples: tuple[Sample, ...]
    layouts: dict[Foot, Layout]


def decode_recording(items: Iterable[Packet | Sample]) -> DecodedRecording:
    """Return the samples decoded from packets, or given as samples; packets that cannot be used are skipped."""
    samples: list[Sample] = []
    layouts: dict[Foot, Layout] = {}
    for item in decode(items):
        if isinstance(item, Sample):
            samples.append(item)
        elif isinstance(item, LayoutKnown):
            layouts[item.layout.foot] = item.layout
    return DecodedRecording(tuple(samples), layouts)


def decode_own(items: Iterable[Packet | Sample], kinds: DeviceKinds) -> Iterator[Packet | Sample]:
    """Yield the samples of the devices that an app added to `kinds` in place of their packets, and other items as is.

    Packets that cannot be used are skipped."""
    own = {driver.name for driver in kinds.drivers}
    for item in decode(items, kinds, lambda packet: packet.channel.partition("/")[0] in own):
        if isinstance(item, Packet | Sample):
            yield item


def decode(
    items: Iterable[Packet | Sample],
    kinds: DeviceKinds = BUILT_IN_KINDS,
    is_decoded: Callable[[Packet], bool] = lambda packet: True,
) -> Iterator[Packet | Sample | Event]:
    """Yield what the packets say for which `is_decoded` is true, in their place, and all other items."""
    decoders: dict[Site, Decoder] = {}
    for item in items:
        if isinstance(item, Sample) or not is_decoded(item):
            yield item
        else:
            decoder = decoders.setdefault(item.site, Decoder(item.site))
            yield from decoder.feed(item, kinds)
    for decoder in decoders.values():
        yield from decoder.finish()

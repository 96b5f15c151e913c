"""The samples of a recording of packets or of samples."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from attrs import frozen

from ..events import LayoutKnown
from ..link.decoder import Decoder
from ..link.kinds import DeviceKinds
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
    decoders: dict[Site, Decoder] = {}

    def add_all(outputs: Iterable[object]) -> None:
        for output in outputs:
            if isinstance(output, Sample):
                samples.append(output)
            elif isinstance(output, LayoutKnown):
                layouts[output.layout.foot] = output.layout

    for item in items:
        if isinstance(item, Sample):
            samples.append(item)
        else:
            add_all(decoders.setdefault(item.site, Decoder(item.site)).feed(item))
    for decoder in decoders.values():
        add_all(decoder.finish())
    return DecodedRecording(tuple(samples), layouts)


def decode_own(items: Iterable[Packet | Sample], kinds: DeviceKinds) -> Iterator[Packet | Sample]:
    """Yield the samples of the devices that an app added to `kinds` in place of their packets, and other items as is.

    Packets that cannot be used are skipped."""
    own = {driver.name for driver in kinds.drivers}
    decoders: dict[Site, Decoder] = {}
    for item in items:
        if isinstance(item, Sample) or item.channel.partition("/")[0] not in own:
            yield item
            continue
        for output in decoders.setdefault(item.site, Decoder(item.site)).feed(item, kinds):
            if isinstance(output, Sample):
                yield output
    for decoder in decoders.values():
        for output in decoder.finish():
            if isinstance(output, Sample):
                yield output

"""A recording of packets or of samples as one stream for a session."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from itertools import chain, islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from attrs import define, field

from ..types import Foot, Packet, Sample
from .bad_rows import BadRows
from .bids.names import MOTION_END, recording_of
from .clock_offset import shift_clock
from .decoded import decode_own
from .errors import SAMPLE_SUFFIXES, RecordingError, Report, printable, warn
from .packets import OpenRecording, open_packets, read_header
from .unpacking import content_name, size_of

if TYPE_CHECKING:
    from ..link.kinds import DeviceKinds
    from .mapping import TableMapping
    from .samples import SampleRecording

LONGEST_LABEL = 80
"""Largest number of characters of the names of several files in a title; chosen by hand."""
MAX_AHEAD = 20_000
"""Largest number of packets of a pipe that `look_ahead` reads and keeps: some 100 s of two insoles."""


@define
class Source:
    """The packets or samples of a recording, in the order in which a session needs them.

    A file may be iterated again, a pipe once. Iterating raises RecordingError at data that cannot be used, after all
    packets or samples before them. A recording of packets that has only a header is no error, but is reported. `foot`,
    `report`: as in `open_source`."""

    path: Path
    foot: Foot | None
    report: Report
    total: int = 0
    """Size of a recording of packets, bytes, or number of samples; 0 for a pipe of packets."""
    done: int = 0
    """Part of `total` that was iterated, in the same unit."""
    samples: SampleRecording | None = None
    """Samples of the recording; None for a recording of packets."""
    header: dict[str, Any] = field(factory=dict)
    """Header of a recording of packets."""
    bad_rows: BadRows | None = None
    """Rows or lines that were left out so far, because they are damaged."""
    clock_offset: float = 0.0
    """Time to add to the times of the right foot, s, when the feet were recorded with separate clocks."""
    own_kinds: DeviceKinds | None = None
    """Devices of one's own whose packets are iterated as samples; None to iterate them as packets."""
    _pipe: OpenRecording | None = None
    """The pipe, which can be opened once; None for a file."""
    _packets_ahead: list[Packet] = field(factory=list)
    _failure: RecordingError | None = None
    """Error at which `look_ahead` ended."""
    name: str = ""
    """Name of the file, or names of the files."""

    def __iter__(self) -> Iterator[Packet | Sample]:
        items = self._iterate_packets() if self.samples is None else self._iterate_samples(self.samples)
        if self.own_kinds is not None and self.own_kinds.drivers:
            items = decode_own(items, self.own_kinds)
        return shift_clock(items, self.clock_offset) if self.clock_offset else items

    def look_ahead(self) -> Iterator[Packet]:
        """Yield the packets without reports, of a pipe only the first MAX_AHEAD; iterating yields them again."""
        if self._pipe is None:
            yield from open_packets(self.path, report=lambda _: None).packets
            return
        try:
            for packet in islice(self._pipe.packets, MAX_AHEAD):
                self._packets_ahead.append(packet)
                yield packet
        except RecordingError as error:
            self._failure = error
            raise

    def _iterate_samples(self, samples: SampleRecording) -> Iterator[Packet | Sample]:
        for sample in samples:
            self.done += 1
            yield sample

    def _iterate_packets(self) -> Iterator[Packet | Sample]:
        opened = self._pipe or open_packets(self.path, report=self.report, progress=partial(setattr, self, "done"))
        self.bad_rows, ahead, self._packets_ahead = opened.bad_lines, self._packets_ahead, []
        has_packets = has_used_packets = False
        for packet in chain(ahead, opened.packets):
            has_packets = True
            if self.foot is None or packet.site.foot in (None, self.foot):
                has_used_packets = True
                yield packet
        if self._failure is not None:
            raise self._failure
        if not has_packets:
            self.report(f"{printable(str(self.path))}: holds no packets")
        elif self.foot is not None and not has_used_packets:
            raise RecordingError(self.path, f"holds no packets of the {self.foot.value} foot")


def label_files(paths: Sequence[Path]) -> str:
    """Return a title for one or more files: their names, with those of their folders if the names are the same."""
    from ..saving.provenance import names_of

    names = names_of(paths)
    joined = ", ".join(names)
    return joined if len(names) == 1 or len(joined) <= LONGEST_LABEL else f"{names[0]} and {len(names) - 1} more"


def open_source(
    files: Path | str | Sequence[Path | str],
    foot: Foot | Sequence[Foot] | None = None,
    *,
    mapping: TableMapping | None = None,
    report: Report = warn,
) -> Source:
    """Return a recording: samples if a name ends as those of tables or BIDS do or there is a mapping, else packets.

    `files`: a file of packets; or one or more files of samples, of both feet or of several sensors. `foot`: for samples
    that name no foot, the foot that wore the sensor (None: what the name of the file says; else the right foot for one
    file, and an error for the files of both feet); for any other recording, the only foot to read (None: all); a
    sequence has the foot of each file, as in `open_source([left, right], [Foot.LEFT, Foot.RIGHT])`. `mapping`: what the
    columns of tables mean, as far as they do not say it themselves. RecordingError, with all problems, when something
    cannot be used."""
    paths = [Path(file) for file in ([files] if isinstance(files, str | Path) else files)]
    path, only = paths[0], foot if isinstance(foot, Foot) else None
    source = Source(path, only, report, name=label_files(paths))
    samples: SampleRecording | None = None
    if path.name.endswith(MOTION_END) and mapping is None:
        other = next((one for one in paths if recording_of(one) != recording_of(path)), None)
        if other is not None:
            what = f"is no tracking system of the recording {printable(path.name)}, whose files are read together"
            raise RecordingError(other, what)
        from .bids.reader import load_motion

        samples = load_motion(path, only, report=report)
    elif mapping is not None or len(paths) > 1 or Path(content_name(path)).suffix.lower() in SAMPLE_SUFFIXES:
        from .samples import load_samples  # packets do not need it

        samples = load_samples(paths, foot, mapping=mapping, report=report)
    if samples is not None:
        source.samples, source.total, source.bad_rows = samples, len(samples), samples.bad_rows
        if samples.start_time is not None:
            source.header = {"began": samples.start_time.isoformat(), "began_t": 0.0}
        return source
    if path.is_file():
        source.header, source.total = read_header(path), size_of(path)
    else:
        source._pipe = open_packets(path, report=report)
        source.header, source.bad_rows = source._pipe.header, source._pipe.bad_lines
    return source


def read_samples(
    files: Path | str | Sequence[Path | str],
    foot: Foot | Sequence[Foot] | None = None,
    *,
    mapping: TableMapping | None = None,
    report: Report = warn,
) -> Iterator[Sample]:
    """Return an iterator over the samples of one or more files, with both feet in order of time.

    Files are tables (text, Excel, Parquet) or NumPy archives: of both feet, or one for each foot or sensor. The
    arguments are those of `open_source`; `report` receives a sentence about each of the first rows that are left
    out."""
    from .samples import load_samples

    return iter(load_samples(files, foot, mapping=mapping, report=report))

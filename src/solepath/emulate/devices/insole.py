"""The emulated insole as a GATT server: protocol/insole.md from the device's side."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import ceil

from attrs import Factory, define, evolve

from ...link.devices.insole import PROFILE as INSOLE
from ...types import Foot
from ...wire.error import WireError
from ...wire.fragment import FRAME_ID_COUNT, MAX_FRAGMENTS, split
from ...wire.insole import InsoleFrame, build_frame
from ...wire.insole_control import Resend, SetInterval, StartSampling, StopSampling, parse_control
from ...wire.insole_info import build_info
from ..sensors.device import device_numbers, foot_of
from ..sensors.insole_device import BATTERY, TICK_RATE, Insole, InsoleSignal
from ..wearers.walker import Walker
from .attributes import NOTIFY, READ, WRITE, AttError, Battery, information, services
from .peripheral import Peripheral, Placement

UNKNOWN_OPCODE = 0x80
WRONG_VALUE = 0x81
NOT_NOW = 0x82

SHORTEST_INTERVAL = 82
"""Shortest sampling interval of the emulated insole, ticks: 400 Hz."""
KEEPING_TIME = 20.0
"""Time for which sent frames are stored for retransmission, s."""
_MAX_RESENT_FRAMES = 4
"""Largest number of frames that are retransmitted with each new frame."""
_MAX_CACHED_SIGNALS = 3
"""Number of sampling intervals for which the measured walk is cached."""
_OPCODES = range(1, 5)
_MAX_FRAME_SIZE = 512
_HEADER_AND_CRC = 16

_SERVICES = services(
    INSOLE,
    {
        "insole/frame": NOTIFY,
        "insole/info": READ,
        "insole/control": WRITE,
        "device/battery": READ | NOTIFY,
        "device/firmware": READ,
    },
    information=("manufacturer", "model"),
)


@define(eq=False)
class _Frames:
    """A ValueSource of the frames of a signal.

    `sequence` and `ticks` are added to those of the signal. `sent_numbers` are the numbers of recently sent frames,
    `to_resend` those of frames that must be sent again."""

    signal: InsoleSignal
    batch: int
    sequence: int = 0
    ticks: int = 0
    sent_numbers: deque[int] = Factory(deque)
    to_resend: deque[int] = Factory(deque)

    def after(self, t: float) -> int:
        return ceil((t - self.signal.first) / (self.signal.step * self.batch))

    def due(self, number: int) -> float:
        return self.signal.ready(number, self.batch)

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        found = self._pieces(number, False, mtu)
        for _ in range(min(_MAX_RESENT_FRAMES, len(self.to_resend))):
            found += self._pieces(self.to_resend.popleft(), True, mtu)
        self.sent_numbers.append(number)
        while len(self.sent_numbers) * self.signal.step * self.batch > KEEPING_TIME:
            self.sent_numbers.popleft()
        return found

    def frame(self, number: int) -> InsoleFrame:
        frame = self.signal.frame(number, self.batch)
        sequence, ticks = (frame.sequence + self.sequence) % 2**16, (frame.ticks + self.ticks) % 2**32
        return evolve(frame, sequence=sequence, ticks=ticks)

    def signal_ticks(self, number: int) -> int:
        """Return the ticks of a frame without the offset `ticks`."""
        return self.signal.ticks + number * self.batch * self.signal.interval

    def elapsed(self, number: int, since: float) -> int:
        """Return the ticks of the device's clock from `since`, s, to the frame's first sample."""
        return round((self.signal.sample_time(number, self.batch) - since) / self.signal.step * self.signal.interval)

    def resend(self, command: Resend) -> None:
        """Queue the requested frames, if they are still stored; they are sent with the next frames."""
        requested = {(command.first + i) % 2**16 for i in range(command.count)}
        offset = self.signal.sequence + self.sequence
        self.to_resend += [
            n for n in self.sent_numbers if (offset + n) % 2**16 in requested and n not in self.to_resend
        ]

    def _pieces(self, number: int, retransmitted: bool, mtu: int) -> list[bytes]:
        frame = self.frame(number)
        return split(build_frame(evolve(frame, retransmitted=retransmitted)), mtu - 3, number % FRAME_ID_COUNT)


class InsolePeripheral(Peripheral):
    """A worn insole, "solepath L" or "solepath R", as a GATT server.

    The frames are byte for byte those of `device.emit` for the same walker, site, seed and interval, unless SET
    INTERVAL comes while the insole is sampling; sequence and ticks then continue. The signal of the whole walk is
    computed once for each interval, when it is first needed or by `prepare`."""

    def __init__(self, device: Insole, walker: Walker, seed: int, placement: Placement) -> None:
        name = f"solepath {'L' if foot_of(placement.site) is Foot.LEFT else 'R'}"
        super().__init__(placement, name, _SERVICES, INSOLE.services)
        self.device, self._walker, self._seed = device, walker, seed
        self._interval = device.interval
        self._signals: dict[int, InsoleSignal] = {}
        self._frames: _Frames | None = None
        self._battery = Battery(BATTERY)
        self._device_information = information(device.firmware, manufacturer="solepath", model="emulated insole")

    def prepare(self) -> None:
        self.signal()

    def signal(self) -> InsoleSignal:
        """Return the signal that the insole measures at the current interval."""
        found = self._signals.get(self._interval)
        if found is None:
            device = self.device
            if device.interval != self._interval:
                device = evolve(device, rate=TICK_RATE / self._interval)
            found = device.measure(self._walker, self.site, device_numbers(self._seed, self.site))
            while len(self._signals) >= _MAX_CACHED_SIGNALS:
                self._signals.pop(next(iter(self._signals)))
            self._signals[self._interval] = found
        return found

    def start(self, t: float) -> None:
        self.flow("device/battery", self._battery, t)

    def stop(self) -> None:
        self._frames = None

    def value(self, channel: str, t: float) -> bytes:
        match channel:
            case "insole/info":
                return build_info(self.device.info(self.signal()))
            case "device/battery":
                return self._battery.level(t)
        return self._device_information[channel]

    def take(self, channel: str, value: bytes, t: float) -> None:
        try:
            command = parse_control(value)
        except WireError:
            raise AttError(WRONG_VALUE if not value or value[0] in _OPCODES else UNKNOWN_OPCODE) from None
        match command:
            case StartSampling():
                if self._frames is None:
                    self._measure(self._frames_from(t), t)
            case StopSampling():
                self._frames = None
                self.flow("insole/frame", None, t)
            case SetInterval(interval=interval):
                self._interval = max(SHORTEST_INTERVAL, interval)
                if self._frames is not None:
                    self._measure(self._continued_frames(self._frames, t), t)
            case Resend():
                if self._frames is None:
                    raise AttError(NOT_NOW)
                self._frames.resend(command)

    def _measure(self, frames: _Frames, t: float) -> None:
        self._frames = frames
        self.flow("insole/frame", frames, t)

    def _frames_from(self, t: float) -> _Frames:
        """Return the frames from `t` on; after a restart the sequence starts at 0 and the ticks at the restart."""
        frames = _Frames(self.signal(), self._batch())
        if self.restarted_at is not None:
            number = frames.after(t)
            frames.sequence = -(frames.signal.sequence + number) % 2**16
            frames.ticks = (frames.elapsed(number, self.restarted_at) - frames.signal_ticks(number)) % 2**32
        return frames

    def _batch(self) -> int:
        """Return how many samples a frame has: `device.batch`, or fewer when there would be too many fragments."""
        sample_size = len(build_frame(self.signal().frame(0))) - _HEADER_AND_CRC
        max_size = min(_MAX_FRAME_SIZE, max(self.agreed_mtu - 3, MAX_FRAGMENTS * (self.agreed_mtu - 4)))
        return max(1, min(self.device.batch, (max_size - _HEADER_AND_CRC) // sample_size))

    def _continued_frames(self, old: _Frames, t: float) -> _Frames:
        """Return the frames at the current interval that continue the sequence and the clock of the old ones at `t`."""
        new = _Frames(self.signal(), old.batch)
        number = new.after(t)
        last = old.sent_numbers[-1] if old.sent_numbers else old.after(t) - 1
        new.sequence = (old.signal.sequence + old.sequence + last + 1 - new.signal.sequence - number) % 2**16
        ticks = old.signal.ticks + old.ticks + new.elapsed(number, old.signal.first)
        new.ticks = (ticks - new.signal_ticks(number)) % 2**32
        return new

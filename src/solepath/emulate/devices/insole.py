"""The emulated insole as a GATT server: protocol/insole.md from the device's side."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from math import ceil

from attrs import Factory, define, evolve

from ...link.devices.insole import PROFILE as INSOLE
from ...types import Foot
from ...wire.device import build_battery
from ...wire.error import WireError
from ...wire.fields import build_text
from ...wire.fragment import FRAME_ID_COUNT, MAX_FRAGMENTS, split
from ...wire.insole import build_frame
from ...wire.insole_control import Resend, SetInterval, StartSampling, StopSampling, parse_control
from ...wire.insole_info import build_info
from ..sensors.device import device_rng, foot_of
from ..sensors.insole_device import BATTERY, TICK_RATE, Insole, InsoleSignal
from ..wearers.walker import Walker
from .attributes import ATT_HEADER_SIZE, AttError, services
from .peripheral import Peripheral, Placement

UNKNOWN_OPCODE, WRONG_VALUE, NOT_NOW = 0x80, 0x81, 0x82
"""ATT error codes with which the insole rejects commands (protocol/insole.md)."""

SHORTEST_INTERVAL = 82
"""Shortest sampling interval of the emulated insole, ticks: 400 Hz."""
KEEPING_TIME = 20.0
"""Time for which sent frames are stored for retransmission, s."""
_MAX_RESENT_FRAMES = 4
"""Largest number of frames that are retransmitted with each new frame."""
_MAX_CACHED_SIGNALS = 3
"""Number of sampling intervals for which the measured walk is cached."""
_OPCODES = range(1, 5)
_MAX_FRAME_SIZE, _HEADER_AND_CRC_SIZE, _FRAGMENT_HEADER_SIZE = 512, 16, 1
"""Sizes in bytes: of a whole frame at most, of its part that is not samples, and of what a fragment adds."""


@define(eq=False)
class _Frames:
    """A ValueSource of the frames of a signal.

    `sent_numbers` are the numbers of the stored frames, `to_resend` those of the frames that must be sent again."""

    signal: InsoleSignal
    batch: int
    sent_numbers: deque[int] = Factory(deque)
    to_resend: deque[int] = Factory(deque)

    def first_number_from(self, t: float) -> int:
        return ceil((t - self.signal.first) / (self.signal.step * self.batch))

    def due(self, number: int) -> float:
        return self.signal.ready(number, self.batch)

    def values(self, number: int, mtu: int) -> Sequence[bytes]:
        found = self._fragments(number, False, mtu)
        for _ in range(min(_MAX_RESENT_FRAMES, len(self.to_resend))):
            found += self._fragments(self.to_resend.popleft(), True, mtu)
        self.sent_numbers.append(number)
        while len(self.sent_numbers) * self.signal.step * self.batch > KEEPING_TIME:
            self.sent_numbers.popleft()
        return found

    def start_at(self, number: int, sequence: int, since: float, ticks: int) -> None:
        """Set the sequence number of a frame, and the ticks that the device's clock shows at the time `since`, s."""
        signal, first = self.signal, number * self.batch
        elapsed = round((signal.first + signal.step * first - since) / signal.step * signal.interval)
        self.signal = evolve(signal, sequence=sequence - number, ticks=ticks + elapsed - first * signal.interval)

    def resend(self, command: Resend) -> None:
        """Queue those of the requested frames that are still stored; they are sent with the next frames."""
        requested = {(command.first + i) % 2**16 for i in range(command.count)}
        self.to_resend += [
            number
            for number in self.sent_numbers
            if (self.signal.sequence + number) % 2**16 in requested and number not in self.to_resend
        ]

    def _fragments(self, number: int, retransmitted: bool, mtu: int) -> list[bytes]:
        frame = build_frame(evolve(self.signal.frame(number, self.batch), retransmitted=retransmitted))
        return split(frame, mtu - ATT_HEADER_SIZE, number % FRAME_ID_COUNT)


class InsolePeripheral(Peripheral):
    """A worn insole, "solepath L" or "solepath R", as a GATT server.

    The frames are byte for byte those of `device.emit` for the same walker, site, seed, interval and MTU, until the
    device restarts, or until SET INTERVAL comes while it samples (sequence and ticks then continue). The signal of the
    whole walk is computed by `prepare` or when it is first needed."""

    def __init__(self, device: Insole, walker: Walker, seed: int, placement: Placement) -> None:
        name = f"solepath {'L' if foot_of(placement.site) is Foot.LEFT else 'R'}"
        table = services(INSOLE, ("insole/info", "device/battery", "device/firmware"))
        super().__init__(placement, name, table, INSOLE.services)
        self.device, self._walker, self._seed = device, walker, seed
        self._interval = device.interval
        self._signals: dict[int, InsoleSignal] = {}
        self._frames: _Frames | None = None
        self._constants = {"device/firmware": build_text(device.firmware), "device/battery": build_battery(BATTERY)}

    def prepare(self) -> None:
        self.signal()

    def signal(self) -> InsoleSignal:
        """Return the signal that the insole measures at the current interval."""
        found = self._signals.get(self._interval)
        if found is None:
            device = self.device
            if device.interval != self._interval:
                device = evolve(device, rate=TICK_RATE / self._interval)
            found = device.measure(self._walker, self.site, device_rng(self._seed, self.site))
            while len(self._signals) >= _MAX_CACHED_SIGNALS:
                self._signals.pop(next(iter(self._signals)))
            self._signals[self._interval] = found
        return found

    def stop(self) -> None:
        self._frames = None

    def value(self, channel: str, t: float) -> bytes:
        return self._constants.get(channel) or build_info(self.device.info(self.signal()))

    def accept_write(self, channel: str, value: bytes, t: float) -> None:
        try:
            command = parse_control(value)
        except WireError:
            raise AttError(WRONG_VALUE if not value or value[0] in _OPCODES else UNKNOWN_OPCODE) from None
        match command:
            case StartSampling():
                if self._frames is None:
                    self._send(self._frames_from(t), t)
            case StopSampling():
                self._frames = None
                self.flow("insole/frame", None, t)
            case SetInterval(interval=interval):
                self._interval = max(SHORTEST_INTERVAL, interval)
                if self._frames is not None:
                    self._send(self._continued_frames(self._frames, t), t)
            case Resend():
                if self._frames is None:
                    raise AttError(NOT_NOW)
                self._frames.resend(command)

    def _send(self, frames: _Frames, t: float) -> None:
        self._frames = frames
        self.flow("insole/frame", frames, t)

    def _frames_from(self, t: float) -> _Frames:
        """Return the frames from `t` on; after a restart the sequence starts at 0 and the ticks at the restart."""
        frames, restarted_at = _Frames(self.signal(), self._batch()), self.faults.restarted_at
        if restarted_at is not None:
            frames.start_at(frames.first_number_from(t), 0, restarted_at, 0)
        return frames

    def _batch(self) -> int:
        """Return the number of samples in a frame: `device.batch`, or fewer when they would need too many fragments."""
        sample_size = len(build_frame(self.signal().frame(0))) - _HEADER_AND_CRC_SIZE
        value_size = self.agreed_mtu - ATT_HEADER_SIZE
        max_size = min(_MAX_FRAME_SIZE, max(value_size, MAX_FRAGMENTS * (value_size - _FRAGMENT_HEADER_SIZE)))
        return max(1, min(self.device.batch, (max_size - _HEADER_AND_CRC_SIZE) // sample_size))

    def _continued_frames(self, old: _Frames, t: float) -> _Frames:
        """Return the frames at the current interval that continue the sequence and the clock of the old ones at `t`."""
        new, signal = _Frames(self.signal(), old.batch), old.signal
        last = old.sent_numbers[-1] if old.sent_numbers else old.first_number_from(t) - 1
        new.start_at(new.first_number_from(t), signal.sequence + last + 1, signal.first, signal.ticks)
        return new

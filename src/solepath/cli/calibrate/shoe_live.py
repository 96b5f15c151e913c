"""Does the work of `solepath calibrate shoe --live`: a person at the terminal measures postures, a sensor the pitch.

Numbers were chosen by hand."""

from __future__ import annotations

import argparse
import asyncio
from collections.abc import AsyncIterable
from contextlib import AsyncExitStack
from math import degrees, radians
from pathlib import Path

from attrs import define, field

from ...ble import DeviceConfig, Devices, scan
from ...events import LinkTrouble
from ...link.decoder import Decoder
from ...papers.kupt_dfpc.shoe.fit import CONSTANT_COLUMNS, LONGEST_SHOE, MeasuredPosture, write_measurements
from ...papers.kupt_dfpc.shoe.gauge import STILL_TIME, PitchGauge
from ...recording import printable
from ...show.page.guide import ShownPosture
from ...show.page.scene.scene import Scene
from ...types import Foot, Packet, Sample, Site
from ..bluetooth.backend import backend_of
from ..bluetooth.devices import SCAN_TIME, named_devices
from ..common.failure import Failure
from ..common.loop import unless_stopped
from ..common.os_errors import file_error_text
from ..common.view import PageAddress, serve_page
from .terminal import Dialogue, meanwhile

PITCHES = (10, 22, 34, 46, 58)
"""Pitches to which the heel is raised, degrees: five postures between flat and toe-off; near them is as good."""
REDRAW_INTERVAL = 0.1
"""Time between two pictures of the pitch, s."""
SILENCE = 1.0
"""Time without a sample after which no pitch is shown, s."""
SEEN_LEAN = 5.0
"""Lean sideways from which it is shown, degrees: a pitch of 58 degrees is off by some tenths then."""
HELP = (
    "The pitch of the shoe is on the line that changes. Enter takes it as soon as the shoe was still for a second;\n"
    "u and Enter take the last measurement back; q and Enter end."
)


async def measure(options: argparse.Namespace, address: PageAddress | None, stop: asyncio.Event) -> int:
    """Measure until all postures are in the file or the person ends; return 0. Raise StoppedEarly at a signal.

    With an `address`, a page there shows the pitch as well."""
    constants = dict(zip(CONSTANT_COLUMNS, (options.height, options.heel), strict=True))
    devices = named_devices(options)
    if len(devices) > 1:
        raise Failure("one shoe at a time: --left or --right, not both")
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(unless_stopped(stop))
        backend = await stack.enter_async_context(backend_of(options.via))
        if not devices:
            print(f"looking for sensors for {SCAN_TIME:g} s ...", flush=True)
            found = [device for device in await scan(SCAN_TIME, backend=backend) if device.profile is not None]
            if len(found) != 1:
                names = ", ".join([f"{device.address} ({printable(device.name)})" for device in found])
                raise Failure(f"{names or 'no device that is known here'} in range: say which with --left or --right")
            devices = [DeviceConfig(Site.RIGHT_FOOT, found[0].address, found[0].profile)]
        packets = await stack.enter_async_context(Devices(devices, backend=backend, pair=options.pair))
        site = devices[0].site or Site.RIGHT_FOOT
        posture = ShownPosture(site.foot or Foot.RIGHT)
        shoe = LiveShoe(site, posture, Scene("A shoe is measured", "", guide=posture))
        if address is not None:
            await stack.enter_async_context(serve_page(shoe.scene, address))
        known = {name: value for name, value in constants.items() if value is not None}
        async with meanwhile(shoe.receive(packets)) as receiving:
            await Measuring(shoe, Dialogue(), options.file, known, receiving).run(options.times)
    return 0


@define
class LiveShoe:
    """The pitch of a shoe whose sensor sends packets."""

    site: Site
    posture: ShownPosture
    scene: Scene
    """Scene for a page, which shows this posture and the link."""
    gauge: PitchGauge = field(factory=PitchGauge, init=False)
    now: float = field(default=0.0, init=False)
    """Time of the newest packet, s."""
    sample_at: float | None = field(default=None, init=False)
    """Arrival of the newest sample, s; None before the first."""
    trouble: str | None = field(default=None, init=False)
    """Trouble of the link, in words; None while samples come."""

    async def receive(self, packets: AsyncIterable[Packet]) -> None:
        """Take packets until cancelled."""
        decoder = Decoder(self.site)
        async for packet in packets:
            self.now = packet.t
            for output in decoder.feed(packet):
                if isinstance(output, Sample):
                    self.scene.take(output, [])
                    if output.acc is not None:
                        self.gauge.add_sample(output.t, output.acc)
                        self.sample_at, self.trouble = packet.t, None
                    continue
                self.scene.take(None, [output])
                if isinstance(output, LinkTrouble):
                    self.trouble = output.what
            if self.is_silent:
                self.gauge.restart()
            self._show()

    @property
    def is_silent(self) -> bool:
        """True while no sample comes."""
        return self.sample_at is None or self.now - self.sample_at > SILENCE

    def instruct(self, task: str, target: float | None = None) -> None:
        """Show on the page what the person is to do, and the pitch to reach, degrees."""
        self.posture.task, self.posture.target = task, None if target is None else radians(target)

    def _show(self) -> None:
        """Show the present pitch on the page."""
        posture, reading = self.posture, None if self.is_silent else self.gauge.read()
        posture.still, posture.pitch, posture.lean = False, None, None
        if reading is not None:
            posture.still = reading.is_still
            posture.pitch = None if self.gauge.flat is None else reading.pitch
            posture.lean = reading.sideways if degrees(abs(reading.sideways)) > SEEN_LEAN else None

    def line(self) -> str:
        """Return the present pitch in words."""
        reading = None if self.is_silent else self.gauge.read()
        if reading is None:
            return f"{self.site.words}: {printable(self.trouble or 'waiting for the sensor', 60)}"
        steady = "steady" if reading.is_still else "unsteady"
        if self.gauge.flat is None:
            return f"{self.site.words}: {steady}"
        lean = degrees(abs(reading.sideways))
        return f"{self.site.words}: pitch {degrees(reading.pitch):5.1f} degrees, {steady}" + (
            f", leans {lean:.0f} degrees sideways" if lean > SEEN_LEAN else ""
        )


@define
class Measuring:
    """A person's way through all postures; what was measured is in the file after every answer."""

    shoe: LiveShoe
    talk: Dialogue
    file: Path
    constants: dict[str, float]
    receiving: asyncio.Task[None]
    done: list[MeasuredPosture] = field(factory=list, init=False)

    async def run(self, times: int) -> None:
        """Go through all postures, `times` times each."""
        self.talk.print_line(HELP)
        try:
            while len(self.done) < times * len(PITCHES):
                if self.shoe.gauge.flat is None:
                    self._instruct("Stand with the shoe flat on level ground: from there the pitch is counted.")
                    await self._take()
                else:
                    await self._measure(times)
        except EOFError:
            self.talk.print_line()
        if not self.done:
            raise Failure("no posture was measured, so that nothing is learnt")

    async def _measure(self, times: int) -> None:
        """Measure the next posture, or take the last one back."""
        k, time = divmod(len(self.done), times)
        self._instruct(
            f"Posture {k + 1} of {len(PITCHES)}, time {time + 1} of {times}: forefoot on the ground, heel up by about "
            f"{PITCHES[k]} degrees",
            PITCHES[k],
        )
        pitch = await self._take()
        if pitch is None:
            if self.done:
                self.done.pop()
                self._write()
                self.talk.print_line("taken back")
            else:
                self.shoe.gauge = PitchGauge()
            return
        self.talk.print_line(f"pitch {degrees(pitch):.1f} degrees, the mean of {STILL_TIME:g} s")
        to_ruler = await self._length("L_r in mm, along the sole from below the sensor to the ground:")
        to_toe = await self._length("L_p2t in mm, on the ground from there to where the toe stood:")
        self.done.append(MeasuredPosture(pitch, to_ruler, to_toe))
        self._write()

    def _instruct(self, task: str, target: float | None = None) -> None:
        """Say at the terminal and on the page what to do, with the pitch to reach, degrees."""
        self.talk.print_line(task)
        self.shoe.instruct(task, target)

    async def _take(self) -> float | None:
        """Return the pitch, rad, of a still second after Enter, or None for u; raise EOFError when the person ends."""
        self.talk.forget_typed()
        is_due = False
        while True:
            if self.receiving.done():
                self.receiving.result()
            if not is_due and (typed := self.talk.typed()) is not None:
                if typed == "u":
                    return None
                is_due = True
            if is_due and not self.shoe.is_silent and (pitch := self.shoe.gauge.take()) is not None:
                return pitch
            self.talk.show(self.shoe.line() + (": hold it still" if is_due else ""))
            await asyncio.sleep(REDRAW_INTERVAL)

    async def _length(self, question: str) -> float:
        """Return a length that is typed in mm, m; raise EOFError when the person ends."""
        self.shoe.instruct(f"Hold the shoe and answer at the terminal: {question}")
        while True:
            typed = await self.talk.prompt(question)
            try:
                length = 0.001 * float(typed.replace(",", "."))
            except ValueError:
                length = -1.0
            if 0.0 <= length <= LONGEST_SHOE:
                return length
            self.talk.print_line(f"that is no length from 0 to {1000.0 * LONGEST_SHOE:g} mm")

    def _write(self) -> None:
        try:
            write_measurements(self.file, self.done, self.constants)
        except OSError as error:
            raise Failure(file_error_text(error, self.file)) from None

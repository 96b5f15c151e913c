"""Does the work of `solepath calibrate shoe --live`: a person at the terminal measures postures, a sensor the pitch.

Numbers were chosen by hand."""

from __future__ import annotations

import asyncio
from argparse import Namespace
from collections.abc import AsyncIterable
from math import degrees, radians
from pathlib import Path

from attrs import define, field

from ...events import LinkTrouble
from ...link.decoder import Decoder
from ...papers.kupt_dfpc.shoe.fit import CONSTANT_COLUMNS, LONGEST_SHOE, MeasuredPosture, write_measurements
from ...papers.kupt_dfpc.shoe.gauge import STILL_TIME, PitchGauge
from ...recording import printable
from ...show.page.guide import ShownPosture
from ...show.page.scene.scene import Scene
from ...types import SITE_OF_FOOT, Foot, Packet, Sample
from ..common.failure import Failure
from ..common.os_errors import file_error_text
from ..common.view import PageAddress
from .guide import Dialogue, guide

PITCHES = (10, 22, 34, 46, 58)
"""Pitches to which the heel is raised, degrees: five postures between flat and toe-off; near them is as good."""
SILENCE = 1.0
"""Time without a sample after which no pitch is shown, s."""
SEEN_LEAN = 5.0
"""Lean sideways from which it is shown, degrees: a pitch of 58 degrees is off by some tenths then."""
HELP = (
    "The pitch of the shoe is on the line that changes. Enter takes it as soon as the shoe was still for a second;\n"
    "u and Enter take the last measurement back; q and Enter end."
)


async def measure(options: Namespace, address: PageAddress | None, stop: asyncio.Event) -> int:
    """Measure until all postures are in the file or the person ends; return 0."""
    if (options.left is None) == (options.right is None):
        raise Failure("one shoe at a time: say which sensor is in it, with --left or --right")
    constants = dict(zip(CONSTANT_COLUMNS, (options.height, options.heel), strict=True))
    known = {name: value for name, value in constants.items() if value is not None}
    shoe = LiveShoe(Foot.RIGHT if options.left is None else Foot.LEFT, options.files[0], options.times, known)
    return await guide(options, address, shoe, stop)


@define
class LiveShoe:
    """A shoe whose sensor sends packets, and a person's way through all postures.

    What was measured is in the file after every answer."""

    foot: Foot
    file: Path
    times: int
    """Number of measurements of each posture."""
    constants: dict[str, float]
    """Values that are the same in every row of the file, by column."""
    posture: ShownPosture = field(init=False)
    """Pitch and tasks, for a page."""
    scene: Scene = field(init=False)
    gauge: PitchGauge = field(factory=PitchGauge, init=False)
    done: list[MeasuredPosture] = field(factory=list, init=False)
    trouble: str = field(default="waiting for the sensor", init=False)
    """Why no sample comes."""

    is_due: bool = field(default=False, init=False)
    """True if a posture is taken as soon as the shoe is still."""

    def __attrs_post_init__(self) -> None:
        self.posture = ShownPosture(self.foot)
        self.scene = Scene("A shoe is measured", "", guide=self.posture)

    async def receive(self, packets: AsyncIterable[Packet]) -> None:
        """Take packets until cancelled."""
        decoder, newest = Decoder(SITE_OF_FOOT[self.foot]), float("-inf")
        async for packet in packets:
            for output in decoder.feed(packet):
                if isinstance(output, Sample):
                    self.scene.take(output, [])
                    if output.acc is not None:
                        self.gauge.add_sample(output.t, output.acc)
                        newest, self.trouble = packet.t, "waiting for the sensor"
                    continue
                self.scene.take(None, [output])
                if isinstance(output, LinkTrouble):
                    self.trouble = output.what
            if packet.t - newest > SILENCE:
                self.gauge.restart()
            posture, reading = self.posture, self.gauge.read()
            posture.still, posture.pitch, posture.lean = False, None, None
            if reading is not None:
                posture.still = reading.is_still
                posture.pitch = None if self.gauge.flat is None else reading.pitch
                posture.lean = reading.sideways if degrees(abs(reading.sideways)) > SEEN_LEAN else None

    def line(self) -> str:
        """Return the present pitch in words."""
        posture = self.posture
        if not self.gauge.recent:
            return f"{self.foot} foot: {printable(self.trouble, 60)}"
        words = ["steady" if posture.still else "unsteady"]
        if posture.pitch is not None:
            words.insert(0, f"pitch {degrees(posture.pitch):5.1f} degrees")
        if posture.lean is not None:
            words.append(f"leans {degrees(abs(posture.lean)):.0f} degrees sideways")
        return f"{self.foot} foot: {', '.join(words)}{': hold it still' if self.is_due else ''}"

    async def lead(self, talk: Dialogue) -> None:
        """Go through all postures; raise Failure when none was measured."""
        talk.print_line(HELP)
        try:
            while len(self.done) < self.times * len(PITCHES):
                if self.gauge.flat is None:
                    self._instruct("Stand with the shoe flat on level ground: from there the pitch is counted.", talk)
                    await self._take(talk)
                else:
                    await self._measure(talk)
        except EOFError:
            talk.print_line()
        if not self.done:
            raise Failure("no posture was measured, so that nothing is learnt")

    async def _measure(self, talk: Dialogue) -> None:
        """Measure the next posture, or take the last one back."""
        k, time = divmod(len(self.done), self.times)
        self._instruct(
            f"Posture {k + 1} of {len(PITCHES)}, time {time + 1} of {self.times}: forefoot on the ground, heel up by "
            f"about {PITCHES[k]} degrees",
            talk,
            radians(PITCHES[k]),
        )
        pitch = await self._take(talk)
        if pitch is not None:
            talk.print_line(f"pitch {degrees(pitch):.1f} degrees, the mean of {STILL_TIME:g} s")
            to_ruler = await self._length("L_r in mm, along the sole from below the sensor to the ground:", talk)
            to_toe = await self._length("L_p2t in mm, on the ground from there to where the toe stood:", talk)
            self.done.append(MeasuredPosture(pitch, to_ruler, to_toe))
        elif self.done:
            self.done.pop()
            talk.print_line("taken back")
        else:
            self.gauge = PitchGauge()
            return
        try:
            write_measurements(self.file, self.done, self.constants)
        except OSError as error:
            raise Failure(file_error_text(error, self.file)) from None

    def _instruct(self, task: str, talk: Dialogue | None = None, target: float | None = None) -> None:
        """Say on the page, and at the terminal, what to do, with the pitch to reach, rad."""
        self.posture.task, self.posture.target = task, target
        if talk is not None:
            talk.print_line(task)

    async def _take(self, talk: Dialogue) -> float | None:
        """Return the pitch, rad, of a still second after Enter, or None for u; raise EOFError when the person ends."""
        self.is_due = False
        async for typed in talk.turns(self.line):
            if typed == "u" and not self.is_due:
                break
            self.is_due = self.is_due or typed is not None
            if self.is_due and (pitch := self.gauge.take()) is not None:
                self.is_due = False
                return pitch
        return None

    async def _length(self, question: str, talk: Dialogue) -> float:
        """Return a length that is typed in mm, m; raise EOFError when the person ends."""
        self._instruct(f"Hold the shoe and answer at the terminal: {question}")
        while True:
            typed = await talk.prompt(question)
            try:
                length = 0.001 * float(typed.replace(",", "."))
            except ValueError:
                length = -1.0
            if 0.0 <= length <= LONGEST_SHOE:
                return length
            talk.print_line(f"that is no length from 0 to {1000.0 * LONGEST_SHOE:g} mm")

"""Does the work of `solepath calibrate toe-out --live`: a person walks, and terminal and page show strides and angles.

Numbers were chosen by hand."""

from __future__ import annotations

import asyncio
from argparse import Namespace
from collections.abc import AsyncIterable, Sequence
from math import degrees, fsum

from attrs import define, evolve, field

from ...ble.record import start_keys
from ...calibration import CalibrationError
from ...papers.footstep_tracker.toe_out import ERRORS, FEWEST_STRIDES, ToeOutWalk
from ...recording import PacketWriter
from ...show.page.guide import ShownFoot, ShownToeOut
from ...show.page.scene.scene import Scene
from ...types import Foot, Packet
from ..common.failure import Failure
from ..common.view import PageAddress
from .guide import Dialogue, guide

STANDING_TIME = 3.0
"""Time for which each sensor must have sent before the walk, s: while the feet stand still, they show its bias."""
STAND = "Stand still with both shoes on, and press Enter after three seconds (q and Enter end)."
WALK = "Walk straight ahead at an even pace, {length}, stand still, and press Enter."
UNKNOWN_LENGTH = "20 m or as far as there is room"


async def measure(options: Namespace, address: PageAddress | None, stop: asyncio.Event) -> int:
    """Record until the person has walked; return 0."""
    feet = [foot for foot, device in ((Foot.LEFT, options.left), (Foot.RIGHT, options.right)) if device]
    if not feet:
        raise Failure("say which sensors are in the shoes: --left and --right")
    writer = PacketWriter(options.files[0], start_keys(), replace=options.force)
    try:
        return await guide(options, address, GuidedWalk(writer, feet, ShownToeOut(distance=options.distance)), stop)
    except EOFError:
        raise Failure("nobody walked, so that nothing is learnt") from None
    finally:
        writer.discard()


@define
class GuidedWalk:
    """A walk that is recorded and measured as its packets come."""

    writer: PacketWriter
    feet: Sequence[Foot]
    """Feet whose sensors take part: the walk waits for all of them."""
    shown: ShownToeOut = field(factory=ShownToeOut)
    """Tasks and feet, for a page."""
    walk: ToeOutWalk = field(factory=ToeOutWalk, init=False)
    scene: Scene = field(init=False)
    """Scene for a page, which shows `shown` and the links."""
    first_t: dict[Foot, float] = field(factory=dict, init=False)
    """Time of the packet that gave the first sample of each foot, s."""
    t: float = field(default=0.0, init=False)
    """Time of the newest packet, s."""

    def __attrs_post_init__(self) -> None:
        self.scene = Scene("A walk that calibrates toe-out", self.walk.session.recipe.name, guide=self.shown)

    async def receive(self, packets: AsyncIterable[Packet]) -> None:
        """Take packets until cancelled."""
        async for packet in packets:
            self.t = packet.t
            self.writer.write(packet)
            self.scene.take(packet, self.walk.feed(packet))
            for foot in self.walk.session.feet:
                self.first_t.setdefault(foot, packet.t)

    async def lead(self, talk: Dialogue) -> None:
        """Say what to do and wait for it; raise EOFError when the person ends before the walk."""
        distance = self.shown.distance
        length = UNKNOWN_LENGTH if distance is None else f"exactly {distance:g} m"
        for instruction in (STAND, WALK.format(length=length)):
            talk.print_line(instruction)
            self.shown.task = instruction
            is_due = False
            async for typed in talk.turns(self.line):
                is_due = is_due or typed is not None
                if is_due and self.has_stood:
                    break

    @property
    def has_stood(self) -> bool:
        """Flag: the sensor of every foot has sent for `STANDING_TIME`."""
        return all([foot in self.first_t and self.t - self.first_t[foot] >= STANDING_TIME for foot in self.feet])

    def line(self) -> str:
        """Return the strides and angles so far in words, or the feet whose sensors do not send yet; update `shown`."""
        self.shown.feet = tuple([self._foot(foot) for foot in self.feet])
        waiting = [foot.value for foot in self.feet if foot not in self.first_t]
        if waiting:
            return f"waiting for the sensor of the {' and '.join(waiting)} foot"
        return "; ".join([_words(foot) for foot in self.shown.feet])

    def _foot(self, foot: Foot) -> ShownFoot:
        strides = self.walk.strides(foot)
        shown = ShownFoot(foot, len(strides), fsum([along for along, _, _ in strides]))
        try:
            of = self.walk.foot(foot)
        except CalibrationError as error:
            return evolve(shown, why=str(error))
        if of is None:
            sends = foot in self.first_t
            return evolve(
                shown, why=f"{FEWEST_STRIDES} strides are needed" if sends else "its sensor does not send yet"
            )
        why = "" if of.is_known else f"the angle is less than {ERRORS:g} of its errors"
        return evolve(shown, angle=of.angle, sigma=of.sigma, learnt=of.is_known, why=why)


def _words(foot: ShownFoot) -> str:
    strides = f"{foot.foot} {foot.strides} strides"
    if foot.angle is not None and foot.sigma is not None:
        return f"{strides}, {degrees(foot.angle):.1f} +- {degrees(foot.sigma):.1f} degrees"
    return strides if foot.strides < FEWEST_STRIDES else f"{strides}: {foot.why}"

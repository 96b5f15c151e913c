"""What the experiments have in common: emulated walks, cut in two where a wearer stood, and sessions that hear them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from attrs import evolve, frozen

from ...calibration import Calibration, InsoleCalibration
from ...emulate.routes.route import Route, Stand
from ...emulate.walk import EmulatedWalk
from ...emulate.wearers.walker import Walker
from ...events import Event
from ...floorplan.plan import FloorPlan
from ...recipes import Recipe
from ...recording.decoded import decode_recording
from ...session import Session
from ...types import Packet, Sample
from ..measures.alignment import Floats, align
from ..measures.strides import ALIGNED_OVER


def then(first: Route, second: Route) -> Route:
    """One after the other, the second from where and whither the first ends."""
    return evolve(first, actions=(*first.actions, *second.actions), speed=second.speed)


def rest_after(walker: Walker, first: Route) -> float:
    """The middle of the stand with which `first`, the beginning of the walker's route, ends, s."""
    walked = [not isinstance(action, Stand) for action in first.actions]
    stretches = sum(now and not before for before, now in zip([False, *walked], walked, strict=False))
    bouts = walker.plan.bouts
    return 0.5 * (bouts[stretches - 1][1] + bouts[stretches][0])


@frozen(eq=False)
class WalkParts:
    """A walk decoded and cut in two: samples `before` and `after`, and where the cells are, which an app that hears the
    devices from the beginning would know too."""

    before: tuple[Sample, ...]
    after: tuple[Sample, ...]
    layouts: Calibration


def cut(walk: EmulatedWalk, t: float) -> WalkParts:
    """The samples of a walk's packets, measured before and after `t` s."""
    heard = decode_recording(walk.packets)
    insoles = {foot: InsoleCalibration(layout=layout) for foot, layout in heard.layouts.items()}
    before, after = (tuple([one for one in heard.samples if (one.t < t) is first]) for first in (True, False))
    return WalkParts(before, after, Calibration(insoles=insoles))


def heard(
    recipe: Recipe,
    items: Iterable[Packet | Sample],
    calibration: Calibration | None = None,
    floorplan: FloorPlan | None = None,
) -> list[Event]:
    """All that a session of the recipe says."""
    session = Session(recipe, calibration=calibration, floorplan=floorplan)
    return session.feed(items) + session.finish()


def laid(track: Floats, truth: Floats, over: float = ALIGNED_OVER) -> Floats:
    """`track` (n, 2) turned and shifted onto `truth` (n, 2), row by row the same instants, so that both are as near as
    can be over the first `over` metres."""
    far = np.linalg.norm(truth - truth[0], axis=1) > over
    count = int(np.argmax(far)) + 1 if far.any() else len(truth)
    return align(track[:count], truth[:count]).apply(track)


def thinned(points: Iterable[Sequence[float]], most: int = 4000) -> tuple[tuple[float, float], ...]:
    """(x, y) of at most so many of these places, evenly chosen, the last one among them."""
    all_of = [(float(p[0]), float(p[1])) for p in points]
    every = -(-len(all_of) // most) or 1
    return tuple(all_of[::-1][::every][::-1])

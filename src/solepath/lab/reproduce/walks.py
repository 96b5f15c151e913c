"""Shared steps of the experiments: emulated walks, cut in two where a wearer stands, and sessions that receive them."""

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
from ..measures.strides import ALIGNMENT_LENGTH


def join_routes(first: Route, second: Route) -> Route:
    """Return both routes in sequence; the second starts where the first ends, in its direction."""
    return evolve(first, actions=(*first.actions, *second.actions), speed=second.speed)


def rest_after(walker: Walker, first: Route) -> float:
    """Return the middle of the stand that ends `first`, the beginning of the walker's route, s."""
    walked = [not isinstance(action, Stand) for action in first.actions]
    stretches = sum(now and not before for before, now in zip([False, *walked], walked, strict=False))
    bouts = walker.plan.bouts
    return 0.5 * (bouts[stretches - 1][1] + bouts[stretches][0])


@frozen(eq=False)
class WalkParts:
    """A decoded walk cut in two: samples `before` and `after`, and `layouts`, the positions of the cells.

    An app that is connected to the devices from the start has the positions of the cells too."""

    before: tuple[Sample, ...]
    after: tuple[Sample, ...]
    layouts: Calibration


def cut(walk: EmulatedWalk, t: float) -> WalkParts:
    """Return the samples of a walk's packets, measured before and after `t` s."""
    decoded = decode_recording(walk.packets)
    insoles = {foot: InsoleCalibration(layout=layout) for foot, layout in decoded.layouts.items()}
    before, after = (tuple([one for one in decoded.samples if (one.t < t) is first]) for first in (True, False))
    return WalkParts(before, after, Calibration(insoles=insoles))


def run_session(
    recipe: Recipe,
    items: Iterable[Packet | Sample],
    calibration: Calibration | None = None,
    floorplan: FloorPlan | None = None,
) -> list[Event]:
    """Return all events of a session of the recipe."""
    session = Session(recipe, calibration=calibration, floorplan=floorplan)
    return session.feed(items) + session.finish()


def align_track(track: Floats, truth: Floats, over: float = ALIGNMENT_LENGTH) -> Floats:
    """Return `track` (n, 2) turned and shifted to fit `truth` (n, 2) best over the first `over` metres.

    Rows of both are the same instants."""
    far = np.linalg.norm(truth - truth[0], axis=1) > over
    count = int(np.argmax(far)) + 1 if far.any() else len(truth)
    return align(track[:count], truth[:count]).apply(track)


def thin_out(points: Iterable[Sequence[float]], most: int = 4000) -> tuple[tuple[float, float], ...]:
    """Return (x, y) of at most `most` of these points, evenly chosen, the last one among them."""
    all_of = [(float(p[0]), float(p[1])) for p in points]
    every = -(-len(all_of) // most) or 1
    return tuple(all_of[::-1][::every][::-1])

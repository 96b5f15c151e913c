"""Functions that the experiments share: to join routes, to cut walks in two at a halt, and to run sessions on them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
from attrs import evolve, frozen

from solepath.calibration import Calibration, InsoleCalibration
from solepath.emulate.routes.path import Stand
from solepath.emulate.routes.route import Route
from solepath.emulate.walk import EmulatedWalk
from solepath.emulate.wearers.truth import TrueStride
from solepath.emulate.wearers.walker import Walker
from solepath.events import Event, StrideTaken
from solepath.floorplan.plan import FloorPlan
from solepath.recipes import Recipe
from solepath.recording.decoded import decode_recording
from solepath.session import Session
from solepath.types import Foot, Packet, Sample
from solepath.validate.alignment import ALIGNMENT_LENGTH, Floats, align
from solepath.validate.matching import pairs

MATCHING_TIME = 0.3
"""Largest time between the ends of a found stride and the true one that it matches, s."""


def join_routes(first: Route, second: Route) -> Route:
    """Return `first` and then `second`, which starts where `first` ends, in the direction that the wearer has there."""
    return evolve(first, actions=(*first.actions, *second.actions), speed=second.speed)


def find_halt(walker: Walker, first: Route) -> float:
    """Return the middle of the halt, s, that ends the first part `first` of the walker's route."""
    walked = [not isinstance(action, Stand) for action in first.actions]
    n_bouts = sum(now and not before for before, now in zip([False, *walked], walked, strict=False))
    bouts = walker.plan.bouts
    return 0.5 * (bouts[n_bouts - 1][1] + bouts[n_bouts][0])


@frozen(eq=False)
class WalkParts:
    """The samples of a walk that is cut in two."""

    before: tuple[Sample, ...]
    after: tuple[Sample, ...]
    layouts: Calibration
    """Positions of the cells, which an app receives when it connects to the insoles."""


def cut_walk(walk: EmulatedWalk, t: float) -> WalkParts:
    """Return the samples of a walk before and after `t` s."""
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


def final_strides(events: Iterable[Event], foot: Foot | None = None) -> list[StrideTaken]:
    """Return the final strides of a foot, or of both feet when none is named."""
    strides = [one for one in events if isinstance(one, StrideTaken) and one.final]
    return strides if foot is None else [one for one in strides if one.foot is foot]


def align_track(track: Floats, truth: Floats, over: float = ALIGNMENT_LENGTH) -> Floats:
    """Return `track` (n, 2) turned and shifted to fit `truth` (n, 2) best, m; equal rows are the same instant.

    The fit ends with the first row that is more than `over` m away from the start."""
    far = np.linalg.norm(truth - truth[0], axis=1) > over
    count = int(np.argmax(far)) + 1 if far.any() else len(truth)
    return align(track[:count], truth[:count]).apply(track)


def thin_out(points: Iterable[Sequence[float]], max_points: int = 4000) -> tuple[tuple[float, float], ...]:
    """Return (x, y) of at most `max_points` of these points at equal intervals, the last point included."""
    positions = [(float(p[0]), float(p[1])) for p in points]
    interval = -(-len(positions) // max_points) or 1
    return tuple(positions[::-1][::interval][::-1])


def matched(found: Sequence[StrideTaken], true: Sequence[TrueStride]) -> list[tuple[StrideTaken, TrueStride]]:
    """Return the pairs of a found and a true stride whose ends are at most MATCHING_TIME apart, one to one."""
    ends = [one.t_end for one in true], [stride.t_end for stride in found]
    return [(found[j], true[i]) for i, j in pairs(*ends, MATCHING_TIME)]

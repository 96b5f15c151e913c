"""Evidence of the errors that both tracks share: rests, straight ways, ground that moves, and outside help.

The compass, and what uses a reported position, are loaded when a session first has them (body/aiding)."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Final, Protocol

from ...events import Defect, DefectFound, PositionRejected, PositionReported, StrideTaken, TrackRevised
from ...foot.view import AfterEvents, FootView
from ...types import SITE_OF_FOOT, Foot, Phase, Vec3
from ...types.attrs import define, field
from ..aiding.walked_path import PlanStart, WalkedPath
from .common_error import NO_MOVE, CommonError, Move
from .learnt_bias import add_rest
from .moving_ground import MovingGround
from .position import PlacedTrack
from .position_covariance import position_covariance
from .straight_ways import StraightWays

LEFT: Final = Foot.LEFT
"""Local name of `Foot.LEFT`, because a look-up in the enum is slow."""
STATIONARY: Final = Phase.STATIONARY
"""Local name of `Phase.STATIONARY`."""
Pair = tuple[float, float]
"""A position or a displacement in the horizontal plane, m."""
SPACING = 0.2
"""Least time between samples of both feet that the compass has, s: one to three in a stance, whose noise is small."""


class Aid(Protocol):
    """Outside help that has rows of its own in the filter of the common errors.

    It is a protocol, so that its class (types/registry.py) is loaded only when it is needed."""

    def add_sample(self, foot: int, view: FootView, mag: Vec3) -> None:
        """Add a sample of foot 0 (left) or 1, which stands, with the flux density `mag`, T, sensor frame."""

    def add_stride(self, event: StrideTaken, foot: int, turn: float, error: CommonError) -> tuple[Move, str | None]:
        """Add what was measured before a stride of foot 0 (left) or 1, whose track is turned by `turn`, rad.

        Returns the correction of both tracks, and a sentence on a fault, once."""

    def turned(self, yaw: float) -> None:
        """Turn what is in the common frame with both tracks, by `yaw`, rad."""

    def north(self, error: CommonError) -> tuple[float, float] | None:
        """Return the direction of magnetic north, common frame, and its standard deviation, rad; None if unknown."""

    def reset(self, foot: int, error: CommonError) -> None:
        """Forget what depends on the device of foot 0 (left) or 1."""


@define
class SharedEvidence:
    """The evidence, and the defects that it has shown at the newest stride."""

    straight_ways: StraightWays = field(factory=StraightWays, init=False)
    ground: MovingGround = field(factory=MovingGround, init=False)
    compass: Aid | None = field(default=None, init=False)
    """The compass; None until a sample has a magnetic field."""
    measured_at: float = field(default=0.0, init=False)
    """Time of the newest sample that the compass has, s."""
    path: WalkedPath = field(factory=WalkedPath, init=False)
    """Path of the wearer so far."""
    found: list[DefectFound] = field(factory=list, init=False)

    def add_stance_sample(self, view: FootView, mag: Vec3) -> None:
        """Add a sample of a foot that stands, with the magnetic flux density `mag`, T, sensor frame."""
        self.measured_at = view.t
        if self.compass is None:
            from ..aiding.compass import Compass

            self.compass = Compass()
        self.compass.add_sample(0 if view.foot is LEFT else 1, view, mag)

    def before_stride(
        self, event: StrideTaken, foot: int, after: AfterEvents, track: PlacedTrack, error: CommonError, aligned: bool
    ) -> Iterator[Move]:
        """Yield the corrections of both tracks by what was seen before a stride of foot 0 (left) or 1.

        Each is made before the next one is asked for. Outside help waits until the tracks are `aligned`."""
        defect = self.ground.add_stride(foot, event, after)
        self.found = [] if defect is None else [defect]
        error.inflate(self.ground.variance(event.t_end))
        yield add_rest(error, foot, event.t_end, after.bias)
        if self.compass is not None and aligned:
            move, fault = self.compass.add_stride(event, foot, track.turn, error)
            yield move
            if fault is not None:
                self.found.append(
                    DefectFound(
                        t=event.t, known_at=event.known_at, site=SITE_OF_FOOT[event.foot], defect=Defect.COMPASS,
                        what=fault, spoils=False,
                    )
                )  # fmt: skip

    def after_stride(
        self, event: StrideTaken, foot: int, strides: float, displacement: Pair, error: CommonError,
        place: Pair, straight: bool,
    ) -> Move:  # fmt: skip
        """Return the correction of both tracks by a stride of foot 0 (left) or 1 that counts as `strides` usual ones.

        Its `displacement` and the wearer's `place` after it are in the common frame, m; `straight` says whether it may
        be part of a straight way."""
        self.path.add_stride(event.t_end, place, error.shares[foot] * event.length)
        if not straight:
            return NO_MOVE
        move, misfit = self.straight_ways.add_stride(foot, event, strides, displacement, error)
        if misfit is not None:
            self.found.append(misfit)
        return move

    def use_position(
        self, event: PositionReported, place: Callable[[], Pair], plan_start: PlanStart | None,
        error: CommonError, move_both: Callable[[Move], None],
    ) -> list[TrackRevised | PositionRejected]:  # fmt: skip
        """Correct both tracks with `move_both` by a reported position, reject it, or note a new place without an event.

        `place` returns where the wearer is according to the track, m, common frame."""
        from ..aiding.reported_position import ReportedPosition, in_world_frame

        in_world = in_world_frame(event, plan_start)
        return [] if in_world is None else ReportedPosition(in_world, place, error, self.path, move_both).use()

    def covariance(self, position: Vec3, error: CommonError) -> tuple[float, float, float]:
        """Return the covariance of the wearer's `position`, m, common frame: xx, xy, yy, m^2."""
        x, y = self.path.known
        return position_covariance(error, (position[0] - x, position[1] - y))

    def turned(self, yaw: float) -> None:
        """Turn what is in the common frame with both tracks, by `yaw`, rad."""
        if self.compass is not None:
            self.compass.turned(yaw)

    def north(self, error: CommonError) -> tuple[float, float] | None:
        """Return the direction of magnetic north, common frame, and its standard deviation, rad; None if unknown."""
        return None if self.compass is None else self.compass.north(error)

    def reset(self, foot: Foot, error: CommonError) -> None:
        """Forget what depends on the clock or the device of a foot."""
        self.straight_ways.reset(foot)
        self.ground, self.path.known_at = MovingGround(), None
        if self.compass is not None:
            self.compass.reset(0 if foot is LEFT else 1, error)

"""Footfalls: where the feet of a wearer land on a path or in a turn on the spot, and how long each step takes."""

from __future__ import annotations

import numpy as np
from attrs import evolve, frozen

from ..wearers.curves import Rng
from ..wearers.gait import Wearer
from .path import AHEAD, BACK, Flight, Piece, Pose, Turn, WalkPath
from .styles import BACKWARDS_RATIO, SIDE_STEP, StrideKind, running_cadence


@frozen
class Footfall:
    """One planned step whose times are not known yet."""

    pose: Pose
    """Pose on the centre line of the path."""
    speed: float
    """Speed along the path, m/s."""
    duration: float
    """Mean duration of the step, s."""
    curvature: float = 0.0
    """Curvature of the path at the footfall, 1/m; positive to the left."""
    kind: StrideKind = StrideKind.WALK
    """Kind of the stride that ends here."""
    flight: Flight | None = None
    """Flight of stairs of the footfall; None on the level."""


@frozen(eq=False)
class FootfallPlan:
    """The footfalls of a wearer, drawn in the order of the steps."""

    wearer: Wearer
    """Wearer who walks."""
    rng: Rng
    """Generator of all variations."""

    def on_path(self, path: WalkPath) -> list[Footfall]:
        """Return the footfalls of a path, section by section, and that of the closing half step."""
        footfalls: list[Footfall] = []
        if path.pieces[0].move.direction != AHEAD:
            return [footfall for piece in path.pieces for footfall in self._other_way_footfalls(piece)]
        for section in path.sections:
            piece = section.pieces[0]
            if piece.flight is not None:
                footfalls += self._stair_footfalls(piece, piece.flight)
            elif piece.move.spacing is not None:
                footfalls += self._mark_footfalls(section, piece.move.spacing)
            else:
                footfalls += self._natural_footfalls(section)
        # The closing half step ends beside the foot that arrived.
        return [*footfalls, evolve(footfalls[-1], kind=StrideKind.WALK)]

    def _natural_footfalls(self, path: WalkPath) -> list[Footfall]:
        """Return footfalls with steps of natural length, varied at random and scaled to end at the path's end."""
        ends: list[float] = []
        s = 0.0
        while not ends or ends[-1] < path.length:
            speed, running = path.pace(min(s, path.length))
            cadence = self._cadence(speed, running)
            step_length = speed * 60.0 / cadence if running else self.wearer.walk_ratio * cadence
            s += step_length * self.vary(self.wearer.length_variation)
            ends.append(s)
        if len(ends) > 1 and ends[-1] - path.length > path.length - ends[-2]:
            ends.pop()
        scale = path.length / ends[-1]
        move_pose = self.wearer.wander(path.length, self.rng) if self.wearer.wander else None
        footfalls = []
        for end in (scale * end for end in ends):
            pose, move = path.at(end)
            if move_pose is not None:
                pose = move_pose(pose, end)
            speed, running = path.pace(end)
            step_time = 60.0 / self._cadence(speed, running)
            kind = StrideKind.RUN if running else StrideKind.WALK
            footfalls.append(Footfall(pose, speed, step_time, move.curvature, kind))
        return footfalls

    def _cadence(self, speed: float, running: bool) -> float:
        return running_cadence(speed) if running else self.wearer.cadence(speed)

    def _mark_footfalls(self, path: WalkPath, spacing: float) -> list[Footfall]:
        count = max(1, round(path.length / spacing))
        mark_spacing = path.length / count
        footfalls = []
        for k in range(1, count + 1):
            _, move = path.at(mark_spacing * k)
            position = mark_spacing * k + self.wearer.mark_error * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))
            footfalls.append(Footfall(path.at(position)[0], move.speed, mark_spacing / move.speed, move.curvature))
        return footfalls

    def _other_way_footfalls(self, piece: Piece) -> list[Footfall]:
        """Return the footfalls of a walk backwards or sideways.

        Sideways both feet go to each place, one after the other; backwards they do so at the end only."""
        is_back, speed, length = piece.move.direction == BACK, piece.move.speed, piece.move.length
        ratio = BACKWARDS_RATIO * self.wearer.walk_ratio
        count = max(1, round(length / (float(np.sqrt(60.0 * speed * ratio)) if is_back else SIDE_STEP)))
        step_length, kind = length / count, StrideKind.BACK if is_back else StrideKind.SIDE
        duration = step_length / speed if is_back else 0.5 * step_length / speed
        footfalls = []
        for k in range(1, count + 1):
            place = step_length * (k if k == count else k - 1 + self.vary(self.wearer.length_variation))
            footfall = Footfall(piece.at(place), speed, duration, 0.0, kind)
            footfalls += [footfall] if is_back and k < count else [footfall, footfall]
        return footfalls

    def _stair_footfalls(self, piece: Piece, flight: Flight) -> list[Footfall]:
        """Return one footfall for every riser."""
        kind = StrideKind.UP if flight.rise > 0.0 else StrideKind.DOWN
        footfalls = []
        for k in range(1, flight.steps + 1):
            position = flight.going * k + self.wearer.mark_error * float(np.clip(self.rng.standard_normal(), -2.0, 2.0))
            pose = evolve(piece.start.ahead(position, 0.0), z=flight.z + flight.rise * k)
            speed = piece.move.speed
            footfalls.append(Footfall(pose, speed, flight.going / speed, 0.0, kind, flight))
        return footfalls

    def in_turn(self, start: Pose, turn: Turn) -> list[Footfall]:
        """Return the footfalls of a turn on the spot, and that of the closing step."""
        count = max(1, int(np.ceil(abs(turn.angle) / self.wearer.max_pivot_turn)))
        duration = 60.0 / self.wearer.cadence(turn.speed)
        poses = [start.turned(turn.angle * k / count) for k in range(1, count + 1)]
        return [Footfall(pose, turn.speed, duration) for pose in (*poses, poses[-1])]

    def vary(self, sigma: float) -> float:
        """Return a random factor about 1, limited to three sigma."""
        return 1.0 + sigma * float(np.clip(self.rng.standard_normal(), -3.0, 3.0))

"""The actions of a route, and the stages that they make: stands, rides, turns on the spot, and paths between halts."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, sin

from attrs import evolve, frozen

from .elevator import Elevator
from .escalator import Escalator
from .path import AHEAD, ElevatorStage, EscalatorStage, Flight, Piece, Pivot, Pose, WalkPath, ahead


@frozen
class Stand:
    """An action: stand still with the feet side by side."""

    duration: float
    """Duration of standing, s."""


@frozen
class Walk:
    """An action: walk or run straight on."""

    distance: float
    """Distance of the move, m."""
    speed: float
    """Speed of the move, m/s."""
    spacing: float | None = None
    """Distance between marks to step on, m; None: no marks."""
    running: bool = False
    """True when the wearer runs."""
    slope: float = 0.0
    """Slope of the ground, as rise over run, no unit; negative downwards."""
    direction: float = AHEAD
    """Angle from the heading of the feet to the direction of the move, rad: AHEAD, LEFT, RIGHT or BACK."""


@frozen
class TurnAction:
    """An action: turn along an arc or on the spot."""

    angle: float
    """Angle of the turn, rad; counter-clockwise positive."""
    radius: float
    """Radius of the arc, m; 0: on the spot."""
    speed: float
    """Speed of the move, m/s."""
    spacing: float | None = None
    """Distance between marks to step on, m; None: no marks."""


@frozen
class Stairs:
    """An action: walk a flight of stairs, each foot on every other tread."""

    steps: int
    """Number of risers."""
    rise: float
    """Height of a riser, m; negative downwards."""
    going: float
    """Distance between risers, m."""
    speed: float
    """Horizontal speed along the flight, m/s."""
    escalator: Escalator | None = None
    """Escalator whose steps these are; None for stairs that do not move."""


Action = Stand | Walk | TurnAction | Stairs | Elevator | Escalator
Stage = Stand | WalkPath | Pivot | ElevatorStage | EscalatorStage


def stages(actions: Iterable[Action]) -> list[Stage]:
    """Return the stages that actions make.

    Poses are on the ground as it lies at the start: those after an escalator do not contain its displacement."""
    route_stages: list[Stage] = []
    pieces: list[Piece] = []
    pose = Pose(0.0, 0.0, 0.0, 0.0)

    def close() -> None:
        if pieces:
            route_stages.append(WalkPath(tuple(pieces)))
            pieces.clear()

    for action in actions:
        match action:
            case Stand():
                close()
                route_stages.append(action)
                continue
            case TurnAction(angle=angle, radius=0.0):
                close()
                pivot = Pivot(pose, angle, action.speed)
                route_stages.append(pivot)
                pose = pivot.end
                continue
            case Elevator():
                close()
                stage = ElevatorStage(pose, action)
                route_stages.append(stage)
                pose = stage.end
                continue
            case Escalator():
                close()
                route_stages.append(EscalatorStage(pose, action))
                continue
            case TurnAction(angle=angle, radius=radius):
                bend = (1.0 if angle > 0.0 else -1.0) / radius
                piece = Piece(pose, abs(angle) * radius, bend, action.speed, action.spacing)
            case Walk(distance=distance, slope=slope, direction=direction):
                piece = Piece(
                    pose, distance, 0.0, action.speed, action.spacing, action.running, slope=slope, direction=direction
                )
            case Stairs(steps=steps, rise=rise, going=going):
                edge = pose.ahead(ahead(rise > 0.0, going), 0.0)
                flight = Flight(edge.x, edge.y, pose.z, pose.heading, steps, rise, going, action.escalator)
                piece = Piece(pose, steps * going, 0.0, action.speed, None, flight=flight)
        if pieces and not pieces[-1].leads_on_to(piece):
            close()
        pieces.append(piece)
        pose = piece.at(piece.length)
    close()
    return route_stages


def end_pose(route_stages: Iterable[Stage]) -> Pose:
    """Return the pose at the end of stages, between the feet, where escalators have moved the wearer."""
    pose, shift = Pose(0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0)
    for stage in route_stages:
        if isinstance(stage, Stand):
            continue
        pose = stage.end
        ridden = [(stage.start.heading, stage.escalator)] if isinstance(stage, EscalatorStage) else []
        if isinstance(stage, WalkPath):
            flights = [piece.flight for piece in stage.pieces if piece.flight is not None]
            ridden = [(flight.heading, flight.escalator) for flight in flights if flight.escalator is not None]
        for heading, one in ridden:
            x, y, z = shift
            shift = (x + one.run * cos(heading), y + one.run * sin(heading), z + one.height)
    return evolve(pose, x=pose.x + shift[0], y=pose.y + shift[1], z=pose.z + shift[2])

"""Panels of fig. 13 (a) to (h) and of fig. 15 of Liu et al. 2015."""

from __future__ import annotations

from collections.abc import Sequence

from solepath.emulate.routes.building import BUILDING
from solepath.types import Activity, Turn

from ...measures.confusion import ActivityScore
from ..tables import Bars, DrawStyle, Panel, PictureTrack, Plot
from .activities import ActivityResults
from .corridor import CORRIDOR_LENGTH, CorridorResults
from .places import PlaceResults
from .turning import TurnResults

CLASSES = (
    Activity.STANDING, Activity.WALKING, Activity.STAIRS_UP, Activity.STAIRS_DOWN, Activity.ELEVATOR_UP,
    Activity.ELEVATOR_DOWN,
)  # fmt: skip
"""Activities of fig. 13 (a)."""


def class_shares(scores: Sequence[ActivityScore], activity: Activity) -> list[float]:
    """Return the share of windows of an activity that are right in each walk that has it, %."""
    counts = [(one.samples.get((activity, activity), 0), sum(one.reported_for(activity).values())) for one in scores]
    return [100.0 * right / count for right, count in counts if count]


def share_right(pairs: Sequence[tuple[int, int]]) -> float:
    """Return the percentage of right answers in pairs of (number right, number of all)."""
    return 100.0 * sum([right for right, _ in pairs]) / max(1, sum([count for _, count in pairs]))  # whole numbers


def panels(
    corridors: Sequence[CorridorResults],
    activities: Sequence[ActivityResults],
    turns: Sequence[TurnResults],
    places: Sequence[PlaceResults],
) -> tuple[Panel, ...]:
    """Return the panels (a) to (h), and the way of fig. 15; single curves are of the first wearer."""
    scores = {name: [one.scores[name] for one in activities] for name in ("ours", "printed")}
    shares = tuple(
        (name, tuple([_mean(class_shares(of, activity)) for activity in CLASSES])) for name, of in scores.items()
    )
    angles = sorted(turns[0].errors)
    by_angle = [
        PictureTrack(name, tuple([(angle, _mean([of[angle] for of in found])) for angle in angles]))
        for name, found in (
            ("ours", [one.errors for one in turns]),
            ("(7) as printed", [one.printed_errors for one in turns]),
        )
    ]
    classes = tuple([share_right([one.classes[turn] for one in turns]) for turn in Turn])
    along = [PictureTrack(name, of) for name, of in corridors[0].curves.items()]
    return (
        Bars("activities (a)", tuple([one.value for one in CLASSES]), shares, "windows right, %"),
        Plot(f"{CORRIDOR_LENGTH:g} m of corridor (b)", tuple(along), "distance, m", "error, m"),
        Plot("error of a stride length (c)", tuple(_distributions(corridors)), "error, m", "CDF", (0.0, 1.0)),
        Plot("turn angle (d)", tuple(by_angle), "turn, degrees", "mean error, degrees"),
        Bars("turn classes (e)", tuple([turn.value for turn in Turn]), (("ours", classes),), "turns right, %"),
        Plot("place by steps (f)", _series(places[0].by_stride), "step", "error, m"),
        Plot("place by turns (g)", _mean_series([one.by_turn for one in places]), "turn", "mean error, m"),
        _by_user(places),
        _floor(places[0]),
    )


def _mean(values: Sequence[float]) -> float:
    return sum(values) / len(values) if values else 0.0


def _distributions(corridors: Sequence[CorridorResults]) -> list[PictureTrack]:
    tracks = []
    for name in ("one foot", "two feet"):
        ordered = sorted([error for one in corridors for error in one.stride_errors[name]])
        points = tuple([(error, (k + 1.0) / len(ordered)) for k, error in enumerate(ordered)])
        tracks.append(PictureTrack(name, points))
    return tracks


def _series(by_name: dict[str, tuple[float, ...]]) -> tuple[PictureTrack, ...]:
    return tuple([PictureTrack(name, tuple([(k + 1.0, e) for k, e in enumerate(of)])) for name, of in by_name.items()])


def _mean_series(of_wearers: Sequence[dict[str, tuple[float, ...]]]) -> tuple[PictureTrack, ...]:
    """Return the mean over wearers by turn, from the second turn on as in the paper, for turns that all made."""
    tracks = []
    for name in of_wearers[0]:
        count = min([len(one[name]) for one in of_wearers])
        points = tuple([(k + 1.0, _mean([one[name][k] for one in of_wearers])) for k in range(1, count)])
        tracks.append(PictureTrack(name, points))
    return tuple(tracks)


def _by_user(places: Sequence[PlaceResults]) -> Bars:
    names = tuple([str(k + 1) for k in range(len(places))])
    values = tuple(
        (name, tuple([_mean(one.scores[f"case study, {name}"].off) for one in places]))
        for name in ("two feet", "one foot")
    )
    return Bars("place by user (h)", names, values, "mean error, m")


def _floor(one: PlaceResults) -> Plot:
    place = one.scores["case study, two feet"]
    walls = tuple(PictureTrack("", (wall.start, wall.end), DrawStyle.TRUTH) for wall in BUILDING.levels[0].walls)
    candidates = PictureTrack("candidates", place.before, DrawStyle.DOTS)
    tracks = (*walls, candidates, PictureTrack("true path", place.path), PictureTrack("place", place.track))
    return Plot("the way of fig. 15", tracks)

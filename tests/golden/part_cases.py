"""Cases of body parts that get what no foot reports: events left out, doubled, guessed, too large, and resets between.

Each part of a recipe gets all that was noted in a walk, alone, so that what it does is seen also where a whole session
would never come to it."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from functools import partial
from typing import Any, ClassVar

from attrs import evolve
from cases import STARTS, building, posed
from changes import LEFT, RIGHT, draws
from corpus import Case, given, kept, plain

from solepath import Calibration, DefectFound, SampleGap, Session, Site, WearerMoved, recipes
from solepath.body.part import LayoutReported, Part
from solepath.body.place.particles import Particles
from solepath.events import Defect
from solepath.foot.view import FootView
from solepath.papers.footstep_tracker.snake import SnakeGame
from solepath.types.attrs import define


@define
class Notes(Part):
    """The last part of a recipe, which notes what reaches it."""

    needs_samples = needs_position = True
    noted: ClassVar[list[Any]] = []
    """Of the class, since a session works with a copy of the part."""

    def feed(self, view: FootView) -> tuple[()]:
        self.noted.append(view)
        return ()

    def receive(self, event: Any) -> tuple[()]:
        self.noted.append(event)
        return ()


def noted(name: str, recipe: str, until: float) -> tuple[Any, ...]:
    """Return the views and events of a walk in their order."""
    Notes.noted.clear()
    usual = recipes.by_name(recipe)
    session = Session(evolve(usual, parts=(*usual.parts, Notes())), **posed())
    session.feed([item for item in given(name) if item.t < until])
    return (*Notes.noted,)


def meddled(event: Any, draw: float) -> list[Any]:
    """Return what becomes of an event; a layout is reported twice."""
    if isinstance(event, LayoutReported):
        return [event, event]
    if draw < 0.1:
        return []
    when, site = {"t": event.t, "known_at": event.known_at}, (LEFT, RIGHT)[int(1e4 * draw) % 2]
    if draw < 0.15:
        return [SampleGap(**when, site=site, duration=40.0 * draw - 3.9), event]
    if draw < 0.16:
        defect = [*Defect][int(1e6 * draw) % len(Defect)]
        return [DefectFound(**when, site=site, defect=defect, what="", spoils=draw < 0.157), event]
    if draw < 0.22:
        return [event, evolve(event, t=event.t + 0.02)]
    changes: dict[str, Any] = {}
    for field in ("inferred", "degraded") if draw < 0.4 else ("length", "displacement", "position", "height_change"):
        value = getattr(event, field, None)
        if isinstance(value, bool):
            changes[field] = not value
        elif isinstance(value, float) and draw > 0.9:
            changes[field] = (1.7 if draw < 0.97 else 0.01) * value
        elif isinstance(value, tuple) and draw > 0.8:
            changes[field] = (value[0] + 2.0 * draw, value[1] - draw, *value[2:])
    if isinstance(event, WearerMoved):
        changes["north"] = (7.0 * draw, 0.02)
    return [evolve(event, **changes)]


def parts(name: str, recipe: str, until: float) -> Iterator[Any]:
    """Yield what each part of a recipe says to a walk that is meddled with, and all numbers that it keeps."""
    stream = noted(name, recipe, until)
    places = (Particles(), SnakeGame()) if name.startswith("building") else ()
    for part in (*recipes.by_name(recipe).parts, *places):
        own, drawn = deepcopy(part).calibrated(Calibration()), draws(17)
        own.ready()
        if hasattr(own, "plan"):
            own.plan = building()
            own.set_out(STARTS[8])
        for k, one in enumerate(stream):
            if isinstance(one, FootView):
                view = copy_of(one, tuple(after for event in one.events for after in meddled(event, next(drawn))))
                yield from map(plain, own.feed(view) if own.needs_samples else ())
            else:
                for event in meddled(one, next(drawn)):
                    yield from map(plain, own.receive(event))
            if k % 250 == 249:
                reset(own, k // 250, one.t)
                yield numbers(own)
        yield from map(plain, own.finish(stream[-1].t))
        yield numbers(own)


def copy_of(view: FootView, events: tuple[Any, ...]) -> FootView:
    return FootView(**{field: getattr(view, field) for field in FootView.__annotations__} | {"events": events})


def reset(part: Part, number: int, t: float) -> None:
    """Do in turn what happens to a part when clocks or devices change."""
    site: Site = (LEFT, RIGHT)[number % 2]
    if number % 3 == 2:
        part.reset(site)
    else:
        part.unsettle(site, t + 1.0 if number % 3 else None)


def numbers(part: Any) -> dict[str, Any]:
    """Return the numbers that a part keeps, and its name."""
    plan = getattr(part, "plan", None)
    if plan is not None:
        part.plan = None
    found = {**kept({"state": plain(part)}), "part": type(part).__name__}
    if plan is not None:
        part.plan = plan
    return found


PARTS_ALONE: tuple[Case, ...] = tuple(
    Case(f"parts of {recipe} that are misled, {name}", partial(parts, name, recipe, until))
    for name, recipe, until in (
        ("ranged", "default", 12.0), ("compass", "default", 16.0),
        ("lifts", "default", 60.0), ("building-8", "default", 12.0),
        ("stroll", "kupt-dfpc", 12.0), ("stroll", "footstep-tracker", 12.0), ("stroll", "shoe-sensing", 10.0),
        ("suit", "walking-modes", 16.0), ("insole", "walking-modes", 14.0),
    )
)  # fmt: skip

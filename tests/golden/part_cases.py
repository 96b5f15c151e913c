"""Cases of body parts that get what no foot reports: events left out, doubled, guessed, too large, and resets between.

Each part of a recipe gets all that was noted in a walk, alone, so that what it does is seen also where a whole session
would never come to it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from copy import deepcopy
from functools import partial
from typing import Any, ClassVar

from attrs import evolve
from cases import STARTS, building, posed
from changes import LEFT, RIGHT, draws
from corpus import Case, given, kept, plain

from solepath import Calibration, DefectFound, Flaw, SampleGap, Session, Site, StrideTaken, WearerMoved, recipes
from solepath.body.part import ClockUnsettled, LayoutReported, Notice, Part, PartInput, StartGiven
from solepath.events import Defect
from solepath.foot.view import FootView
from solepath.papers.footstep_tracker.snake import PrintedSnake
from solepath.place.placing import Particles
from solepath.types.attrs import define


@define
class Notes(Part):
    """The last part of a recipe, which notes what reaches it."""

    needs_samples = needs_position = True
    notices = (LayoutReported, ClockUnsettled)
    noted: ClassVar[list[tuple[Sequence[PartInput], FootView | None]]] = []
    """Of the class, since a session works with a copy of the part."""

    def feed(self, events: Sequence[PartInput], view: FootView | None) -> tuple[()]:
        self.noted.append((events, view))
        return ()


def noted(name: str, recipe: str, until: float) -> tuple[Any, ...]:
    """Return the events and views of a walk in their order."""
    Notes.noted.clear()
    usual = recipes.by_name(recipe)
    session = Session(evolve(usual, parts=(*usual.parts, Notes())), **posed())
    session.feed([item for item in given(name) if item.t < until])
    return (*Notes.noted,)


def meddled(event: Any, draw: float) -> list[Any]:
    """Return what becomes of an event; a notice comes twice."""
    if isinstance(event, Notice):
        return [event, event]
    if draw < 0.1:
        return []
    when, site = {"t": event.t, "known_at": event.known_at}, (LEFT, RIGHT)[int(1e4 * draw) % 2]
    if draw < 0.15:
        return [SampleGap(**when, site=site, duration=40.0 * draw - 3.9, count=0), event]
    if draw < 0.16:
        defect = [*Defect][int(1e6 * draw) % len(Defect)]
        return [DefectFound(**when, site=site, defect=defect, what="", spoils=draw < 0.157), event]
    if draw < 0.22:
        return [event, evolve(event, t=event.t + 0.02)]
    changes: dict[str, Any] = {}
    if draw < 0.4 and isinstance(event, StrideTaken):
        changes["flaws"] = () if event.flaws else (Flaw.GAP,)
    names = ("length", "displacement", "position", "height_change")
    for field in ("inferred", "degraded")[: 2 - isinstance(event, StrideTaken)] if draw < 0.4 else names:
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
    places = (Particles(), PrintedSnake()) if name.startswith("building") else ()
    for part in (*recipes.by_name(recipe).parts, *places):
        own, drawn = deepcopy(part).calibrated(Calibration()), draws(17)
        own.ready()
        if hasattr(own, "plan"):
            own.plan = building()
            own.feed((StartGiven(STARTS[8]),), None)
        t = 0.0
        for k, (events, view) in enumerate(stream):
            t = t if view is None else view.t
            changed = tuple(after for event in events for after in meddled(event, next(drawn)))
            if changed or (view is not None and own.needs_samples):
                yield from map(plain, own.feed(changed, view))
            if k % 250 == 249:
                reset(own, k // 250, t)
                yield numbers(own)
        yield from map(plain, own.finish(t))
        yield numbers(own)


def reset(part: Part, number: int, t: float) -> None:
    """Do in turn what happens to a part when clocks or devices change."""
    site: Site = (LEFT, RIGHT)[number % 2]
    if number % 3 == 2:
        part.reset(site)
    else:
        part.feed((ClockUnsettled(site, t + 1.0 if number % 3 else None),), None)


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
        ("stroll", "default", 12.0), ("compass", "default", 16.0),
        ("lifts", "default", 60.0), ("building-8", "default", 12.0),
        ("stroll", "kupt-dfpc", 12.0), ("stroll", "footstep-tracker", 12.0), ("stroll", "shoe-sensing", 10.0),
        ("suit", "walking-modes", 16.0), ("insole", "walking-modes", 14.0),
    )
)  # fmt: skip

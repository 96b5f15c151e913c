"""`solepath plan FILE`: draws a floor plan with a grid and its ids, lists these, and says what is wrong with it."""

from __future__ import annotations

from argparse import Namespace
from collections.abc import Iterator
from math import degrees
from pathlib import Path
from typing import TYPE_CHECKING

from ..recording import printable
from ..show.output import PLAN_FILE
from .common.closest import unknown
from .common.failure import MAX_LENGTH, Failure
from .common.files import PLAN_KINDS, OutputFile, add_force, check_outputs
from .common.parser import command, option

if TYPE_CHECKING:
    from ..floorplan.plan import FloorPlan, PlanFinding

ID_WIDTH = 32
"""Largest width of the column of the ids, characters."""


def run(options: Namespace) -> int:
    """Draw the plan and print its ids and findings; return 1 if something needs fixing, else 0."""
    from attrs import evolve

    from ..floorplan.findings import find_findings
    from ..floorplan.importers.reading import read_floorplan
    from ..show.tables.plan import PlanPicture

    path: Path = options.file
    if options.out is not None and options.out.suffix.lower() != ".svg":
        raise Failure(f"--out {options.out}: the picture is SVG, so its name must end in .svg")
    plan = read_floorplan(path)
    output = OutputFile(options.out or Path(f"{path.resolve().stem}.svg"), PLAN_KINDS[PLAN_FILE])
    check_outputs(options, [output])
    shown = set(_levels_of(options.levels, plan))
    findings = [one for one in find_findings(plan) if one.level in {"", *shown}]
    drawn = evolve(plan, levels=tuple([level for level in plan.levels if level.id in shown]))
    picture = PlanPicture(drawn, columns=1, ids=True, findings=findings)
    output.replace(lambda to: picture.write(to, plan.name or path.name))
    for line in (*_places(drawn), *_verdict(findings)):
        print(printable(line, MAX_LENGTH))
    print(f"drawn to {printable(str(output.path))}")
    return 1 if any(one.act for one in findings) else 0


def _levels_of(text: str | None, plan: FloorPlan) -> list[str]:
    """Return the ids of the levels of --levels, of all without it; raise Failure for one that there is not."""
    known = [level.id for level in plan.levels]
    names = known if text is None else [text] if text in known else [name.strip() for name in text.split(",")]
    for name in names:
        if name not in known:
            raise Failure(f"--levels: {unknown('level', name, known)}")
    return names


def _places(plan: FloorPlan) -> Iterator[str]:
    """Yield the ids of each level with their places, and the anchor."""
    yield f"{'':16}{'id':{ID_WIDTH}}{'x, m':>10}{'y, m':>10}"
    for level in plan.levels:
        named = "" if level.name in ("", level.id) else f", {level.name}"
        yield f"level {level.id}{named}, {level.elevation:.1f} m"
        for kind, places in plan.places(level.id).items():
            for name, (x, y) in places.items():
                yield f"  {'stairs, lift' if kind == 'connector' else kind:14}{name:{ID_WIDTH}}{x:10.1f}{y:10.1f}"
    if plan.has_degrees:
        longitude, latitude = plan.to_wgs84((0.0, 0.0))
        bearing = degrees(plan.anchor.bearing) if plan.anchor else 0.0
        where = f"x 0, y 0 is at latitude {latitude:.7f}, longitude {longitude:.7f}"
        yield f"{where}; +y points {bearing:.1f} degrees clockwise from north"
    else:
        yield "no longitude and latitude, which .gpx and .kml need"


def _verdict(findings: list[PlanFinding]) -> Iterator[str]:
    """Yield what needs fixing and what is worth knowing, with the numbers in the picture."""
    for title, act in (("needs fixing", True), ("worth knowing", False)):
        if any(one.act == act for one in findings):
            yield f"{title}:"
        for number, one in enumerate(findings, 1):
            if one.act == act:
                yield f"  {number}. {one.text}"
    if not any(one.act for one in findings):
        yield "nothing needs fixing"


add_plan = command(
    "plan",
    "Draw a floor plan with a grid in metres and the ids of its rooms, doors, stairs and lifts; list these ids, any of"
    " which --start of track takes; and say what is wrong with the plan, in sentences. The exit status is 1 if"
    " something needs fixing, and 2 if the file is no floor plan.",
    "solepath plan house.geojson\nsolepath plan venue.zip --levels 1,2 --out venue.svg",
    option("file", metavar="FILE", type=Path, help="GeoJSON, an IMDF archive or OpenStreetMap indoor tagging"),
    option("--levels", metavar="NAMES", help="only these levels, with commas between their ids (default: all)"),
    option("--out", metavar="FILE.svg", type=Path, help="the picture (default: the name of FILE with .svg, here)"),
    add_force,
    run=run,
)

"""For a builder of indoor tracking: two SensorTags in the shoes, a floor plan, and the places where the wearer may be.

    python examples/indoors.py

An emulated wearer takes an elevator down, walks along corridors and leaves by another elevator. The session does not
know the start position.
"""

from math import hypot
from pathlib import Path

from solepath import ActivityChanged, LiftRidden, Placed, Session, Site, read_floorplan, recipes
from solepath.emulate import CC2541, IN_SOLE, case_study, emulate

plan = read_floorplan(Path(__file__).with_name("building.geojson"))
building_walk = case_study()
tag = CC2541(rate=20.0, mounting=IN_SOLE)
walk = emulate(building_walk.route, devices={Site.LEFT_FOOT: tag, Site.RIGHT_FOOT: tag}, seed=2)

session = Session(recipes.by_name("footstep-tracker"), floorplan=plan)
n_candidates = 100
for event in session.feed(walk.packets) + session.finish():
    match event:
        case ActivityChanged(t=t, activity=activity, final=True):
            print(f"{t:5.1f} s  {activity.value}")
        case LiftRidden(t=t, up=up):
            print(f"{t:5.1f} s  out of the lift that went {'up' if up else 'down'}")
        case Placed(t=t, level=level, position=(x, y, _), candidates=candidates):
            if len(candidates) <= n_candidates // 2:
                n_candidates = len(candidates)
                places = "place" if n_candidates == 1 else "places"
                print(f"{t:5.1f} s  {n_candidates} possible {places}, the best on level {level} at ({x:.1f}, {y:.1f})")

place = session.place
if place is not None:
    ((level, x, y),) = building_walk.places(walk.walker, place.t)
    error = hypot(place.position[0] - x, place.position[1] - y)
    print(f"At the end on level {place.level}; truly on level {level}, {error:.1f} m from there.")

"""For who builds a part of their own: two recipes on the same emulated walk, compared with the truth.

    python examples/compare_detectors.py

A recipe names a stance detector and a corrector. The detector estimates whether the foot stands still, and how certain
that is. The corrector uses that to limit the drift of the position. Any detector works with any corrector.
"""

from math import radians

from solepath import Foot, Recipe, Session, StrideTaken, recipes
from solepath.emulate import Radio, Route, emulate
from solepath.foot.navigate.dedrift import LinearDedrift
from solepath.foot.stance.shoe import ShoeDetector

# Walking slowly and fast, with a bend, is difficult for a single threshold.
route = Route().stand(2).walk(15, speed=0.9).turn(radians(180), radius=2).walk(15, speed=1.6).stop(2)
walk = emulate(route, radio=Radio(loss=0.02), seed=4)

# Each session works with its own copies of the parts, so a recipe can be used many times.
textbook = Recipe("SHOE + linear dedrift", detector=ShoeDetector(), corrector=LinearDedrift())

print(f"{'recipe':22}  {'foot':5}  strides  of  length error %  end error m")
for recipe in (recipes.DEFAULT, textbook):
    session = Session(recipe)
    strides = [e for e in session.feed(walk.packets) + session.finish() if isinstance(e, StrideTaken)]
    for foot in Foot:
        found, true = [s for s in strides if s.foot is foot], walk.truth.strides(foot)
        # a found stride matches the true one that ends at about the same time (s)
        pairs = [(f, t) for f in found for t in true if abs(f.t_end - t.t_end) < 0.3]
        error = sum(abs(f.length / t.length - 1) for f, t in pairs) / len(pairs)
        # both positions are relative to the foot's first position and heading
        (x, y, _), end = found[-1].position, walk.truth.pose(foot, walk.truth.duration).position[0]
        distance = ((x - end[0]) ** 2 + (y - end[1]) ** 2) ** 0.5
        print(f"{recipe.name:22}  {foot.value:5}  {len(found):7}  {len(true):2}  {100 * error:14.1f}  {distance:11.2f}")

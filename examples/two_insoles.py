"""For owners of insoles: the noise of their cells is calibrated, and both feet together measure the distance walked.

    python examples/two_insoles.py

Emulated are a short walk for the calibration, and then a walk of 20 m, both at 30 Hz.
"""

from attrs import evolve

from solepath import Session, Site, recipes
from solepath.emulate import Insole, Route, layout, sampled
from solepath.papers import StrideFused
from solepath.papers.kupt_dfpc.noise import pressure_noise

INSOLES = {site: Insole(rate=30.0) for site in (Site.LEFT_FOOT, Site.RIGHT_FOOT)}

# in 20 s of walking each cell is unloaded many times, so its noise can be measured
noise_walk = sampled(Route().stand(2.0).walk(25.0).stop(2.0), insoles=INSOLES, seed=1)
calibration = pressure_noise(noise_walk.samples)
for foot, insole in calibration.insoles.items():
    print(f"{foot.value} insole: {len(insole.noise)} cells, {max(insole.noise):.2f} N at the most in the air")

# a device sends the positions of its cells; with samples of your own the calibration must have them
insoles = {foot: evolve(insole, layout=layout(96, foot)) for foot, insole in calibration.insoles.items()}
session = Session(recipes.by_name("kupt-dfpc"), calibration=evolve(calibration, insoles=insoles))

walk = sampled(Route().stand(2.0).walk(20.0).stop(2.0), insoles=INSOLES, seed=1)
fused = [event for event in session.feed(walk.samples) if isinstance(event, StrideFused)]
for event in fused:
    lengths = f"{event.own_length:.2f} m alone, {event.stride_length:.2f} m by both"
    print(f"{event.t:5.2f} s  {event.foot.value:5}  {lengths}")
print(f"{fused[-1].distance:.2f} m, along the path of the {fused[-1].chosen.value} foot")

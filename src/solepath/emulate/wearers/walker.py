"""A wearer on a route: the motion and the loads of both feet, and their samples without a radio."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ...types import SITE_OF_FOOT, Foot, Layout, Sample
from ..routes.planner import plan
from ..routes.route import Route
from ..sensors.air import STILL_AIR, Air
from ..sensors.magnetic_field import UNDISTURBED, MagneticField
from ..sensors.parts import Imu
from ..sensors.sensors import instants, measure_imu, samples_of
from .curves import Array
from .gait import Wearer
from .limbs import Body, body
from .load import Loads
from .motion import Kinematics
from .shoe import IN_SOLE, Mounting
from .strides import foot_motions
from .truth import Truth, activities, foot_truth


class Walker:
    """A wearer on a route, without devices; the same seed gives the same walk.

    `field` is the magnetic field in the building, and `air` has the changes of its air pressure."""

    def __init__(
        self,
        route: Route,
        wearer: Wearer | None = None,
        seed: int = 1,
        field: MagneticField = UNDISTURBED,
        air: Air = STILL_AIR,
    ) -> None:
        self.route = route
        self.field = field
        self.air = air
        self.wearer = wearer or Wearer()
        self.seed = seed
        self.plan = plan(route, self.wearer, np.random.default_rng([seed, 0]))
        sway_rng, contact_rng = np.random.default_rng([seed, 6]), np.random.default_rng([seed, 10])
        self.motions = foot_motions(self.plan, self.wearer, sway_rng, contact_rng)
        self.loads = Loads(self.plan, self.wearer, np.random.default_rng([seed, 4]))

    @cached_property
    def body(self) -> Body:
        """Motion of the body above the feet."""
        wearer = self.wearer
        return body(self.plan, self.motions, self.loads, wearer.shoe, wearer.centre_height, wearer.limbs)

    @property
    def duration(self) -> float:
        """Duration of the walk, s."""
        return self.plan.duration

    def truth(self, mountings: dict[Foot, Mounting] | None = None) -> Truth:
        """Return the ground truth for sensors with these mountings; a foot without one has its sensor in the sole."""
        sensor_mountings = {foot: (mountings or {}).get(foot, IN_SOLE) for foot in Foot}
        feet = {foot: foot_truth(foot, self.plan, self.motions[foot], sensor_mountings[foot]) for foot in Foot}
        plan = self.plan
        return Truth(plan.duration, feet, activities(plan), plan.climbs, plan.rides, plan.escalators, plan)

    def kinematics(self, foot: Foot, t: Array, mounting: Mounting = IN_SOLE) -> Kinematics:
        """Return the exact motion of a foot's sensor at times `t`, s."""
        return self.motions[foot].at(t, mounting)

    def cell_loads(self, layout: Layout, t: Array) -> Array:
        """Return the true load on each cell at times `t`, s, as an array (times, cells), N."""
        return self.loads.cells(layout, self.wearer.shoe.width, self.motions[layout.foot], t)

    def samples(
        self,
        foot: Foot,
        rate: float,
        errors: Imu | None = None,
        *,
        mounting: Mounting = IN_SOLE,
        layout: Layout | None = None,
    ) -> list[Sample]:
        """Return samples of one foot on the true clock, at k / rate s, without packets and radio.

        Without `errors` the values are exact. With `errors` they have the errors, the noise and the low pass of that
        IMU, with a bandwidth of at most half of the rate; they are neither saturated nor rounded. With a `layout` of
        this foot every sample also has the exact loads of its cells, N."""
        sample_count = int(self.duration * rate) + 1
        if errors is None:
            t = np.arange(sample_count) / rate
            exact = self.kinematics(foot, t, mounting)
            acc, gyro = exact.force, exact.rate
        else:
            sampling = instants(0.0, 1.0 / rate, sample_count)
            t, rng = sampling.times, np.random.default_rng([self.seed, 1, list(Foot).index(foot)])
            acc, gyro = measure_imu(
                self.kinematics(foot, sampling.fine_times, mounting), sampling, errors, rng, 0.5 * rate
            )
        return samples_of(SITE_OF_FOOT[foot], t, acc, gyro, None if layout is None else self.cell_loads(layout, t))

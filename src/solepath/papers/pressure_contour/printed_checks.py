"""Checks of a recipe that misses stances as printed: strides that cannot be right are its own fault, not the data's."""

from __future__ import annotations

from ...body.checks.motion import PossibleMotion
from ...body.checks.sensors import SensorChecks
from ...body.part import Inputs, Outputs
from ...events import DefectFound, Limitation, StrideTaken
from ...foot.view import FootView
from ...types.attrs import stateful
from .contour_stance import PRINTED_LIMIT


@stateful
class SampleChecks(SensorChecks):
    """`SensorChecks` by samples alone: it does not compare contacts of the insole with strides that were missed."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        return SensorChecks.feed(self, [one for one in events if not isinstance(one, StrideTaken)], view)


@stateful
class PrintedMotion(PossibleMotion):
    """`PossibleMotion` that says of an impossible stride what the recipe missed, as a Limitation."""

    def feed(self, events: Inputs, view: FootView | None) -> Outputs:
        return [
            Limitation(t=one.t, known_at=one.known_at, site=one.site, what=f"a stride cannot be right: {PRINTED_LIMIT}")
            if isinstance(one, DefectFound)
            else one
            for one in PossibleMotion.feed(self, events, view)
        ]

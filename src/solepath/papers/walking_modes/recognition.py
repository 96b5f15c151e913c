"""Walking mode during a walk, from strides and contacts of both feet and the body's weight.

After Gong et al. 2023 (Sensors 23, 5417), section 3.3. A contact is the time from a foot's touchdown until its cells
are unloaded. The paper leaves open when the mode is known; the compensation is needed at a touchdown.

As printed, by table 2 (mode.py), the mode of a contact is certain only at its end. At a touchdown the other foot has
borne the whole weight, so the mode of the step that ends is that of the other foot's contact so far or, if this has no
mode yet, the latest one of that foot.

Ours is the curvature of the path, which is what a bend is, because insoles do not agree on where the load moves in one:
under the heel it moves outward, under the metatarsal heads inward (Turcato et al. 2015, J NeuroEng Rehabil 12:4), and
from step to step by some millimetres anyway. In a bend of radius r every foot turns from one stance to its next by the
angle by which the path turns, so the angle, from the foot's own gyroscope, over the length of the stride is 1 / r. The
mode of the step that ends is that of the mean curvature of the newest stride of either foot, and the mode of a contact
that of the stride that ended in it and the other foot's newest one.

The first step after standing is taken for a straight one. So is every step if neither the feet's turns nor the cells
show a mode. Two readings of table 2: a foot in contact for more than 1.5 s takes no step, so its `Step` counts as less
than L_w; and "no others trigger" is asked of the foot in contact only. Numbers without a source were chosen by hand."""

from __future__ import annotations

from collections.abc import Sequence
from math import fsum

from ...events import StrideTaken
from ...foot.view import FootView
from ...types import OTHER, Floats, Foot, Layout, PerFoot, Phase, Quat, WalkingMode, per_foot
from ...types.attrs import field, state, stateful
from ...types.vector import heading_turned
from .mode import LEAST_STEP_LENGTH, STANDING_WEIGHT, decide, regions
from .settings import ModesSettings
from .touchdown import FootState, PressureTouchdown

WIDE_RADIUS, TIGHT_RADIUS = 4.0, 2.0
"""Radii of the paper's bends, m (section 3.3)."""
LEAST_CURVATURE = 0.5 / WIDE_RADIUS
"""Curvature from which the path is a bend, 1/m: half that of the wide bend."""
LEAST_TIGHT_CURVATURE = 0.5 * (1.0 / WIDE_RADIUS + 1.0 / TIGHT_RADIUS)
"""Curvature from which the bend is tight, 1/m: halfway between the two."""
LONGEST_CONTACT = 1.5
"""Longest contact in walking, s: even at 0.5 m/s a stance is shorter."""
MEAN_SAMPLES = 2000
"""Number of samples over which the mean load of both feet is a plain mean; later samples have weight 1/2000 each."""
LEAST_MEAN = 1e-9
"""Mean load of a cell below which the insole counts as unloaded, in any unit."""


def mode_of_curvature(curvature: float) -> WalkingMode:
    """Return the mode of walking on a path of this curvature, 1/m, left positive."""
    if abs(curvature) < LEAST_CURVATURE:
        return WalkingMode.STRAIGHT
    radius = "WIDE" if abs(curvature) < LEAST_TIGHT_CURVATURE else "TIGHT"
    return WalkingMode[f"{'LEFT' if curvature > 0.0 else 'RIGHT'}_{radius}"]


@stateful
class SoleContact:
    """The present or last contact of one foot, its mode, and how far the foot turned in its stride."""

    step: float = 0.0
    """Length of the stride that ended with the foot's last touchdown, m."""
    mode: WalkingMode | None = None
    """Latest mode of the foot's contacts; None before the first."""
    pressed: bool = False
    """Flag: the foot is in contact now."""
    in_newtons: bool = True
    """Flag: the foot's samples may be in newtons."""
    last_load: float = 0.0
    """Load on the whole insole in the newest sample, unit of the samples."""
    t_start: float | None = None
    """Start of the contact, s."""
    too_long: bool = False
    """Flag: the contact has lasted longer than any in walking."""
    layout: Layout | None = None
    """Layout from which the regions were computed."""
    region_cells: dict[str, tuple[int, ...]] = state(factory=dict)
    """Indices of the cells, by region."""
    sums: dict[str, float] = state(factory=dict)
    """Sum of the loads in this contact, by region, unit of the samples."""
    total: float = 0.0
    """Sum of the loads of all cells in this contact, unit of the samples."""
    forward: float = 0.0
    """Load of F1 minus load of F2 in the last contact, as multiples of the mean cell's load."""
    flat: Quat | None = None
    """Attitude of the sensor while the foot was last stationary, navigation frame; None before."""
    newest: Quat | None = None
    """Newest attitude of the sensor, navigation frame; None while the foot is stationary."""
    stride_turn: float | None = None
    """Turn in the last complete stride, rad, left positive; None before the first."""
    curvature: float | None = None
    """Curvature of the path in the foot's newest stride, 1/m, left positive; None if unknown or in standing."""

    @property
    def blind(self) -> bool:
        """Flag: the cells do not show left and right."""
        return self.layout is not None and not self.region_cells

    def set_layout(self, layout: Layout | None) -> None:
        """Set the insole's layout, if it is known; without one the regions have no loads."""
        if layout is None or layout is self.layout:
            return
        if layout != self.layout:
            self.region_cells = regions(layout)
            self.sums, self.total = dict.fromkeys(self.region_cells, 0.0), 0.0
        self.layout = layout  # so that the next comparison is one of identity, which is faster

    def start_contact(self, t: float) -> None:
        """Start a contact at `t` s."""
        self.t_start, self.total, self.too_long = t, 0.0, False
        self.sums = dict.fromkeys(self.region_cells, 0.0)

    def add(self, cells: Floats, total: float) -> None:
        """Add one sample of the foot on the ground."""
        if self.layout is None or len(cells) != len(self.layout.cells):
            return
        self.total += total
        for name, indices in self.region_cells.items():
            for k in indices:
                self.sums[name] += cells[k]

    def shares(self) -> dict[str, float] | None:
        """Return the mean load of each region's cells over that of all cells; None without load or layout."""
        if self.layout is None or not self.sums or (mean := self.total / len(self.layout.cells)) < LEAST_MEAN:
            return None
        return {name: max(total, 0.0) / len(self.region_cells[name]) / mean for name, total in self.sums.items()}

    def turn(self) -> float | None:
        """Return the turn since the foot was last stationary or, if it is so now, that of its last stride, rad."""
        if self.newest is None:
            return self.stride_turn
        return None if self.flat is None else heading_turned(self.flat, self.newest)


@stateful
class Recognition:
    """Recognises the walking mode from all samples of the cells and all touchdowns."""

    settings: ModesSettings = field(default=ModesSettings())
    soles: PerFoot[SoleContact] = state(factory=lambda: per_foot(SoleContact))
    """Contact by foot."""
    contact_detector: PressureTouchdown = state(factory=PressureTouchdown)
    """Detector of the start and the end of a contact."""
    mean_load: float = 0.0
    """Mean of the sum of both feet's loads, unit of the samples."""
    load_count: int = 0
    """Number of samples in `mean_load`, at most `MEAN_SAMPLES`."""

    def add_view(self, view: FootView, events: Sequence[object]) -> None:
        """Add a sample of a foot, which may turn, with its events."""
        if not view.levelled:
            return
        sole = self.soles[view.foot]
        for event in events:
            if isinstance(event, StrideTaken):
                sole.stride_turn = event.heading_change
        if view.phase is Phase.STATIONARY:
            sole.flat, sole.newest = view.attitude, None
        else:
            sole.newest = view.attitude

    def add_pressure(
        self, foot: Foot, state: FootState, cells: Floats, layout: Layout | None, t: float, both_feet: bool
    ) -> WalkingMode | None:
        """Add a sample of the cells of `foot` at `t` s; return the foot's mode if it has changed, otherwise None.

        `state` has the sample's pressure, `layout` is None if it is unknown, and `both_feet` is true if samples of the
        other foot have come, too."""
        sole = self.soles[foot]
        sole.in_newtons = state.highest_pressure is None
        sole.set_layout(layout)
        sole.last_load = fsum(cells)
        was_pressed, sole.pressed = sole.pressed, self.contact_detector.is_down(state, sole.pressed)
        both_loads = sole.last_load + self.soles[OTHER[foot]].last_load
        if both_feet:
            self.load_count = min(self.load_count + 1, MEAN_SAMPLES)
            self.mean_load += (both_loads - self.mean_load) / self.load_count
        mode: WalkingMode | None = None
        if sole.pressed:
            if not was_pressed:
                sole.start_contact(t)
            sole.add(cells, sole.last_load)
            if not sole.too_long and sole.t_start is not None and t - sole.t_start > LONGEST_CONTACT:
                sole.too_long = True
                mode = self._standing(both_loads)
        elif was_pressed and not sole.too_long:
            mode = self._mode_of_ended(foot, both_loads)
        if mode is None or mode is sole.mode:
            return None
        sole.mode = mode
        return mode

    def reset(self, foot: Foot) -> None:
        """Discard the times of a foot's contacts, because its clock restarts."""
        sole = self.soles[foot]
        sole.t_start = sole.flat = sole.newest = None

    def is_blind(self, foot: Foot) -> bool:
        """Return whether the mode is asked of cells that do not show left and right: they show only standing."""
        return self.settings.as_printed and self.soles[foot].blind

    def add_touchdown(self, foot: Foot, step: float) -> None:
        """Add a touchdown of the foot at a distance of `step` m from its previous one."""
        sole = self.soles[foot]
        sole.step = step
        turn = sole.turn()
        sole.curvature = None if turn is None or step < LEAST_STEP_LENGTH else turn / step

    def mode_at_touchdown(self, foot: Foot) -> WalkingMode:
        """Return the mode of the step that ends as `foot` comes down."""
        if not self.settings.as_printed:
            return self._mode_by_turn(foot) or WalkingMode.STRAIGHT
        reference = self.soles[OTHER[foot]]
        mode = self._mode_so_far(OTHER[foot]) if reference.pressed and not reference.too_long else None
        mode = mode or reference.mode
        return WalkingMode.STRAIGHT if mode is None or mode is WalkingMode.STANDING else mode

    def _standing(self, both_loads: float) -> WalkingMode | None:
        """Return STANDING by table 2 if the wearer's weight is on the feet; `both_loads` is the sum of their loads."""
        weight = self.settings.weight if self.soles[Foot.LEFT].in_newtons else None
        weight = self.mean_load if weight is None else weight
        return WalkingMode.STANDING if both_loads > STANDING_WEIGHT * weight else None

    def _mode_of_ended(self, foot: Foot, both_loads: float) -> WalkingMode | None:
        """Return the mode of a contact that has ended, and keep its `forward`."""
        sole = self.soles[foot]
        if sole.step < LEAST_STEP_LENGTH:
            return self._standing(both_loads)
        if not self.settings.as_printed:
            return self._mode_by_turn(foot)
        shares = sole.shares()
        if shares is not None:
            sole.forward = shares["F1"] - shares["F2"]
        return self._mode_so_far(foot)

    def _mode_by_turn(self, foot: Foot) -> WalkingMode | None:
        """Return the mode by the mean curvature of the newest stride of `foot` and of the other foot, if it walks."""
        curvature, other = self.soles[foot].curvature, self.soles[OTHER[foot]].curvature
        if curvature is None:
            return None
        return mode_of_curvature(curvature if other is None else 0.5 * (curvature + other))

    def _mode_so_far(self, foot: Foot) -> WalkingMode | None:
        """Return the mode of a foot's contact so far, by table 2."""
        sole, other = self.soles[foot], self.soles[OTHER[foot]]
        shares = sole.shares()
        if shares is None:
            return None
        return decide(foot, sole.step, shares, shares["F1"] - shares["F2"] + other.forward)

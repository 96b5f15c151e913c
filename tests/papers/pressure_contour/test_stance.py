"""Zero velocity by heel contours and by the gyroscope: by hand, and against the truth of emulated walks."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from math import inf, pi, radians, sin

import numpy as np
import pytest
from walks import of, run_session

from solepath import LayoutKnown, Limitation, StrideTaken
from solepath.emulate.routes.route import Route
from solepath.emulate.sensors.insole_device import Insole
from solepath.emulate.sensors.insoles import layout
from solepath.emulate.walk import EmulatedWalk, emulate
from solepath.foot.pressure.insole import InsoleLoads as Cells
from solepath.foot.stance.stance import Load
from solepath.link.decoder import Decoder
from solepath.papers.pressure_contour.contour_stance import ContourVelocity, GyroscopeMagnitude
from solepath.papers.pressure_contour.recipe import PRESSURE_CONTOUR
from solepath.types import Cell, Foot, Layout, Phase, Sample, Site
from solepath.types.vector import GRAVITY, ZERO
from solepath_lab.emulated.boot import boot

LEFT = Foot.LEFT
LAP = Route().stand(2.0).walk(9.0, 1.2).turn(radians(90), radius=1.5).walk(6.0).stop(2.0)


@cache
def walk_with(device: Insole) -> EmulatedWalk:
    return emulate(LAP, devices={Site.LEFT_FOOT: device}, seed=107)


DEVICES = {"96 cells": Insole(), "35 cells": Insole(cells=35), "24 cells under the heel": boot(LEFT)}


def standing_flags(cycles: int, low: float, high: float) -> list[bool]:
    """Return whether a foot stands, at 100 Hz, whose angular rate is `low` in each stance and up to `high` in swing."""
    detector, flags = GyroscopeMagnitude(), []
    rates = [low] * 40 + [low + (high - low) * sin(pi * k / 40) for k in range(40)] + [low] * 20
    for k, rate in enumerate(rates * cycles):
        stance = detector.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, rate, 0.0), None)
        assert stance.v_ref == ZERO
        flags.append(stance.sigma < inf)
    return flags


@pytest.mark.parametrize(("low", "high"), [(0.02, 5.0), (0.5, 5.0)])
def test_a_foot_stands_where_it_turns_slowly_for_its_own_gait_cycle(low: float, high: float) -> None:
    """A tied shoe hardly turns in stance; a loose one turns at half a radian a second."""
    last = standing_flags(4, low, high)[-100:]
    assert all(last[10:39]) and not any(last[50:70]) and all(last[90:])


def evidence(detector: ContourVelocity, device: Insole) -> tuple[list[float], list[bool]]:
    """Return the times of the samples with a load, and flags: the foot stands by the contours."""
    cells, decoder = Cells(), Decoder(Site.LEFT_FOOT)
    found: list[tuple[float, bool]] = []
    for packet in walk_with(device).packets:
        for item in decoder.feed(packet):
            if isinstance(item, LayoutKnown):
                cells.set_layout(item.layout)
                detector.set_layout(item.layout)
            elif isinstance(item, Sample) and item.acc is not None and item.gyro is not None:
                load = cells.update(item.t, item.pressure or ())
                detector.update(item.t, 0.01, item.acc, item.gyro, load)
                if load is not None:
                    found.append((item.t, detector.standing))
    return [t for t, _ in found], [still for _, still in found]


@pytest.mark.parametrize("name", list(DEVICES))
def test_contours_rest_only_while_the_foot_truly_stands(name: str) -> None:
    walk = walk_with(DEVICES[name])
    t, still = evidence(ContourVelocity(), DEVICES[name])
    stands = np.array([phase is Phase.STATIONARY for phase in walk.truth.feet[LEFT].phases(np.array(t))])
    assert np.mean(~stands[np.array(still)]) <= 0.01


def heel_load(share: float, *, airborne: bool = False, cells: tuple[float, ...] = ()) -> Load:
    return Load(share, share, 0.0, airborne, cells)


def fed(
    detector: ContourVelocity, loads: Sequence[Load | None], rate: float = 2.0, start: float = 0.0
) -> list[Phase | None]:
    return [
        detector.update(start + 0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, rate, 0.0), load).hint
        for k, load in enumerate(loads)
    ]


CELLS = layout(96, LEFT)


def loads_at(x: float = 0.045) -> tuple[float, ...]:
    """Return the loads of a round area of pressure around (x, 0), 400 N in all, plus those of a laced shoe."""
    raw = [cell.area * max(0.0, 1.0 - ((cell.x - x) ** 2 + cell.y**2) / 0.04**2) for cell in CELLS.cells]
    return tuple([0.5 + 400.0 * value / sum(raw) for value in raw])


IN_AIR = heel_load(0.0, airborne=True, cells=(0.5,) * 96)
AT_REST = heel_load(0.8, cells=loads_at())


def detector_with_layout() -> ContourVelocity:
    """Return a detector with a layout."""
    detector = ContourVelocity()
    detector.set_layout(CELLS)
    return detector


def test_a_heel_at_rest_is_a_standing_foot_until_it_is_unloaded() -> None:
    hints = fed(detector_with_layout(), [*[IN_AIR] * 10, *[AT_REST] * 10, IN_AIR])
    assert hints[:10] == [Phase.SWING] * 10
    assert hints[10:15] == [None] * 5, "contours are compared over 50 ms"
    assert hints[15:20] == [Phase.STATIONARY] * 5
    assert hints[20] is Phase.SWING


def test_a_heel_that_rolls_at_a_few_centimetres_a_second_does_not_stand() -> None:
    rolling = [heel_load(0.8, cells=loads_at(0.040 + 0.0005 * k)) for k in range(15)]  # 5 cm/s
    assert Phase.STATIONARY not in fed(detector_with_layout(), [*[IN_AIR] * 10, *rolling])


def test_too_few_cells_are_reported_once_and_the_walk_continues_by_the_gyroscope() -> None:
    sparse = Layout(
        2, LEFT, (Cell(0.03, 0.0), Cell(0.05, 0.01), Cell(0.20, 0.0), Cell(0.21, 0.02)), 0.285, 0.05, 204.75
    )
    walk = emulate(LAP, devices={Site.LEFT_FOOT: Insole(cells=sparse)}, seed=107)
    events = run_session(walk.packets, PRESSURE_CONTOUR)
    assert [one.what for one in of(Limitation, events)] == [
        "2 pressure cells under the heel have no contour, 4 are the fewest; the gyroscope says when the foot stands"
    ]
    assert len(of(StrideTaken, events)) >= len(walk.truth.strides(LEFT)) - 1

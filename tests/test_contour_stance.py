"""Zero velocity by heel contours and by the gyroscope: by hand, and against the truth of emulated walks."""

from __future__ import annotations

from functools import cache
from math import inf, radians

import numpy as np
import pytest

from solepath import LayoutKnown, Limitation, Session, StepTaken, machine
from solepath.foot.contour_stance import ContourVelocity, GyroscopeMagnitude
from solepath.foot.pressure import Insole as Cells
from solepath.foot.stance import Load
from solepath.link.decoder import Decoder
from solepath.recipes import GYROSCOPE, PRESSURE_CONTOUR, Recipe
from solepath.sim.insole_device import Insole, boot
from solepath.sim.insoles import layout
from solepath.sim.parts import INERTIACUBE3
from solepath.sim.route import Route
from solepath.sim.walk import EmulatedWalk, emulate
from solepath.types import Cell, Foot, Layout, Phase, Sample, Site
from solepath.vector import GRAVITY, ZERO
from walks import of

LEFT = Foot.LEFT
LAP = Route().stand(2.0).walk(9.0, 1.2).turn(radians(90), radius=1.5).walk(6.0).stop(2.0)


@cache
def walked(device: Insole) -> EmulatedWalk:
    return emulate(LAP, devices={Site.LEFT_FOOT: device}, seed=107)


DEVICES = {"96 cells": Insole(), "35 cells": Insole(cells=35), "24 cells under the heel": boot(LEFT)}


# --- the gyroscope ----------------------------------------------------------------------------------------------------


def rates(detector: GyroscopeMagnitude, *values: float) -> list[bool]:
    stances = [
        detector.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, value, 0.0), None) for k, value in enumerate(values)
    ]
    assert all(stance.v_ref == ZERO for stance in stances)
    assert [stance.statistic for stance in stances] == [abs(value) for value in values]
    return [stance.hint is Phase.STATIONARY for stance in stances]


def test_a_rate_that_stays_low_is_a_standing_foot() -> None:
    assert rates(GyroscopeMagnitude(), 3.0, 0.1, 0.1, 0.1, 0.1) == [False, False, False, False, True]


def test_between_its_thresholds_it_says_what_it_said() -> None:
    assert rates(GyroscopeMagnitude(lasting=0.0), 0.3, 0.2, 0.3, 0.45, 0.3, 0.2) == [
        False,
        True,
        True,
        False,
        False,
        True,
    ]


def test_a_calm_moment_within_a_swing_is_too_short() -> None:
    assert not any(rates(GyroscopeMagnitude(), 2.0, 0.2, 0.1, 0.1, 1.0, 2.0))


# --- the contours -----------------------------------------------------------------------------------------------------


def evidence(detector: ContourVelocity, device: Insole) -> tuple[list[float], list[bool]]:
    """Times of the samples with a load, and whether the detector's own contours say that the foot stands."""
    cells, decoder = Cells(), Decoder(Site.LEFT_FOOT)
    found: list[tuple[float, bool]] = []
    for packet in walked(device).packets:
        for item in decoder.feed(packet):
            if isinstance(item, LayoutKnown):
                cells.wear(item.layout)
                detector.wear(item.layout)
            elif isinstance(item, Sample) and item.acc is not None and item.gyro is not None:
                load = cells.update(item.t, item.pressure or ())
                detector.update(item.t, 0.01, item.acc, item.gyro, load)
                if load is not None:
                    found.append((item.t, detector.still))
    return [t for t, _ in found], [still for _, still in found]


@pytest.mark.parametrize("name", list(DEVICES))
def test_contours_rest_only_while_the_foot_truly_stands(name: str) -> None:
    walk = walked(DEVICES[name])
    t, still = evidence(ContourVelocity(), DEVICES[name])
    stands = np.array([phase is Phase.STATIONARY for phase in walk.truth.feet[LEFT].phases(np.array(t))])
    assert np.mean(~stands[np.array(still)]) <= 0.01


@pytest.mark.parametrize("name", list(DEVICES))
def test_they_rest_in_nearly_every_stance(name: str) -> None:
    walk = walked(DEVICES[name])
    t, still = (np.array(found) for found in evidence(ContourVelocity(), DEVICES[name]))
    strides = walk.walker.plan.strides[LEFT]
    stances = [(one.foot_flat, after.heel_off) for one, after in zip(strides[1:], strides[2:], strict=False)]
    rested = [bool(still[(t > begin) & (t < end)].any()) for begin, end in stances]
    assert len(stances) >= 8 and sum(rested) >= len(rested) - 1


def heel(share: float, *, airborne: bool = False, cells: tuple[float, ...] = ()) -> Load:
    return Load(share, share, 0.0, share, airborne, cells)


def fed(detector: ContourVelocity, loads: list[Load | None], rate: float = 2.0) -> list[Phase | None]:
    return [
        detector.update(0.01 * k, 0.01, (0.0, 0.0, GRAVITY), (0.0, rate, 0.0), load).hint
        for k, load in enumerate(loads)
    ]


def pressed(where: Layout, x: float = 0.045, newtons: float = 400.0) -> tuple[float, ...]:
    """A round patch of pressure about (x, 0), on a background that a laced shoe makes."""
    raw = [cell.area * max(0.0, 1.0 - ((cell.x - x) ** 2 + cell.y**2) / 0.04**2) for cell in where.cells]
    return tuple([0.5 + newtons * value / sum(raw) for value in raw])


def test_a_heel_that_rests_is_a_standing_foot_until_it_is_unloaded() -> None:
    where = layout(96, LEFT)
    detector = ContourVelocity()
    detector.wear(where)
    air = heel(0.0, airborne=True, cells=(0.5,) * 96)
    rests = heel(0.8, cells=pressed(where))
    hints = fed(detector, [*[air] * 10, *[rests] * 10, air])
    assert hints[:10] == [Phase.SWING] * 10
    assert hints[10:15] == [None] * 5, "contours are compared over 50 ms"
    assert hints[15:20] == [Phase.STATIONARY] * 5
    assert hints[20] is Phase.SWING


def test_a_heel_that_rolls_at_a_few_centimetres_a_second_does_not_stand() -> None:
    where = layout(96, LEFT)
    detector = ContourVelocity()
    detector.wear(where)
    air = heel(0.0, airborne=True, cells=(0.5,) * 96)
    rolling = [heel(0.8, cells=pressed(where, 0.040 + 0.0005 * k)) for k in range(15)]  # 5 cm/s
    assert Phase.STATIONARY not in fed(detector, [*[air] * 10, *rolling])


def test_a_heel_without_contours_is_left_to_the_gyroscope_after_a_while() -> None:
    where = layout(96, LEFT)
    detector = ContourVelocity()
    detector.wear(where)
    on_edge = heel(0.8, cells=tuple([100.0 if cell.y > 0.02 else 0.0 for cell in where.cells]))
    hints = fed(detector, [on_edge] * 30, rate=0.0)
    assert hints[:20] == [None] * 20 and hints[21:] == [Phase.STATIONARY] * 9


def test_as_long_as_the_load_is_not_known_the_gyroscope_speaks() -> None:
    detector = ContourVelocity()
    detector.wear(layout(96, LEFT))
    assert fed(detector, [None] * 6, rate=0.0)[-1] is Phase.STATIONARY
    assert fed(detector, [None] * 6, rate=1.0)[-1] is None


def test_cells_of_another_number_than_the_layouts_are_left_to_the_gyroscope() -> None:
    detector = ContourVelocity()
    detector.wear(layout(96, LEFT))
    assert fed(detector, [heel(0.8, cells=(1.0,) * 24)] * 6, rate=0.0)[-1] is Phase.STATIONARY


# --- in a session -----------------------------------------------------------------------------------------------------


def test_too_few_cells_are_said_once_and_the_walk_goes_on_by_the_gyroscope() -> None:
    sparse = Layout(
        2, LEFT, (Cell(0.03, 0.0), Cell(0.05, 0.01), Cell(0.20, 0.0), Cell(0.21, 0.02)), 0.285, 0.05, 204.75
    )
    walk = emulate(LAP, devices={Site.LEFT_FOOT: Insole(cells=sparse)}, seed=107)
    session = Session(PRESSURE_CONTOUR)
    events = session.feed(walk.packets) + session.finish()
    said = [one.what for one in of(Limitation, events)]
    assert said == [
        "2 pressure cells under the heel have no contour, 4 are the fewest; the gyroscope says when the foot stands"
    ]
    assert len(of(StepTaken, events)) >= len(walk.truth.steps(LEFT)) - 1


@pytest.mark.parametrize("recipe", [PRESSURE_CONTOUR, GYROSCOPE], ids=["contours", "gyroscope"])
def test_all_steps_are_found_and_a_square_ends_where_it_began(recipe: Recipe) -> None:
    side = Route().stand(2.0)
    for _ in range(4):
        side = side.walk(8.0, 1.2).turn(radians(90), radius=1.0)
    device = Insole(quaternion=True, attitude=INERTIACUBE3)
    walk = emulate(side.stop(2.0), devices={Site.LEFT_FOOT: device}, seed=108)
    session = Session(recipe)
    events = session.feed(walk.packets) + session.finish()
    assert len(of(StepTaken, events)) == len(walk.truth.steps(LEFT))
    x, y, _ = session.feet[LEFT].position
    true = walk.truth.pose(LEFT, walk.truth.duration).position[0]
    assert np.hypot(x, y) - np.hypot(true[0], true[1]) < 0.6


def test_it_goes_on_from_a_snapshot() -> None:
    packets = walked(DEVICES["96 cells"]).packets
    half = len(packets) // 2
    ours = Session(PRESSURE_CONTOUR)
    ours.feed(packets[:half])
    theirs = Session.restore(ours.snapshot())
    assert ours.feed(packets[half:]) + ours.finish() == theirs.feed(packets[half:]) + theirs.finish()
    one = ContourVelocity()
    one.wear(layout(24, LEFT))
    assert machine.load(ContourVelocity, machine.save(one)) == one


def test_evidence_that_says_nothing_is_infinitely_uncertain() -> None:
    stance = GyroscopeMagnitude().update(0.0, 0.01, (0.0, 0.0, GRAVITY), (5.0, 0.0, 0.0), None)
    assert stance.sigma == inf and stance.hint is None

"""Cases for what the other cases do not meet of the parts after papers: rides, devices, limbs, calibrations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from attrs import evolve
from cases import STARTS, calibrated, half, of, planned, sole, walked
from changes import LEFT, RIGHT, Change, added, each, later, ordered, set_back, turned, without
from corpus import Call, Case, Item, given

from solepath import Calibration, Foot, Sample, Site
from solepath.calibration import CalibrationError
from solepath.papers import WalkingMode
from solepath.papers.walking_modes.calibrate import ModeMark, mean_errors, step_errors, touchdowns
from solepath.papers.walking_modes.limbs.standing import check_standing
from solepath.recording.decoded import DecodedRecording

ABOVE_THE_ANKLES = tuple(site for site in Site if site.foot is None)
G = 9.80665


# --- rides ------------------------------------------------------------------------------------------------------------

RIDES = (
    # from, to, s, and acceleration upwards, m/s^2: a ride up, one down, one that nobody sees the end of
    (6.0, 7.5, 0.8), (14.0, 15.5, -0.8), (22.0, 23.5, -0.8), (30.0, 31.5, 0.8), (40.0, 41.5, 0.8),
    # one that the wearer walks away from, a pulse without end, one that ends as the wearer walks, one that rebounds
    (130.0, 131.5, 0.8), (150.0, 160.0, 0.7), (180.0, 181.5, -0.8), (188.0, 192.0, 0.9), (210.0, 211.5, 0.8),
    (220.0, 221.5, -0.9), (222.0, 223.0, 0.6),
    # and a wearer who begins in a lift that already moves
    (255.0, 263.0, -0.8), (266.0, 267.5, 0.8),
)  # fmt: skip
WALKS = ((136.0, 144.0), (189.5, 196.0), (236.0, 242.0))
"""From, to, s: the feet are shaken up and down."""
SILENCE = (226.0, 234.0)


def rides(rate: float = 20.0, until: float = 275.0) -> Iterator[Item]:
    """Yield the samples of a wearer who stands, rides in lifts and walks between; the right foot is silent at times."""
    for k in range(round(until * rate)):
        t = k / rate
        if t == 252.0:
            yield Call("bind", (LEFT, "another"))
        up = sum(acc for start, end, acc in RIDES if start <= t < end)
        if any(start <= t < end for start, end in WALKS):
            up += (6.0, 2.0, -5.0, -3.0)[k % 4]
        if SILENCE[0] <= t < SILENCE[1]:
            continue
        for site in (LEFT, RIGHT):
            if site is LEFT or not 20.0 <= t < 60.0:
                yield Sample(t, site, acc=(0.01 * (k % 3), 0.0, G + up), gyro=(0.0, 0.001 * (k % 2), 0.0))


# --- exchanged devices ------------------------------------------------------------------------------------------------


def exchanged(items: tuple[Any, ...], at: float, shift: float, silent: Site | None = None) -> Iterator[Item]:
    """Give the left foot another device at `at`, s, whose clock is `shift` ahead; a site falls silent then."""
    bound = False
    for item in items:
        if item.t >= at and not bound:
            bound = True
            yield Call("bind", (LEFT, "another"))
        if item.t < at or item.site is not silent:
            yield later(item, shift) if item.t >= at and item.site is LEFT else item


def unloaded(items: tuple[Any, ...]) -> Iterator[Sample]:
    """Take half of a step's pressure and all of its cells at times away, and let both feet slide along the ground."""
    for item in items:
        cells = item.pressure
        if 8.0 <= item.t < 11.0 and item.site is LEFT:
            cells = tuple(max(value, 60.0) for value in cells)
        elif 13.0 <= item.t < 16.0:
            cells = (0.0, 0.0, *cells[2:-2], 0.0, 0.0) if item.site is RIGHT else cells[:2] + (0.0,) * (len(cells) - 2)
        yield evolve(item, pressure=cells)


# --- limbs ------------------------------------------------------------------------------------------------------------


def above(change: Callable[[Any], Any], since: float = 0.0, until: float = 1e9) -> Change:
    """Change the samples of the sensors above the ankles."""
    return each(lambda item: change(item) if item.site in ABOVE_THE_ANKLES else item, since, until)


def bare(item: Sample) -> Sample:
    return evolve(item, quat=None)


def ahead(items: tuple[Any, ...]) -> Iterator[Item]:
    """Give the pelvis a sample from the far future, and later a clock that is two minutes ahead."""
    for item in items:
        if item.site is Site.PELVIS and 6.0 <= item.t < 6.03:
            yield evolve(item, t=item.t + 1e6)
        yield later(item, 120.0) if item.site is Site.PELVIS and item.t >= 12.0 else item


def stands_again(items: tuple[Any, ...], turn: tuple[float, float] = (0.8, 0.6)) -> Iterator[Item]:
    """Let a thigh's sensor restart with another north; the wearer stands, by the first second again, and goes on."""
    first = [item for item in items if item.t < 1.0]
    for item in items:
        if item.t < 6.0:
            yield item
    for site in (Site.LEFT_THIGH, Site.RIGHT_SHANK):
        yield Call("bind", (site, "another"))
    for k in range(2):
        for item in first:
            yield renorthed(later(item, 6.0 + k), turn)
    for item in items:
        if item.t >= 6.0:
            yield renorthed(later(item, 2.0), turn)


def renorthed(item: Sample, turn: tuple[float, float]) -> Sample:
    """Turn the world of one sensor by twice the angle whose cosine and sine these are."""
    if item.site is not Site.LEFT_THIGH or item.quat is None:
        return item
    (c, s), (w, x, y, z) = turn, item.quat
    return evolve(item, quat=(c * w - s * z, c * x - s * y, c * y + s * x, c * z + s * w))


# --- calibrations -----------------------------------------------------------------------------------------------------


def compensations() -> Iterator[Any]:
    """Yield the errors of the steps of a walk against marks beside its own touchdowns, and their means."""
    suit = tuple(given("suit"))
    layouts = {foot: sole(24, foot) for foot in Foot}
    for heading in (None, 0.4):
        downs = touchdowns(DecodedRecording(suit, layouts), Calibration(), heading)
        yield from downs
        modes = tuple(WalkingMode)[1:]
        marks = [
            ModeMark(f"line {k}", down.foot, down.position[0] + 0.01 * (k % 4), down.position[1] - 0.02 * (k % 3),
                     modes[k // 8 % len(modes)], t=down.t + 0.1 * (-1) ** k)
            for k, down in enumerate(downs)
        ]  # fmt: skip
        for turn in (None, 0.3):
            errors = step_errors(marks, downs, turn)
            yield from errors
            yield {"means": {foot.value: row for foot, row in mean_errors(errors).items()}}


def stood() -> Iterator[Any]:
    """Yield how seven sensors sat while the wearer stood, with their attitudes and without, and why not."""
    suit = tuple(given("suit"))
    for kept in (suit, tuple([bare(item) for item in suit]), tuple([item for item in suit if item.t > 4.0])):
        try:
            yield {"tilts": {site.value: tilt for site, tilt in check_standing(kept).items()}}
        except CalibrationError as error:
            yield {"error": str(error)}


SUIT = partial(of, "suit")

PAPERS: tuple[Case, ...] = (
    Case("rides in lifts, footstep-tracker-printed", rides, "footstep-tracker-printed"),
    *(
        Case(f"another device {shift:g} s ahead, shoe-sensing",
             half(partial(exchanged, at=9.0, shift=shift), until=26.0), "shoe-sensing-printed")
        for shift in (-40.0, 3.0)
    ),
    Case("another device and silence, shoe-sensing",
         half(partial(exchanged, at=9.0, shift=-40.0, silent=RIGHT), until=40.0), "shoe-sensing-printed"),
    *(
        Case(f"loads that come and go, {name}", half(unloaded, until=20.0), name, calibrated)
        for name in ("kupt-dfpc", "pressure-contour-printed")
    ),
    Case("cells alone, footstep-tracker", half(without("acc", "gyro"), until=20.0), "footstep-tracker", calibrated),
    Case("cells alone, kupt-dfpc", half(without("acc", "gyro"), until=12.0), "kupt-dfpc", calibrated),
    *(
        Case(f"a sensor that slips on the foot, {name}",
             half(each(lambda item: turned(item, 1.8), 10.0, site=LEFT), until=24.0), name)
        for name in ("kupt-dfpc-printed", "footstep-tracker")
    ),
    Case("a foot that turns all the time, gyroscope",
         half(each(lambda item: added(item, gyro=(0.0, 1.5, 0.0)), 6.0, 16.0, LEFT), until=20.0), "gyroscope"),
    Case("attitudes of the device, pressure-contour", SUIT(set_back, until=26.0), "pressure-contour", calibrated),
    Case("a building, footstep-tracker-printed", walked(8, 25.0), "footstep-tracker-printed",
         partial(planned, STARTS[8])),
    Case("seven sites without attitudes", SUIT(each(bare), until=20.0), "walking-modes"),
    Case("above the ankles without attitudes", SUIT(above(bare), until=20.0), "walking-modes", heading=0.5),
    Case("sites above the ankles that restart", SUIT(stands_again, until=20.0), "walking-modes"),
    Case("a pelvis far ahead", SUIT(ahead, until=20.0), "walking-modes"),
    Case("a pelvis that is late",
         SUIT(each(lambda item: later(item, -0.4), 5.0, 9.0, Site.PELVIS), ordered, until=15.0), "walking-modes"),
    Case("nobody stood at first", SUIT(each(lambda item: None, until=3.0), until=20.0), "walking-modes"),
    Case("limbs that are measured",
         SUIT(above(lambda item: later(item, -0.015)), ordered, until=20.0), "touchdown-height", calibrated),
    Case("compensation of walking modes", compensations),
    Case("a standing pose", stood),
)  # fmt: skip

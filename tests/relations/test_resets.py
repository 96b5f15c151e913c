"""A part that has walked and is then reset is as a fresh one, but for what the table names.

Every record in the state of a session that has a method of `METHODS` is copied in the middle of walks, reset, and
compared field by field with a fresh one. The records are found in the state itself, so a new one is found as well."""

from __future__ import annotations

import inspect
import sys
from collections import defaultdict
from collections.abc import Iterator
from copy import deepcopy
from functools import cache
from typing import Any

import attrs
import pytest
from attrs import evolve
from transforms import CLIMBING, worn
from walks import machines

from solepath import Foot, Packet, Session, Site, recipes
from solepath.body.part import Part

METHODS = ("reset", "restart", "clear", "forget", "cut", "drop", "_restart", "_forget", "restart_clock",
           "handle_reconnection")  # fmt: skip
WALKS = ("fragments", "cc2541", "dot", "thingy", "kupt-dfpc", "pressure-contour", "footstep-tracker-printed",
         "shoe-sensing-printed", "seven sites", "particles", "Snake game")  # fmt: skip
LOOK_EVERY = 61
"""Number of items after which the state is looked at."""

STAYS = """
Activities._restart: feet flights strides
Activities.reset: feet* flights* held* apart flights.reset() left.feet.restart() right.feet.restart()
AirPressure.reset: degraded apart
Altitude.reset: base* noise now*
AnglePerMetre.reset: activity limitation_reported apart flights.reset()
BiasFilter.forget: before bias* noise rate
BiasFilter.reset: before bias* noise rate
BothFeet._restart: common compass directions distance divergence errors* ground measured_at path placements started
  tracks* width straight_ways.reset()
BothFeet.reset: common* compass* directions distance divergence errors measured_at path placements started tracks* width
  apart compass.reset() straight_ways.reset()
Cc2541Link.handle_reconnection: acc_clock* ahead calibration firmware gyro_clock*
Cc2541Link.restart_clock: assembler* calibration firmware
CellHealth.reset: count lively_windows suspected
Clipping.reset: axes* largest near_end_square
Compass.reset: distance disturbance first apart trust.reset()
CompassTrust.reset: apart
Contours.reset: cells levels per_area points rays
CopCues.reset: foot_centre inertial* sagittal stage_t_start* touch inertial.reset()
CopCues.restart: foot_centre inertial* sagittal touch* inertial.reset() inertial.restart() touch.restart()
CriticalCues.reset:
CriticalCues.restart:
Decoder.restart_clock: firmware link* newest_stream_arrival* used link.restart_clock()
DoubleFoot.reset: chosen error_balance paths* apart
Flights.reset: level_stride_count stride_count t_end t_start trusted_rise
FootBlocks.restart: bias climb fast flat_height force gyro_count hard rate_squares resolution sink squares steady
  strike_height total tracked
FootClocks._forget: feet* idle
FootClocks.reset: feet* idle
FootTracker.reset: corrector* counts_losses cues* detector* gait* levelled limitations rest* rhythm sole* walk_scale*
  cues.reset() cues.restart() gait.reset() rest.reset() sole.reset() walk_scale.reset()
Gait.reset: anchor_position bearing* heading_settled number path phase stride* template* turned world stride.cut()
  template.reset()
GaitCues.reset: inertial* pressure sagittal inertial.reset()
GaitCues.restart: inertial* sagittal inertial.reset() inertial.restart()
GaitCycles.reset: feet* apart means.reset()
GaitMeans.reset: running walking_means apart
InertialCues.reset: axis force impact impact_at landing_at lowest_rate moving_since not_turning_at peak_rate sagittal
  swing_start turn
InertialCues.restart: axis
InsoleLink.handle_reconnection: acc_scale cells gyro_scale info_digest layout packet_run* pressure_scale reassembly*
  reassembly.drop()
InsoleLink.restart_clock: acc_scale cells gyro_scale info_digest layout packet_run* pressure_scale reassembly
InsoleLoads.reset: forefoot* forefoot_cells heel* heel_cells layout load_risen sum tare tare_total total* turned*
  unloaded* was_airborne turned.restart() unloaded.restart()
LoneFoot.restart: is_known stood_since
Looseness.reset: apart
LowerLimbs.reset: aligned facing newest* segments* times
MeanOfFeet.reset: apart
Modes.reset: pending places* recognition* reference signs touchdowns
  recognition.reset()
PossibleMotion.reset: apart
PressureHeight.restart: blocks compared newest noise apart
RateIntegral.restart: instants* t*
Reassembly.drop: frame_id skipping
Recognition.reset: load_count mean_load soles* apart
Recovery.reset: acc_clipping* clipped earlier_acc earlier_dt earlier_rate gyro_clipping last_acc swing watches
  acc_clipping.reset()
References.reset: activity
Rest.reset: bias bias_filter* block_end count grain last scale bias_filter.reset()
SensorChecks.reset: apart
SessionState.reset: awake* decoders feet* height links now parts* repeats unsettled apart left.feet.reset()
  right.feet.reset()
SessionState.restart_clock: awake* decoders* feet* height links now* parts* repeats unsettled left.feet.reset()
  right.feet.reset()
Sides.reset: declared
Sole.reset: count_checked guess had_cells health* highest insole* layout_estimated health.reset() insole.reset()
StanceFinder._restart: counted duration force peak t turn weight
StanceRhythm.reset: usual_stance usual_swing
StraightWays.reset: straightness.reset()
Straightness.reset:
StreamLink.handle_reconnection: counted_packets counted_since counted_ticks last_t newest_arrival off_rate_interval
  off_rate_packets packet_run* periodic* recent reported_rate
StreamLink.restart_clock: counted_packets counted_ticks off_rate_interval off_rate_packets packet_run* periodic*
  recent reported_rate
StrideBuilder.cut: attitude contact_time cop cop_interval cop_skipped creep first_pitch flat_pitch flaws
  heel_strike_pitch least_force load_count load_sum longest_rest most_force next_pitch peak_height peak_rate
  peak_speed pitch pitch_high pitch_low pitches rest start stride_rate t_heel_off t_heel_strike t_mid_stance t_pitch
  t_toe_off toe_off_pitch usual_flat_pitch usual_motion
StrideTemplate.reset: age bridged first_position infilled last_stride longest_stride stance_duration straight_on*
  t_last_flat t_next_moment
Touch.restart: in_front
TurnDetector.reset: feet* pause t_end apart
Turns.reset: detector* apart detector.reset()
UnloadedLevel.restart: base base_t cells count flat flat_t level level_t sure_cells sure_ground top
TwoSecondWindows.reset: limitation_reported moving_windows
WalkScale.reset: drift_deviation force stance_deviation strides
"""
"""For each class and method the fields that stay, with a * if they change; the resets of its parts that it makes, with
(); and `apart` where the reset of one foot leaves the other's fields alone.

What stays is what was learnt of wearer, device and mounting (axis, bias, scale, layout, tare, usual times); the track,
what was reported of it, and counts; and values that are set again before they are read, with a field that was reset."""
STARTS = ("start", "start_stride", "start_swing", "start_block", "_start_span", "end_lift", "forget_corner")
STARTED = """
BiasZupt.start: bias motion_acc
CommonError.start_stride: covariance estimates foot_biases
Cycle._start_span: highs lows past_high past_low sensor_height shoe
ErrorStateFilter.start: interval level recovery rhythm velocity_error
FootBlocks.start_block: blocks flat_height rest_force rested strides strike_height
GatedTilt.start: velocity_change
GyroscopeMagnitude._start_span: highs lows past_high past_low shoe
Impact.start_swing: peak_onset
Projection.start: largest_saturated least_saturated turning
Rest._start_span: bias bias_filter count grain last scale
Sagittal.end_lift: forward pitch toe up
SoftSwing.start: drift_time interval interval_velocity scale_excess
StrideBuilder.start_stride: contact_time first_pitch flat_pitch flawed_until flaws newest_gaps next_pitch peak_rate
  pitches t_contact t_mid_stance t_pitch usual_flat_pitch usual_motion
StrideTemplate.start_stride: age bridged first_position infilled last_stride longest_stride stance_duration straight_on
  t_flat t_last_flat
TrackErrorFilter.start: centre degraded_shares
TurningStrideFilter.forget_corner: straight_turn
"""
"""For each class and method that starts something again, the fields that stay: as above, and those of what went on."""
GIVEN = {
    "Quat": (0.8, 0.0, 0.0, 0.6),
    "Vec3": (1.0, 2.0, 3.0),
    "float": 0.1,
    "float | None": 0.2,
    "int": 7,
    "bool": False,
    "Foot": Foot.LEFT,
}
"""What a method that starts something is given, by the kind of its parameters."""
ELSEWHERE = {
    "Decoder._restart",
    "PeriodicClock._restart",
    "DeviceSetup.restart_clock",
    "Watchdog.restart_clock",
    "PitchGauge.restart",
}
"""Methods that go on with a packet, see the relations of streams; and those whose records are no state of a session: a
device's setup and its watchdog (tests/link/test_device_setup.py), and a shoe's gauge (tests/papers/kupt_dfpc)."""
ROOMS = ("link", "foot", "body", "place", "floorplan", "papers", "session", "saving")
"""Rooms whose records can be in the state of a session."""


def fresh(record: Any) -> Any:
    """Return a record as it is made: its state are its fields of `init=False`, in a link all that have a default."""
    fields = attrs.fields(type(record))
    if any(not f.init for f in fields) and not type(record).__module__.startswith("solepath.link"):
        return evolve(record)
    return type(record)(**{f.alias: getattr(record, f.name) for f in fields if f.default is attrs.NOTHING})


@cache
def state_fields(kind: type) -> tuple[str, ...] | None:
    """Return the names of a record's fields without settings, or None for what is no record."""
    return tuple(f.name for f in attrs.fields(kind) if f.name != "settings") if attrs.has(kind) else None


def records(value: Any) -> Iterator[Any]:
    """Yield the records within a state, without settings."""
    if (names := state_fields(type(value))) is not None:
        yield value
        for name in names:
            yield from records(getattr(value, name))
    elif isinstance(value, dict | list | tuple) and value:
        for one in value.values() if isinstance(value, dict) else value:
            if isinstance(one, float | int | str | None):
                break
            yield from records(one)


@cache
def resets(kind: type) -> list[str]:
    """Return the methods of a class that reset it."""
    return [name for name in METHODS if hasattr(kind, name) and getattr(kind, name) is not getattr(Part, name, None)]


def called(record: Any, name: str, state: list[Any]) -> list[Any]:
    """Return copies of a record after the call: for either foot alone, and for both."""
    parameters = [str(one.annotation) for one in inspect.signature(getattr(record, name)).parameters.values()]
    error = next((one for one in state if type(one).__name__ == "CommonError"), None)
    choices = {
        "Site": (Site.LEFT_FOOT, Site.RIGHT_FOOT),
        "Foot": tuple(Foot),
        "int": (0, 1),
        "float": (100.0, 100.0),
        "float | None": (100.0, 100.0),
        "CommonError": (error, error),
    }
    calls = [[choices[parameter][side] for parameter in parameters if parameter in choices] for side in (0, 1)]
    results = []
    for sides in (calls[:1], calls[1:], calls):
        one = deepcopy(record)
        for arguments in sides:
            returned = getattr(one, name)(*arguments)
            one = returned if type(returned) is type(record) else one
        results.append(one)
    return results


def differing(one: Any, other: Any) -> set[str]:
    return {f.name for f in attrs.fields(type(one)) if getattr(one, f.name) != getattr(other, f.name)}


class Seen:
    """What was seen of one method of a class."""

    def __init__(self) -> None:
        self.dirty: set[str] = set()
        self.stays: set[str] = set()
        self.changed: set[str] = set()
        self.calls: dict[str, bool] = {}
        self.sides: dict[str, bool] = {}

    def look(self, record: Any, name: str, state: list[Any]) -> None:
        new = fresh(record)
        dirty = differing(record, new)
        if dirty <= self.dirty and len(self.dirty):
            return
        self.dirty |= dirty
        left, right, both = called(record, name, state)
        self.stays |= differing(both, new)
        self.changed |= differing(both, record)
        for field in attrs.fields(type(record)):
            inner, after = getattr(record, field.name), getattr(both, field.name)
            pairs = {field.name: (inner, after)}
            if isinstance(inner, dict):
                pairs = {f"{foot.value}.{field.name}": (inner[foot], after.get(foot)) for foot in Foot if foot in inner}
            for place, (inner_before, inner_after) in pairs.items():
                if not attrs.has(type(inner_before)) or type(inner_before) is not type(inner_after):
                    continue
                for method in resets(type(inner_before)):
                    if called(inner_before, method, state)[2] != inner_before:
                        call, done = f"{place}.{method}()", called(inner_after, method, state)[2] == inner_after
                        self.calls[call] = self.calls.get(call, True) and done
            for foot, own, other in ((Foot.LEFT, left, right), (Foot.RIGHT, right, left)):
                values = [getattr(one, field.name) for one in (record, both, own, other)]
                if isinstance(inner, dict) and foot in inner:
                    values = [value.get(foot) for value in values]
                elif field.name.partition("_")[0] != foot.value:
                    continue
                if values[0] != values[1]:
                    assert values[2] == values[1], f"{field.name} of its own foot"
                    self.sides["apart"] = self.sides.get("apart", True) and values[3] == values[0]

    def row(self) -> list[str]:
        """Return the fields that stay, the resets of parts that are done with it, and whether each foot is apart."""
        done = [name for names in (self.calls, self.sides) for name, holds in names.items() if holds]
        return [f"{name}*" if name in self.changed else name for name in sorted(self.stays)] + sorted(done)


class Started:
    """What was seen of one method that starts something again: fields that were in use, and those that stay."""

    def __init__(self) -> None:
        self.dirty: set[str] = set()
        self.stays: set[str] = set()

    def look(self, record: Any, name: str) -> None:
        used, new = deepcopy(record), fresh(record)
        dirty = differing(used, new)
        if dirty <= self.dirty:
            return
        self.dirty |= dirty
        kinds = [str(one.annotation) for one in inspect.signature(getattr(record, name)).parameters.values()]
        for one in (used, new):
            getattr(one, name)(*[GIVEN[kind] for kind in kinds])
        self.stays |= differing(used, new)


@pytest.fixture(scope="module")
def seen() -> tuple[dict[str, Seen], dict[str, Started]]:
    """Return what was seen of every method that resets, and of every one that starts again, over all walks."""
    found: dict[str, Seen] = defaultdict(Seen)
    started: dict[str, Started] = defaultdict(Started)
    climbing = Session(recipes.DEFAULT, poses=True), worn(CLIMBING)
    walks = [machines()[f"session, {name}"] for name in WALKS]
    for session, items in (climbing, *((walk.start(), walk.items) for walk in walks)):
        for k, item in enumerate(items):
            session.feed(item)
            if k % LOOK_EVERY:
                continue
            if isinstance(item, Packet):  # rejected, and counted
                session.feed(evolve(item, t=item.t - 1.0))
            state = list(records(session._state))
            for record in state:
                for name in resets(type(record)):
                    if f"{type(record).__name__}.{name}" not in ELSEWHERE:
                        found[f"{type(record).__name__}.{name}"].look(record, name, state)
                for name in [name for name in STARTS if callable(getattr(type(record), name, None))]:
                    started[f"{type(record).__name__}.{name}"].look(record, name)
    return found, started


def rows_of(table: str) -> dict[str, list[str]]:
    """Return the words of each row of a table."""
    rows: dict[str, list[str]] = {}
    row: list[str] = []
    for word in table.split():
        row = rows.setdefault(word[:-1], []) if word.endswith(":") else row
        if not word.endswith(":"):
            row.append(word)
    return rows


def test_a_part_that_is_reset_is_as_a_fresh_one_but_for_what_the_table_names(seen: Any) -> None:
    assert {name: one.row() for name, one in seen[0].items()} == rows_of(STAYS)


def test_a_part_that_starts_again_is_as_a_fresh_one_that_starts_but_for_what_the_table_names(seen: Any) -> None:
    assert {name: sorted(one.stays) for name, one in seen[1].items()} == rows_of(STARTED)


def test_every_method_that_resets_a_record_is_in_the_table() -> None:
    rooms = tuple(f"solepath.{room}." for room in ROOMS)
    loaded = [module for name, module in sys.modules.items() if name.startswith(rooms)]
    kinds = {kind for module in loaded for kind in vars(module).values() if isinstance(kind, type)}
    defined = {f"{kind.__name__}.{name}" for kind in kinds if attrs.has(kind) for name in METHODS if name in vars(kind)}
    assert defined - ELSEWHERE <= {word[:-1] for word in STAYS.split()}

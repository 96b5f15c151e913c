"""All that is loaded by its name: the only module that holds names of modules as text.

Recipes, parts, links and devices are loaded when they are first used, so that a session imports only what it needs. A
name from a saved state, a packet or a command line is looked up only here."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def _by_class(*entries: str) -> dict[str, str]:
    """Return entries by the names of their classes."""
    return {entry.partition(":")[2]: entry for entry in entries}


TABLE: dict[str, dict[str, str]] = {
    # recipes, the default first
    "recipe": {
        "default": "solepath.recipes:DEFAULT",
        "kupt-dfpc": "solepath.papers.kupt_dfpc.recipe:KUPT_DFPC",
        "kupt-dfpc-printed": "solepath.papers.kupt_dfpc.recipe:KUPT_DFPC_PRINTED",
        "kupt": "solepath.papers.kupt_dfpc.recipe:KUPT",
        "zupt": "solepath.papers.kupt_dfpc.recipe:ZUPT",
        "pressure-contour": "solepath.papers.pressure_contour.recipe:PRESSURE_CONTOUR",
        "pressure-contour-printed": "solepath.papers.pressure_contour.recipe:PRESSURE_CONTOUR_PRINTED",
        "gyroscope": "solepath.papers.pressure_contour.recipe:GYROSCOPE",
        "walking-modes": "solepath.papers.walking_modes.recipe:WALKING_MODES",
        "walking-modes-printed": "solepath.papers.walking_modes.recipe:WALKING_MODES_PRINTED",
        "touchdown-height": "solepath.papers.walking_modes.recipe:TOUCHDOWN_HEIGHT",
        "touchdown-acceleration": "solepath.papers.walking_modes.recipe:TOUCHDOWN_ACCELERATION",
        "touchdown-pressure": "solepath.papers.walking_modes.recipe:TOUCHDOWN_PRESSURE",
        "footstep-tracker": "solepath.papers.footstep_tracker.recipe:FOOTSTEP_TRACKER",
        "footstep-tracker-printed": "solepath.papers.footstep_tracker.recipe:FOOTSTEP_TRACKER_PRINTED",
        "shoe-sensing": "solepath.papers.shoe_sensing.recipe:SHOE_SENSING",
        "shoe-sensing-printed": "solepath.papers.shoe_sensing.recipe:SHOE_SENSING_PRINTED",
    },
    # classes of parts; a saved state names only these and those of an app
    "part": _by_class(
        "solepath.foot.stance.cycle:Cycle",
        "solepath.foot.stance.shoe:ShoeDetector",
        "solepath.foot.navigate.error_state:ErrorStateFilter",
        "solepath.foot.navigate.dedrift:LinearDedrift",
        "solepath.foot.cues.gait_cues:GaitCues",
        "solepath.body.checks.sensors:SensorChecks",
        "solepath.body.checks.motion:PossibleMotion",
        "solepath.body.checks.looseness:Looseness",
        "solepath.body.checks.air_pressure:AirPressure",
        "solepath.body.wear:Wear",
        "solepath.body.fuse.position:MeanOfFeet",
        "solepath.body.fuse.both_feet:BothFeet",
        "solepath.body.activity.activities:Activities",
        "solepath.body.gait.turns:Turns",
        "solepath.body.altitude:Altitude",
        "solepath.body.checks.foot_clocks:FootClocks",
        "solepath.body.gait.cycles:GaitCycles",
        "solepath.place.placing:Particles",
        "solepath.papers.kupt_dfpc.known_velocity:KnownVelocity",
        "solepath.papers.kupt_dfpc.swing_drift:SwingDedrift",
        "solepath.papers.kupt_dfpc.soft_swing:SoftSwing",
        "solepath.papers.kupt_dfpc.cop_cues:CopCues",
        "solepath.papers.kupt_dfpc.fusion:DoubleFoot",
        "solepath.papers.pressure_contour.contour_stance:ContourVelocity",
        "solepath.papers.pressure_contour.contour_stance:PrintedContour",
        "solepath.papers.pressure_contour.contour_stance:GyroscopeMagnitude",
        "solepath.papers.pressure_contour.bias_zupt:BiasZupt",
        "solepath.papers.pressure_contour.printed_checks:PrintedMotion",
        "solepath.papers.pressure_contour.printed_checks:SampleChecks",
        "solepath.papers.walking_modes.modes:Modes",
        "solepath.papers.footstep_tracker.static_zones:StaticZones",
        "solepath.papers.footstep_tracker.projection:Projection",
        "solepath.papers.footstep_tracker.critical_cues:CriticalCues",
        "solepath.papers.footstep_tracker.footsteps:Footsteps",
        "solepath.papers.footstep_tracker.activity.two_second_windows:TwoSecondWindows",
        "solepath.papers.footstep_tracker.snake:PrintedSnake",
        "solepath.papers.shoe_sensing.short_time_energy:ShortTimeEnergy",
        "solepath.papers.shoe_sensing.printed:GatedTilt",
        "solepath.papers.shoe_sensing.additions:ShoeSensing",
        "solepath.papers.shoe_sensing.walking_state:AnglePerMetre",
    ),
    # classes that are loaded with the first sample that needs them (saving/schema.py)
    "aid": _by_class(
        "solepath.body.fuse.compass:Compass",
        "solepath.link.decoder:Decoder",
        "solepath.foot.tracker:FootTracker",
        "solepath.body.activity.pressure_height:PressureHeight",
        "solepath.foot.navigate.clipping:Recovery",
        "solepath.foot.pressure.insole:Sole",
        "solepath.foot.cues.touch:Touch",
    ),
    # classes of links
    "link": _by_class(
        "solepath.link.devices.insole:InsoleLink",
        "solepath.link.devices.cc2541:Cc2541Link",
        "solepath.link.stream:StreamLink",
    ),
    # devices by the prefix of their channels: a Driver, or a DeviceKind for one with a link of its own
    "device": {
        "insole": "solepath.link.devices.insole:KIND",
        "cc2650": "solepath.link.devices.cc2650:DRIVER",
        "cc2541": "solepath.link.devices.cc2541:KIND",
        "orphe": "solepath.link.devices.orphe:DRIVER",
        "dot": "solepath.link.devices.dot:DRIVER",
        "dot-orientation": "solepath.link.devices.dot:ORIENTATION_DRIVER",
        "thingy": "solepath.link.devices.thingy:DRIVER",
    },
}
"""Module and, after the colon, attribute of each entry, by its kind and its name."""


def load(kind: str, name: str) -> Any:
    """Return the entry of this name; KeyError when there is none."""
    module, _, attribute = TABLE[kind][name].partition(":")
    return getattr(import_module(module), attribute)

"""Which findings about the data of a recording are alarms: those that nothing in the recording explains."""

from __future__ import annotations

from collections.abc import Iterable

from solepath.events import Defect, DefectFound

KNOWN: dict[str, set[Defect]] = {
    "felius_2min_walk": {Defect.AXES},
    "hugadb": {Defect.CLIPPED},
    "hugadb_daily": {Defect.CLIPPED},
    "slow_gait": {Defect.CLIPPED, Defect.LOW_RATE},
    "smart_insole_35": {Defect.REPEATED},
    "xio_closed_walks": {Defect.CLIPPED},
}
"""Defects that recordings of these data sets have.

They are an accelerometer that clips at 2 g (hugadb, slow_gait) or 8 g (xio), 10 samples a second (one of slow_gait),
values that are repeated (smart_insole_35), and a left foot whose strides close best with all axes of one sensor
reversed, and then badly (felius)."""
NOT_ON_FEET = ("sevivi_hops",)
"""Data sets of sensors that are on no foot."""
NOT_WALKING = ("hugadb_daily",)
"""Data sets in which nobody walks: people cycle, drive and sit."""
ANYWHERE = {Defect.NO_GRAVITY, Defect.ACC_UNIT, Defect.GYRO_UNIT, Defect.WRONG_SCALE, Defect.TIME_UNIT}
"""Defects that would be wrong of a sensor anywhere; others are said of feet, and a sensor on no foot may deserve it."""


def is_alarm(data_set: str, defect: Defect) -> bool:
    """Return whether a finding in a recording of the data set is an alarm."""
    return defect in ANYWHERE if data_set in NOT_ON_FEET else defect not in KNOWN.get(data_set, set())


def alarms(data_set: str, findings: Iterable[DefectFound]) -> list[DefectFound]:
    """Return the alarms among the findings in a recording of the data set."""
    return [one for one in findings if is_alarm(data_set, one.defect)]

"""Units of the fields of events and samples, by name; a test compares them with the fields' docstrings."""

from __future__ import annotations

_NAMES = {
    "s": "t known_at t_start t_end t_toe_off t_heel_strike revises stride_time stance_time swing_time step_time "
    "initial_double_support terminal_double_support single_support offset offset_sigma duration silent_for seconds",
    "m": "height stride_length own_length distance position by sigma compensation displacement length height_change "
    "features_clearance features_rise features_cop clearance rise centre spread height_off "
    "layout_length legs",
    "m^2": "covariance",
    "m/s": "error_index features_peak_speed features_error_index speed velocity",
    "m/s^2": "acc",
    "rad": "angle turn heading_change features_swing_pitch features_toe_off_angle features_heel_strike_angle "
    "toe_off_angle heel_strike_angle turning_angle heading_sigma north heading_off",
    "rad/s": "gyro",
    "1/min": "cadence",
    "Pa": "air_pressure",
    "T": "mag",
    "dBm": "signal",
    "N": "layout_scale",
    "1": "probability similarity coefficient phase level quat",
}
UNITS = {name: unit for unit, names in _NAMES.items() for name in names.split()}
"""Unit of each column that has one, by the column's name without its component; "1" for shares and unit quaternions.

Loads of pressure cells (`pressure`, `values`, `force`, `features_contact_load`, `layout_full_scale`) are in newtons or
in counts of the device, as LayoutKnown says, so they have no unit here."""

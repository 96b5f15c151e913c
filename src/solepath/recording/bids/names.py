"""Names of the files of one recording in a BIDS dataset, and the quantities that its channels may have."""

from __future__ import annotations

import re
from pathlib import Path

from attrs import field, frozen

BIDS_VERSION = "1.10.0"
"""Version of the BIDS specification that the files follow; motion came with 1.9.0."""
LABEL = re.compile(r"[0-9A-Za-z]+")
"""Pattern of a label: letters and digits only (BIDS, "Entities")."""
MOTION_END = "_motion.tsv"
"""End of the name of the file with the values of a tracking system."""
TSV_MISSING = "n/a"
"""Text of a value that is missing or does not apply, in tables."""


def recording_of(path: Path) -> Path:
    """Return the path of a file without its tracking system, which all files of one recording have in common."""
    return path.with_name(re.sub(r"_tracksys-[0-9A-Za-z]+", "", path.name))


def _check_label(entity: object, attribute: object, label: str) -> None:
    if label and not LABEL.fullmatch(label):
        raise ValueError(f"{label!r} is no label of BIDS, which has letters and digits only")


@frozen
class Entities:
    """The labels that name one recording in a dataset; ValueError for one that BIDS does not allow."""

    subject: str = field(validator=_check_label)
    """Label of the person: letters and digits."""
    task: str = field(default="walk", validator=_check_label)
    """Label of what the person did."""
    session: str = field(default="", validator=_check_label)
    """Label of the visit; "" without visits."""
    run: int = field(default=0)
    """Number of the repetition, from 1; 0 without repetitions."""

    @run.validator
    def _check_run(self, attribute: object, run: int) -> None:
        if run < 0:
            raise ValueError("a run is numbered from 1")

    def __attrs_post_init__(self) -> None:
        if not self.subject or not self.task:
            raise ValueError("a recording in a dataset has a subject and a task")

    @property
    def folder(self) -> Path:
        """Folder of the files in the dataset."""
        visit = [f"ses-{self.session}"] if self.session else []
        return Path(f"sub-{self.subject}", *visit, "motion")

    def file(self, suffix: str, tracksys: str = "") -> str:
        """Return the name of a file, which ends in `suffix`; `tracksys`: label of the tracking system, "" for none."""
        labels = {"sub": self.subject, "ses": self.session, "task": self.task, "tracksys": tracksys}
        parts = [f"{entity}-{label}" for entity, label in labels.items() if label]
        if self.run:
            parts.append(f"run-{self.run}")
        return "_".join([*parts, suffix])

    @property
    def scans(self) -> Path:
        """File of the dataset that lists the recordings of the person, or of the visit."""
        visit = f"_ses-{self.session}" if self.session else ""
        return self.folder.parent / f"sub-{self.subject}{visit}_scans.tsv"

    def owns(self, name: str) -> bool:
        """Return whether a file of the folder belongs to this recording, whatever its tracking system."""
        without = re.sub(r"_tracksys-[0-9A-Za-z]+", "", name)
        return without.rpartition("_")[0] == self.file("x").rpartition("_")[0]


@frozen
class ChannelKind:
    """One quantity: the names of its channels, and what channels.tsv says of each."""

    kind: str
    """Type of the channels, a keyword of Motion-BIDS."""
    units: str
    frame: str
    """Reference frame, a level of channels.json; "n/a" for none."""
    components: tuple[str, ...]
    """Components in order; empty if their number is that of the first value."""
    description: str


AXES, QUATERNION, SCALAR = ("x", "y", "z"), ("quat_w", "quat_x", "quat_y", "quat_z"), (TSV_MISSING,)
CHANNELS = {
    "latency": ChannelKind("LATENCY", "s", TSV_MISSING, SCALAR, "time since the start of the recording"),
    "acc": ChannelKind("ACCEL", "m/s^2", "sensor", AXES, "specific force, +9.81 upwards at rest"),
    "gyro": ChannelKind("GYRO", "rad/s", "sensor", AXES, "angular rate"),
    "mag": ChannelKind("MAGN", "T", "sensor", AXES, "magnetic flux density"),
    "device": ChannelKind("ORNT", TSV_MISSING, "device", QUATERNION, "attitude that the device itself estimates"),
    "air_pressure": ChannelKind("MISC", "Pa", TSV_MISSING, SCALAR, "air pressure"),
    "pressure": ChannelKind("MISC", "N", TSV_MISSING, (), "force on one cell of the insole"),
    "saturated": ChannelKind("MISC", TSV_MISSING, TSV_MISSING, SCALAR, "1 while a sensor is at the end of its range"),
    "position": ChannelKind("POS", "m", "world", AXES, "position of the sensor, computed by solepath"),
    "velocity": ChannelKind("VEL", "m/s", "world", AXES, "velocity of the sensor, computed by solepath"),
    "attitude": ChannelKind("ORNT", TSV_MISSING, "world", QUATERNION, "attitude of the sensor, computed by solepath"),
}
"""Quantities in the order of their channels."""
CHANNEL_TYPES = ("ACCEL", "ANGACCEL", "GYRO", "JNTANG", "LATENCY", "MAGN", "MISC", "ORNT", "POS", "VEL")
"""All types of channels of Motion-BIDS."""

"""Names of the files of one recording in a BIDS dataset."""

from __future__ import annotations

import re
from pathlib import Path

from attrs import frozen

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


def systems_of(path: Path) -> list[Path]:
    """Return the files of all tracking systems of the recording to which a file `*_motion.tsv` belongs."""
    beside = sorted(path.parent.glob(f"*{MOTION_END}"))
    return [one for one in beside if recording_of(one) == recording_of(path)]


def channels_of(path: Path) -> Path:
    """Return the file that describes the columns of a file `*_motion.tsv`."""
    return path.with_name(path.name.removesuffix(MOTION_END) + "_channels.tsv")


@frozen
class Entities:
    """The labels that name one recording in a dataset; ValueError for one that BIDS does not allow."""

    subject: str
    """Label of the person: letters and digits."""
    task: str = "walk"
    """Label of what the person did."""
    session: str = ""
    """Label of the visit; "" without visits."""
    run: int = 0
    """Number of the repetition, from 1; 0 without repetitions."""

    def __attrs_post_init__(self) -> None:
        for label in filter(None, (self.subject, self.task, self.session)):
            if not LABEL.fullmatch(label):
                raise ValueError(f"{label!r} is no label of BIDS, which has letters and digits only")
        if not self.subject or not self.task or self.run < 0:
            raise ValueError("a recording in a dataset has a subject and a task, and its run is numbered from 1")

    @property
    def folder(self) -> Path:
        """Folder of the files in the dataset."""
        visit = [f"ses-{self.session}"] if self.session else []
        return Path(f"sub-{self.subject}", *visit, "motion")

    @property
    def _visit(self) -> dict[str, str]:
        return {"sub": self.subject, "ses": self.session}

    def file(self, suffix: str, tracksys: str = "") -> str:
        """Return the name of a file, which ends in `suffix`; `tracksys`: label of the tracking system, "" for none."""
        run = str(self.run or "")
        return _join(self._visit | {"task": self.task, "tracksys": tracksys, "run": run}, suffix)

    @property
    def scans(self) -> Path:
        """File of the dataset that lists the recordings of the person, or of the visit."""
        return self.folder.parent / _join(self._visit, "scans.tsv")

    def owns(self, name: str) -> bool:
        """Return whether a file of the folder belongs to this recording, whatever its tracking system."""
        return recording_of(Path(name)).name.rpartition("_")[0] == self.file("x").rpartition("_")[0]


def _join(labels: dict[str, str], suffix: str) -> str:
    return "_".join([*(f"{entity}-{label}" for entity, label in labels.items() if label), suffix])

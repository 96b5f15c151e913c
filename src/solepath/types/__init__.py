"""Types that all packages share: feet, sites, phases and activities; packets, samples and layouts of cells; vectors."""

from .layout import Cell, Layout, shared
from .records import (
    OTHER,
    SITE_OF_FOOT,
    Activity,
    Foot,
    OnBody,
    Packet,
    Phase,
    Quat,
    Sample,
    Site,
    Support,
    Turn,
    Vec3,
    WalkingMode,
    Word,
)

__all__ = [
    "OTHER",
    "Activity",
    "Cell",
    "Foot",
    "Layout",
    "OnBody",
    "Packet",
    "Phase",
    "Quat",
    "SITE_OF_FOOT",
    "Sample",
    "Site",
    "Support",
    "Turn",
    "Vec3",
    "WalkingMode",
    "Word",
    "shared",
]

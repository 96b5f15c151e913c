"""Known formats of tables of samples, each with its source; they are recognised by the start of a file."""

from .export import Export, TableHeader
from .mbientlab import MBIENTLAB
from .moticon import MOTICON
from .movella_dot import MOVELLA_DOT
from .ngimu import NGIMU
from .own import OWN
from .physilog import PHYSILOG

EXPORTS = {export.name: export for export in (MOVELLA_DOT, MBIENTLAB, PHYSILOG, MOTICON, NGIMU, OWN)}
"""Known formats by name (mapping.FORMATS), in the order in which they are tried."""

__all__ = ["EXPORTS", "OWN", "Export", "TableHeader"]

"""Import of floor plan files, whose format is recognised by the content.

The importers of the formats and their libraries are loaded with the first file, since most apps read none."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

from ...saving.files import FileTooLarge, read_bounded
from ..checks import find_fault
from ..plan import FloorPlan, FloorPlanError

MAX_FILE_SIZE = 32_000_000
"""Largest size of a file and of all unpacked files of an archive, bytes; a large airport has a tenth of that."""

DEFAULT_STOREY_HEIGHT = 3.0
"""Assumed height from one level to the next, m, for a file without elevations."""


def read_floorplan(path: Path | str, storey: float = DEFAULT_STOREY_HEIGHT) -> FloorPlan:
    """Return the plan in a file.

    The file is GeoJSON of protocol/floorplan.md, an IMDF archive (a zip file or a folder), or OpenStreetMap XML or
    GeoJSON with Simple Indoor Tagging. `storey` is the assumed height from one level to the next, m, for a file without
    elevations; then `heights_known` of the plan is False. Raises FloorPlanError, with one line, when it cannot be read
    or used."""
    try:
        return _check(_read(Path(path), storey))
    except FileTooLarge as error:
        raise FloorPlanError(f"{path}: {error}, too large for a floor plan") from None
    except FloorPlanError as error:
        raise FloorPlanError(f"{path}: {error}") from None
    except OSError as error:
        raise FloorPlanError(f"{path}: {error.strerror or error}") from None


def parse_floorplan(data: bytes, storey: float = DEFAULT_STOREY_HEIGHT) -> FloorPlan:
    """Return the plan in a file's bytes; raise FloorPlanError when there is none that can be used."""
    return _check(_plan(data, storey))


def _check(plan: FloorPlan) -> FloorPlan:
    fault = find_fault(plan)
    if fault is not None:
        raise FloorPlanError(fault)
    return plan


def _read(path: Path, storey: float) -> FloorPlan:
    from . import imdf

    if path.is_dir():
        names = [name for name in imdf.FILES if (path / name).is_file()]
        return imdf.read_archive({name: read_bounded(path / name, MAX_FILE_SIZE) for name in names}, storey)
    return _plan(read_bounded(path, MAX_FILE_SIZE), storey)


def _plan(data: bytes, storey: float) -> FloorPlan:
    from . import geojson, imdf, osm, osm_file
    from .features import parse_json

    if not 1.0 <= storey <= 50.0:
        raise FloorPlanError(f"a storey of {storey:g} m cannot be")
    if data.startswith(b"PK"):
        return imdf.read_archive(_unpack(data), storey)
    first_byte = data.lstrip(b"\xef\xbb\xbf \t\r\n")[:1]
    if first_byte == b"<" or data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return osm.read_osm(osm_file.parse_elements(data), storey)
    if first_byte != b"{":
        raise FloorPlanError("is no floor plan: neither GeoJSON, nor an IMDF archive, nor OpenStreetMap XML")
    collection = parse_json(data)
    if collection.get("format") == geojson.FORMAT:
        return geojson.read_collection(collection, storey)
    if collection.get("type") == "FeatureCollection" and isinstance(collection.get("features"), list):
        first = collection["features"][0] if collection["features"] else None
        if isinstance(first, dict) and "feature_type" in first:
            raise FloorPlanError("is one file of an IMDF archive; the archive or its folder is needed")
        if osm_file.is_collection(collection):
            return osm.read_osm(osm_file.convert_collection(collection), storey)
        raise FloorPlanError(f"is GeoJSON, but not a floor plan: its format is not {geojson.FORMAT!r}")
    raise FloorPlanError("is JSON, but not a floor plan")


def _unpack(data: bytes) -> dict[str, bytes]:
    """Return the needed files, from any folder of the archive; raise FloorPlanError beyond MAX_FILE_SIZE unpacked."""
    import zipfile
    import zlib

    from . import imdf

    try:
        with zipfile.ZipFile(BytesIO(data)) as archive:
            names = set(archive.namelist())
            manifests = [name for name in sorted(names) if name.rsplit("/", 1)[-1] == "manifest.json"]
            folder = min(manifests, key=len, default="manifest.json").removesuffix("manifest.json")
            files: dict[str, bytes] = {}
            bytes_left = MAX_FILE_SIZE
            for name in [name for name in imdf.FILES if folder + name in names]:
                info = archive.getinfo(folder + name)
                if info.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                    raise FloorPlanError(f"{name}: is packed in a way that IMDF does not know")
                with archive.open(info) as file:
                    files[name] = file.read(bytes_left + 1)
                bytes_left -= len(files[name])
                if bytes_left < 0:
                    raise FloorPlanError(
                        f"unpacked it is larger than {MAX_FILE_SIZE // 1_000_000} MB, too large for a plan"
                    )
            return files
    except FloorPlanError:
        raise
    except (zipfile.BadZipFile, zlib.error, RuntimeError, EOFError, ValueError, OSError) as error:
        raise FloorPlanError(f"is a damaged archive ({error})") from None

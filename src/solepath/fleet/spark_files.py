"""Selection of the valid files of Spark's file sink. Needs neither Spark nor Java.

    pyarrow.parquet.read_table(committed("events"))               duckdb.read_parquet([*map(str, committed("events"))])

Spark lists the files of every batch that it has finished in `_spark_metadata` beside them, from time to time all in one
list. A task that was killed leaves files that are unfinished, or that hold the same rows as a later file."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import unquote, urlsplit


def committed(directory: str | Path) -> list[Path]:
    """Return the files in a local `directory` of Spark's file sink that hold finished batches.

    A reader other than Spark must open these only; each event is in them once. Empty before the first batch ends."""
    log = {int(path.stem): path for path in Path(directory).glob("_spark_metadata/[0-9]*")}
    whole = max([number for number, path in log.items() if path.suffix == ".compact"], default=-1)
    lines = [line for number in sorted(log) if number >= whole for line in log[number].read_text().splitlines()[1:]]
    return [Path(unquote(urlsplit(json.loads(line)["path"]).path)) for line in lines]

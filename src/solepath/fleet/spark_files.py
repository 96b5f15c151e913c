"""Selection of the valid files of Spark's file sink. Needs neither Spark nor Java.

    pyarrow.parquet.read_table(committed("events"))               duckdb.read_parquet([*map(str, committed("events"))])

For every finished batch Spark writes a list of its files into `_spark_metadata` beside them, and at times a list of all
files (`.compact`). A killed task leaves files that are unfinished, or that hold the same rows as a later file."""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import unquote, urlsplit


def committed(directory: str | Path) -> list[Path]:
    """Return the files of finished batches in a local `directory` of Spark's file sink; they hold each event once.

    A reader other than Spark must open only these files. Returns [] before the first batch ends."""
    log = {int(path.stem): path for path in Path(directory).glob("_spark_metadata/[0-9]*")}
    newest_list = max([number for number, path in log.items() if path.suffix == ".compact"], default=-1)
    lines = [
        line for number in sorted(log) if number >= newest_list for line in log[number].read_text().splitlines()[1:]
    ]
    return [Path(unquote(urlsplit(json.loads(line)["path"]).path)) for line in lines]

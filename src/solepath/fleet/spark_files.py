"""Which files of Spark's file sink count. It needs neither Spark nor Java.

    pyarrow.parquet.read_table(committed("told"))               duckdb.read_parquet([*map(str, committed("told"))])

Spark lists the files of every batch that it has finished in `_spark_metadata` beside them, from time to time all in one
list. A task that was killed leaves files that nobody finished, or that hold what a later file holds too.
"""

from __future__ import annotations

import json
from pathlib import Path
from urllib.parse import unquote, urlsplit


def committed(directory: str | Path) -> list[Path]:
    """The files in a local `directory` of Spark's file sink that hold finished batches: what a reader other than Spark
    is to open. Each event is in them once. Empty before the first batch ends."""
    log = {int(path.stem): path for path in Path(directory).glob("_spark_metadata/[0-9]*")}
    whole = max([number for number, path in log.items() if path.suffix == ".compact"], default=-1)
    lines = [line for number in sorted(log) if number >= whole for line in log[number].read_text().splitlines()[1:]]
    return [Path(unquote(urlsplit(json.loads(line)["path"]).path)) for line in lines]

"""The job of the demonstration on Spark in local mode: `python -m solepath.fleet.demo.job STAGE/RUN`.

STAGE is a prepared directory (run.py), and RUN a directory in it for the events and the checkpoint. Each batch reads
one file, which holds what all wearers sent in a second."""

from __future__ import annotations

import json
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from pyspark.sql import SparkSession

from ...recipes import by_name
from ..fleet import Fleet
from ..spark import STORE, gait

EVENTS, CHECKPOINT, SENT, PLAN = "events", "checkpoint", "sent", "plan.json"
"""Directories of a run, and directory and file of a stage."""
SETTINGS: dict[str, Any] = {
    "spark.ui.enabled": "false",
    "spark.sql.streaming.minBatchesToRetain": "10000",  # kills are reported by the times of all batches
}


def main(run: str, fleet: Callable[[], Fleet] | None = None) -> None:
    """Run the job, or continue it from its checkpoint, to the end of all files; `fleet` makes another than the plan."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    directory = Path(run)
    plan = json.loads((directory.parent / PLAN).read_text())
    processes = plan["processes"]
    session = SparkSession.builder.master(f"local[{processes}]").config(map={**SETTINGS, **STORE})
    spark = session.config("spark.sql.shuffle.partitions", processes).getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    source = spark.readStream.schema("key string, value binary").option("maxFilesPerTrigger", 1)
    events = gait(source.parquet(str(directory.parent / SENT)), fleet or Fleet(by_name(plan["recipe"])))
    writer = events.writeStream.format("parquet").option("checkpointLocation", str(directory / CHECKPOINT))
    writer.trigger(availableNow=True).start(str(directory / EVENTS)).awaitTermination()


def _end_with_parent() -> None:
    """End this process when its parent ends in any way, which closes the pipe to our stdin; Spark ends with us."""
    os.read(0, 1)
    os._exit(1)


if __name__ == "__main__":
    main(sys.argv[1])

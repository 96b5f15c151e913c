"""The application that the tests on Kafka kill: python quix_job.py ADDRESS GROUP STATE_DIRECTORY RECIPE PARTITIONS."""

from __future__ import annotations

import sys

from quixstreams import Application
from quixstreams.models import TopicConfig

from solepath import recipes
from solepath.fleet import Fleet
from solepath.fleet.quix import gait

address, group, place, recipe, partitions = sys.argv[1:]
app = Application(
    address,
    consumer_group=group,
    auto_offset_reset="earliest",
    state_dir=place,
    commit_interval=2.0,
    # a killed member is missed after so long
    consumer_extra_config={"session.timeout.ms": 6000, "heartbeat.interval.ms": 1000},
    # the broker of the tests says that a partition ends where its last batch begins, and a changelog is read to there
    producer_extra_config={"batch.num.messages": 1},
)
kept = TopicConfig(num_partitions=int(partitions), replication_factor=1, extra_config={"retention.ms": "86400000"})
sent = app.topic(f"{group}-sent", value_deserializer="bytes", config=kept)
output = app.topic(f"{group}-events", key_serializer="str", config=kept)
gait(app.dataframe(sent), Fleet(recipes.by_name(recipe))).to_topic(output, key=lambda row: row["wearer"])
app.run()

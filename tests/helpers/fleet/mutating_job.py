"""The job of `fleet-demo` with a step that changes the state of one wearer: python mutating_job.py STAGE/RUN."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from attrs import evolve

from solepath.fleet import Fleet, NumberedEvent, Sent, Unreadable
from solepath.fleet.demo import job
from solepath.fleet.step.state import read_head, read_rest, write_state


class Mutating(Fleet):
    """A fleet that loses the session of the first wearer whenever it continues from a state."""

    def step(
        self, wearer: str, state: bytes | None, sent: Iterable[Sent | Unreadable]
    ) -> tuple[bytes, list[NumberedEvent]]:
        if wearer == "w00000" and state is not None:
            head = read_head(state)
            assert head is not None
            state = write_state(head, evolve(read_rest(state), session=None))
        return super().step(wearer, state, sent)


def make_mutating() -> Fleet:
    return Mutating()


if __name__ == "__main__":
    from mutating_job import make_mutating as make  # by name, as the workers import it

    job.main(sys.argv[1], make)

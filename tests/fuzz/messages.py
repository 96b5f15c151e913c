"""Mutated messages of a page: each is a command, or rejected by CommandError."""

from __future__ import annotations

import json
from random import Random

from changes import NUMBERS, changed_bytes, changed_value

from solepath.show.page.messages import TAKES_VALUE, CommandError, parse_command

MESSAGES = 500
"""Number of messages of a round."""


def run(seed: int) -> tuple[int, int]:
    """Parse some mutated messages; return their number, and how many of them were commands."""
    random, commands = Random(seed), 0
    for _ in range(MESSAGES):
        message = {"do": random.choice(list(TAKES_VALUE)), "value": random.choice((0.5, 1, 7.25, *NUMBERS))}
        changed = changed_value(message, random) if random.randrange(3) else message
        text = json.dumps(changed, default=str)
        if random.randrange(2):
            text = changed_bytes(text.encode("utf-8", "replace"), random).decode("utf-8", "replace")
        if not random.randrange(50):
            text = "[" * 100_000
        try:
            command = parse_command(text)
            commands += 1
            if (command.value is not None) is not TAKES_VALUE[command.do]:
                raise AssertionError(f"{command} of {text!r}")
        except CommandError as error:
            if len(str(error).splitlines()) != 1:
                raise AssertionError(f"a reason of more than one line: {error!r}") from None
    return MESSAGES, commands

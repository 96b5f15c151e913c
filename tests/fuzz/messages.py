"""Mutated messages of a page: each is a command, or rejected by CommandError."""

from __future__ import annotations

import json
from random import Random
from typing import Any

from changes import NUMBERS, changed_bytes, changed_value

from solepath.show.page.messages import HERE, TAKES_VALUE, CommandError, parse_command

MESSAGES = 500
"""Number of messages of a round."""


def run(seed: int) -> tuple[int, int]:
    """Parse some mutated messages; return their number, and how many of them were commands."""
    random, commands = Random(seed), 0
    for _ in range(MESSAGES):
        numbers = [random.choice((0.5, 1, 7.25, *NUMBERS)) for _ in range(3)]
        message: dict[str, Any] = {"do": random.choice(list(TAKES_VALUE)), "value": numbers[0]}
        if not random.randrange(3):
            message = {"do": HERE, "sigma": numbers[0], "at": numbers[1:], "level": "0"}
        changed = changed_value(message, random) if random.randrange(3) else message
        text = json.dumps(changed, default=str)
        if random.randrange(2):
            text = changed_bytes(text.encode("utf-8", "replace"), random).decode("utf-8", "replace")
        if not random.randrange(50):
            text = "[" * 100_000
        try:
            command = parse_command(text)
            commands += 1
            if (command.value is not None) is not TAKES_VALUE.get(command.do, False):
                raise AssertionError(f"{command} of {text!r}")
            if (command.position is not None) is not (command.do == HERE):
                raise AssertionError(f"{command} of {text!r}")
        except CommandError as error:
            if len(str(error).splitlines()) != 1:
                raise AssertionError(f"a reason of more than one line: {error!r}") from None
    return MESSAGES, commands

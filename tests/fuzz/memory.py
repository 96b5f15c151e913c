"""The memory that a process keeps from one round to the next, which must not grow."""

from __future__ import annotations

import os
from collections import deque
from pathlib import Path

WARM_ROUNDS = 10
"""Number of rounds of a target in a process that fill its caches and load its modules."""
ROUNDS = 5
"""Number of rounds of which the smallest memory counts, because one round may leave garbage that the next one frees."""
MOST_GROWTH = 24_000_000
"""Largest growth after the first rounds, bytes.

Sound rounds grow by 2 to 5 MB in a minute, as modules are loaded and the allocator keeps pieces. Rounds that keep 2 kB
of each of their 500 packets grow by a megabyte each, which breaks the bound after 12,000 packets of a process."""
MOST_GROWTH_OF_FILES = 80_000_000
"""The same for files, whose archives of tens of megabytes leave larger pieces: 22 MB in a minute."""
STATUS = Path("/proc/self/statm")
"""Where Linux counts the pages of a process; elsewhere nothing is measured."""


class Memory:
    """The memory of this process after each round of one target."""

    def __init__(self, most_growth: int = MOST_GROWTH) -> None:
        self.most_growth = most_growth
        self.rounds = 0
        self.newest: deque[int] = deque(maxlen=ROUNDS)
        """Memory after the newest rounds, bytes."""
        self.first = 0
        """Memory after the rounds that fill caches, bytes."""

    def check_growth(self) -> None:
        """Measure after a round; raise AssertionError when the process has grown too much since its first rounds."""
        if not STATUS.exists():
            return
        self.newest.append(int(STATUS.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE"))
        self.rounds += 1
        if self.rounds == WARM_ROUNDS:
            self.first = max(self.newest)
        growth = min(self.newest) - self.first
        if self.rounds > WARM_ROUNDS and growth > self.most_growth:
            count = self.rounds - WARM_ROUNDS
            raise AssertionError(f"{count} rounds have left {growth / 1e6:.0f} MB more, which no single one shows")

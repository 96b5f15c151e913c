"""For a service with many wearers: data come in batches, states survive a kill, and every event is there once.

    python examples/fleet.py FOLDER

Ten emulated wearers send what their phones have received, a second at a time. You see the job die by SIGKILL in the
middle, twice, go on from its database, and at the end the strides of all wearers from a query. State and events of a
batch are one transaction of SQLite, so a kill leaves both or neither. docs/fleet.md has engines for many machines.
"""

import os
import signal
import sqlite3
import subprocess
import sys
from pathlib import Path

from solepath import recipes
from solepath.emulate import Route, emulate
from solepath.fleet import Fleet, Sent

BATCH = 200  # packets: one second of two insoles; a step for each packet would open and pack the state 200 times
TABLES = """create table if not exists states (wearer primary key, next, state);
create table if not exists events (wearer, number, event, t, primary key (wearer, number));"""


def job(folder: Path, steps: int) -> None:
    """Use all that was sent and is not yet in the database; `steps` is after how many batches the job is killed."""
    fleet, database = Fleet(recipes.DEFAULT), sqlite3.connect(folder / "fleet.db")
    database.executescript(TABLES)
    packets = emulate(Route().stand(1).walk(4).stop(1), seed=1).packets  # what an app would read from its queue
    for wearer in [f"w-{number:02}" for number in range(10)]:
        found = database.execute("select next, state from states where wearer = ?", [wearer]).fetchone()
        start, state = found or (0, None)
        for first in range(start, len(packets), BATCH):
            batch = packets[first : first + BATCH]
            state, events = fleet.step(wearer, state, [Sent(wearer, first + k, one) for k, one in enumerate(batch)])
            with database:  # one transaction
                database.execute("replace into states values (?, ?, ?)", [wearer, first + len(batch), state])
                rows = [(wearer, one.number, type(one.event).__name__, one.event.t) for one in events]
                database.executemany("insert into events values (?, ?, ?, ?)", rows)
            steps -= 1
            if steps == 0:
                os.kill(os.getpid(), signal.SIGKILL)


folder = Path(sys.argv[1])
if len(sys.argv) > 2:
    job(folder, int(sys.argv[2]))
    sys.exit()
folder.mkdir(exist_ok=True)
for steps in (20, 25, -1):
    done = subprocess.run([sys.executable, __file__, folder, str(steps)], check=False)
    (count,) = sqlite3.connect(folder / "fleet.db").execute("select count(*) from events").fetchone()
    print(f"{'killed' if done.returncode else 'finished'} with {count} events in the database")
strides = "select wearer, count(*) from events where event = 'StrideTaken' group by wearer"
for wearer, count in sqlite3.connect(folder / "fleet.db").execute(strides):
    print(f"{wearer}: {count} strides")

"""For the developer of an app: a walk is saved in the middle, and goes on as if nothing had happened.

    python examples/save_and_resume.py

A snapshot is plain data, so JSON, a database or a message can hold it.
"""

import json

from solepath import Event, Session
from solepath.emulate import Route, emulate

walk = emulate(Route().stand(2).walk(10, speed=1.2).stop(2), seed=3)
middle = len(walk.packets) // 2

# The first half ends in the middle of a stride.
session = Session()
events: list[Event] = session.feed(walk.packets[:middle])
text = json.dumps(session.snapshot())
print(f"{len(events)} events so far, saved in {len(text) / 1000:.0f} kB of JSON")
del session

# The second half starts here. Session.restore raises SnapshotError for anything but a snapshot of this version.
session = Session.restore(json.loads(text))
events += session.feed(walk.packets[middle:])
events += session.finish()

# The same walk without a pause gives the same events, to the last bit of every number.
whole_session = Session()
is_same = whole_session.feed(walk.packets) + whole_session.finish() == events
print(f"{len(events)} events in the end; the same as without the pause: {is_same}")

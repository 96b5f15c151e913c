"""The lists of a scene: whole for a new watcher, and then only what was added."""

from __future__ import annotations

from typing import Any

from attrs import frozen

from .lists import RecentItems, ThinnedTrack, WalkedTrack


@frozen
class GrowingLists:
    """The lists of a scene that a frame sends only in part; `tracks` by name, `phases` by foot, others by their key."""

    tracks: dict[str, WalkedTrack]
    phases: dict[str, RecentItems[Any]]
    places: ThinnedTrack[Any]
    others: dict[str, RecentItems[Any]]

    def whole(self) -> dict[str, Any]:
        """Return the members of a scene."""
        return {
            "tracks": {name: list(track.points) for name, track in self.tracks.items()},
            "places": list(self.places.points),
            "phases": {foot: list(one.items) for foot, one in self.phases.items()},
            **{key: list(one.items) for key, one in self.others.items()},
        }

    def empty(self) -> dict[str, Any]:
        """Return the members of the frame in a scene, which has nothing new."""
        return {
            "phases": {foot: [] for foot in self.phases},
            "tracks": {name: [] for name in self.tracks},
            "places": [],
            **{key: [] for key in self.others},
        }

    def numbers(self) -> dict[str, int]:
        """Return for each list how many items were ever added."""
        numbers = {f"tracks {name}": track.count for name, track in self.tracks.items()}
        numbers |= {f"phases {foot}": one.count for foot, one in self.phases.items()}
        return numbers | {"places": self.places.count, **{key: one.count for key, one in self.others.items()}}

    def since(self, sent: dict[str, int]) -> dict[str, Any] | None:
        """Return the members of a frame after the earlier `numbers` in `sent`; None if some items are not kept."""
        tracks = {name: track.since(sent[f"tracks {name}"]) for name, track in self.tracks.items()}
        places = self.places.since(sent["places"])
        if places is None or None in tracks.values():
            return None
        phases = {foot: one.since(sent[f"phases {foot}"]) for foot, one in self.phases.items()}
        news = {
            "tracks": {name: points for name, points in tracks.items() if points},
            "phases": {foot: started for foot, started in phases.items() if started},
            "places": places,
            **{key: one.since(sent[key]) for key, one in self.others.items()},
        }
        return {key: value for key, value in news.items() if value}

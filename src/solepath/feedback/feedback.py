"""From a session's events to the signals that a wearer gets, without any output, clock or thread."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..body.activity.reconcile import BOUT_PAUSE, EDGE, GAITS
from ..events import ActivityChanged, ClockReset, DefectFound, FootMoved, StrideTaken
from ..events.happening import BaseEvent, json_ready
from ..saving.codec import Json, SnapshotError, checksum, load, save
from ..session.arguments import check_now
from ..types import Activity, Foot
from ..types.attrs import define, field, frozen
from ..types.checking import describe, find_fault
from ..types.plain import plain_copy
from ..types.vector import TIME_EPSILON
from .rule import Rule, Value, WalkNow, is_sound

VERSION = 1
"""Version of a snapshot, increased by 1 with every release that changes its content; no other can be restored."""


@frozen
class Signal:
    """What the wearer shall get: a sound, a vibration. Give it at once, and not after its deadline."""

    rule: Rule
    """Rule that it follows from."""
    foot: Foot | None
    """Foot that it is about; None for both."""
    t: float
    """Time of the cause, s: of the contact, or of the moment at which the stance passed the limit."""
    known_at: float
    """Time at which the event that shows it was known, s, packets' clock."""
    deadline: float
    """Time after which it must not be given, s, packets' clock: it would confuse the wearer."""
    value: float | None
    """Value that is beyond the limit, in the limit's unit; None for a rule without a limit."""
    limit: float | None
    """Limit of the rule; None without one."""

    def to_dict(self) -> dict[str, Any]:
        """Return the signal as plain data for strict JSON; `signal` is the name of the rule's class."""
        values = json_ready(self)
        return {"signal": type(self.rule).__name__, **{key: values[key] for key in values if key != "rule"}}


@define
class RuleState:
    """What is kept for one rule."""

    is_armed: bool = True
    """False after a signal, until a value is inside `rearm` or nobody walks."""
    newest: float | None = None
    """Time of the cause of the newest signal, s; None before any."""


@define
class FeedbackState:
    """The whole state of a Feedback."""

    rules: list[RuleState]
    walk: WalkNow = field(factory=WalkNow)
    activity: Activity = Activity.UNKNOWN
    """Newest activity that was reported, final or not."""
    stride_at: float | None = None
    """End of the newest sound stride of either foot, s; None before any, and after the clock restarted."""
    stride_time: float = 0.0
    """Its duration, s."""
    spoilt: list[Foot] = field(factory=list)
    """Feet whose data cannot be right; a sound stride ends that."""
    now: float | None = None
    """Newest time of the host that was given, s; None before any."""


class Feedback:
    """Turns the events of one wearer's session into signals, by rules.

    `activities` are those in which there are signals: by default walking alone. There is none while the newest activity
    that was reported, also provisionally, is another one (standing, unknown: a bicycle, a car, a chair), but for 1.5 s
    after a sound stride, or for its duration if it was slower: the next contact belongs to the walk, whatever a slow
    stance looks like. There is none either when no sound stride has ended for 3 s. So the first signal of a bout comes
    when its first strides are known: at the fourth contact, 1.5 s after the first one at 1.5 m/s, 2.7 s at 0.5 m/s.
    After a pause of less than 3 s it comes at once.

    A signal is dropped if its deadline has passed. It never follows from a foot whose data are wrong, from an event
    that lies in a gap, or from a stance in which a link was lost or samples are missing for longer than 60 ms.

    Times are those of the packets' clock. Raises TypeError and ValueError for rules that are none or have impossible
    values. The same events in any cut give the same signals; `now` is an input like them."""

    __slots__ = ("_activities", "_readers", "_rules", "_state")

    def __init__(self, rules: Iterable[Rule], activities: Iterable[Activity] = (Activity.WALKING,)) -> None:
        self._rules = tuple([_checked(rule) for rule in rules])
        given = set(activities)
        if not given <= set(GAITS):
            raise ValueError(f"signals are for {', '.join([one.value for one in GAITS])}")
        self._activities = tuple([one for one in GAITS if one in given])
        self._readers: dict[type[BaseEvent], list[int]] = {}
        for number, rule in enumerate(self._rules):
            for kind in rule.reads:
                self._readers.setdefault(kind, []).append(number)
        self._state = FeedbackState([RuleState() for _ in self._rules])

    @property
    def rules(self) -> tuple[Rule, ...]:
        """The rules, in the order in which an event gives their signals."""
        return self._rules

    @property
    def needs_poses(self) -> bool:
        """True if a rule needs the live positions: `Session(poses=feedback.needs_poses, impacts=True)`."""
        return FootMoved in self._readers

    def feed(self, events: Iterable[BaseEvent], now: float | None = None) -> list[Signal]:
        """Add the events that the session returned, and return the signals to give at once.

        `now` is the host's time, s, on the packets' clock, from which it is seen that a deadline has passed. Without
        it, that is the time at which the event became known, or the newest `now` before: give it wherever packets wait,
        as after a pause of the screen. Raises ValueError for NaN or infinity."""
        state, signals = self._state, list[Signal]()
        if now is not None:
            state.now = check_now(now)
        for event in events:
            self._note(event)
            for number in self._readers.get(type(event), ()):
                if not self._is_walking(event.t):
                    break
                value = self._rules[number].measure(event, state.walk)
                if value is not None and value.foot not in state.spoilt:
                    signal = self._judge(number, value, event.known_at)
                    if signal is not None:
                        signals.append(signal)
        return signals

    def advance(self, now: float) -> list[Signal]:
        """Let time pass until `now`, s, packets' clock, so that what arrives too late gives no signal.

        No rule gives a signal by the time alone: without samples nobody knows what the feet do. Raises ValueError for
        NaN or infinity."""
        return self.feed((), now)

    def _note(self, event: BaseEvent) -> None:
        state = self._state
        if isinstance(event, ActivityChanged):
            state.activity = event.activity
            return
        if not self._is_walking(event.t):  # of a past activity: the one that follows it comes at once
            state.walk.cycles.clear()
            for one in state.rules:
                one.is_armed = True
        state.walk.add(event)
        match event:
            case FootMoved():  # nearly always
                pass
            case StrideTaken(foot=foot) if is_sound(event):
                state.stride_at, state.stride_time = event.t, event.t_end - event.t_start
                state.spoilt = [one for one in state.spoilt if one is not foot]
            case DefectFound(spoilt_foot=foot) if foot is not None and foot not in state.spoilt:
                state.spoilt.append(foot)
            case ClockReset():
                state.stride_at = state.now = None
                for one in state.rules:
                    if one.newest is not None and one.newest > event.t:
                        one.newest = None

    def _is_walking(self, t: float) -> bool:
        state, activity = self._state, self._state.activity
        if state.stride_at is None or (activity in GAITS and activity not in self._activities):
            return False
        is_named = activity in self._activities
        return t - state.stride_at <= (BOUT_PAUSE if is_named else min(BOUT_PAUSE, max(EDGE, state.stride_time)))

    def _judge(self, number: int, value: Value, known_at: float) -> Signal | None:
        """Return the signal that a value gives, if any."""
        rule, kept = self._rules[number], self._state.rules[number]
        if rule.is_rearmed(value.value):
            kept.is_armed = True
        since = None if kept.newest is None else value.t - kept.newest
        is_due = kept.is_armed or (rule.remind is not None and since is not None and since >= rule.remind)
        deadline, now = value.t + rule.within, known_at if self._state.now is None else max(known_at, self._state.now)
        is_refractory = since is not None and since < max(rule.pause, TIME_EPSILON)
        if not rule.is_beyond(value.value) or not is_due or is_refractory or now > deadline:
            return None
        kept.is_armed, kept.newest = rule.limit is None, value.t
        shown = None if rule.limit is None else value.value
        return Signal(rule, value.foot, value.t, max(known_at, value.t), deadline, shown, rule.limit)

    def snapshot(self) -> dict[str, Json]:
        """Return rules and state as plain data for JSON; raise TypeError for a rule that cannot be saved."""
        saved_state = save(self._state)
        rules: Json = [{"rule": type(rule).__name__, "is": save(rule)} for rule in self._rules]
        activities: Json = [one.value for one in self._activities]
        check = checksum([rules, activities, saved_state])
        return {"feedback": VERSION, "check": check, "rules": rules, "activities": activities, "state": saved_state}

    @classmethod
    def restore(
        cls, saved: Any, rules: Iterable[Rule], activities: Iterable[Activity] = (Activity.WALKING,)
    ) -> Feedback:
        """Return a Feedback that continues from the snapshot `saved`; give rules and activities again, unchanged.

        Raises SnapshotError for a damaged snapshot, one of another version, and one that was taken with other rules."""
        feedback = cls(rules, activities)
        fresh = feedback.snapshot()
        if not isinstance(saved, dict) or saved.keys() != fresh.keys():
            raise SnapshotError("not a snapshot of a feedback, which is a dict with feedback, check, rules and state")
        version = saved["feedback"]
        if version != VERSION:
            raise SnapshotError(f"a snapshot of version {describe(version)}; this release reads {VERSION} alone")
        if any([saved[key] != fresh[key] for key in ("rules", "activities")]):
            raise SnapshotError("a snapshot of a feedback is restored with the rules and activities that it had")
        state = load(FeedbackState, saved["state"])
        if len(state.rules) != len(feedback._rules):
            raise SnapshotError("the snapshot was damaged: it has a state for another number of rules")
        feedback._state = state
        if feedback.snapshot()["check"] != saved["check"]:
            raise SnapshotError("the snapshot was damaged: its checksum is another")
        return feedback


def _checked(rule: Rule) -> Rule:
    """Return a copy of a rule with plain numbers; raise TypeError for another type, ValueError for wrong values."""
    if not isinstance(rule, Rule):
        raise TypeError(f"a rule derives from Rule; this is a {type(rule).__name__}")
    try:
        hash(rule)
    except TypeError:
        text = f"a {type(rule).__name__} keeps something that changes: a rule keeps nothing, a part of the session may"
        raise TypeError(text) from None
    own = plain_copy(rule)
    fault = find_fault(own, type(own))
    if fault is not None:
        raise ValueError(f"{type(own).__name__}: {fault}")
    return own

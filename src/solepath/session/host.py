"""A session and the setups of its devices, for a program that does Bluetooth itself: a page in a browser, an app.

    host = Host(Session(), observe)
    host.add("C0:FF:EE:00:00:01", None)             # None: an insole, which reports its site
    commands = host.connect("C0:FF:EE:00:00:01", name, characteristics, now)
    commands = host.answer("C0:FF:EE:00:00:01", value, now)
    host.notify("C0:FF:EE:00:00:01", "insole/frame", value, now)
    commands = host.advance(now)                    # at least five times a second

The program does what the commands say, one request of a device at a time, and reports the outcome. All times are of one
clock that never goes back, s. `json_host.py` has the same calls as JSON messages."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..events import Event
from ..link.profile import Profile
from ..link.setup.config import DeviceConfig
from ..link.setup.device_setup import (
    DeviceSetup,
    GattCharacteristic,
    RecentTroubles,
    Request,
    Value,
    find_profile,
    trouble,
)
from ..link.setup.roster import Member, Roster
from ..types import Packet, Site
from ..types.attrs import define, field, frozen
from .session import Session

TICK = "receiver/tick"
"""Channel of a packet that only says that time has passed (protocol/receiver.md)."""

TICK_INTERVAL = 0.1
"""Time without any packet after which such a packet is fed, s: four a second are needed (protocol/receiver.md), and
time that passes five times a second gives them in spite of its jitter."""

Observe = Callable[[Packet | None, list[Event]], object]
"""Function that gets each packet, and the events that followed; None for events without a packet."""


@frozen
class HostCommand:
    """Order to do `request` with a device, or without one to disconnect it for the `reason`."""

    device: str
    request: Request | None = None
    reason: str = ""
    is_wrong: bool = False
    """True for a device that is not the configured one: it must not be connected again for a minute."""


@define(eq=False)
class HostDevice:
    """A device that a host uses; its packets name `address`. `setup` is None while it is not connected."""

    member: Member
    address: str
    setup: DeviceSetup | None = None
    recent: RecentTroubles = field(factory=RecentTroubles)

    def packet(self, t: float, channel: str, data: bytes) -> Packet:
        """Return a packet of the device, which names it from when its site is certain: a session binds a site to it."""
        return Packet(t, self.member.site, channel, data, self.address if self.member.address else "")


class Host:
    """A session that is fed by devices, each named by the address or identifier that the system has for it.

    It knows the built-in devices and those of `Session(profiles=...)`. `observe` gets every packet that the session was
    fed, so that a program can record it, and its events. A call with a device that was not added raises ValueError."""

    def __init__(self, session: Session, observe: Observe) -> None:
        self.session, self.observe, self.roster = session, observe, Roster()
        self.profiles: dict[str, Profile] = {one.name: one.profile for one in session._kinds.drivers}
        """Profiles of the devices of `Session(profiles=...)` by name; they go before the built-in ones."""
        self._devices: dict[str, HostDevice] = {}

    def add(self, device: str, site: Site | None, profile: Profile | None = None, address: str | None = None) -> None:
        """Add a device that is worn at `site`; None for an insole, which reports its site.

        Without a profile, the connected device shows of which kind it is. Its packets name `address`, by default
        `device`; "" where a system gives a device another identifier each time an app starts. Nothing happens if it was
        added before with the same profile. Raises ValueError when it was added otherwise, another device is at the
        site, or both feet have one."""
        known = self._devices.get(device)
        if known is None:
            [member] = self.roster.add([DeviceConfig(site, device, profile)])
            self._devices[device] = HostDevice(member, device if address is None else address)
        elif (known.member.config.site, known.member.config.profile) != (site, profile):
            raise ValueError(f"{device!r:.80} is at the {known.member.site.words}: remove it first")

    def remove(self, device: str) -> None:
        """Remove a device that is not connected; another one may be added at its site.

        The session goes on to accept no other device there: call its `bind` before another is connected."""
        if self._get(device).setup is not None:
            raise ValueError(f"{device!r:.80} is connected")
        self.roster.remove(self._devices.pop(device).member)

    def connect(
        self,
        device: str,
        name: str,
        characteristics: Iterable[GattCharacteristic],
        now: float,
        *,
        signal: int | None = None,
    ) -> list[HostCommand]:
        """Start the setup of a device that was connected at `now`; an earlier connection of it has ended thereby.

        `name` is the name that it advertises, "" when unknown, and `signal` the signal strength, dBm. Of several
        characteristics with one UUID in a service, the first counts."""
        one, found = self._get(device), frozenset(characteristics)
        self.disconnect(device, now)
        profile = one.member.config.profile or find_profile(name, found, self.profiles.values())
        if profile is None:
            sentence = f"{name or device} is of no kind that is known here: say its profile"
            self._feed(one, now, [trouble(sentence)])
            return [HostCommand(device, None, sentence, True)]
        one.setup = DeviceSetup(self.roster, one.member, profile, found, device, name, signal)
        return self._use(device, now, one.setup.start(now))

    def answer(self, device: str, value: bytes, now: float) -> list[HostCommand]:
        """Note that the device has done the request; `value` is what was read, b"" of others."""
        return self._use(device, now, self._setup(device).answer(value, now))

    def reject(self, device: str, reason: str, now: float) -> list[HostCommand]:
        """Note that the device has rejected the request while the connection stands."""
        return self._use(device, now, self._setup(device).reject(reason, now))

    def notify(self, device: str, channel: str, value: bytes, now: float) -> None:
        """Feed a notification that came at `now`.

        One of a device that is not connected, or not yet known to be the configured one, is left out."""
        one = self._get(device)
        if one.setup is not None and one.setup.end is None and one.member.address:
            one.setup.add_notification(channel, now)
            self._feed_packet(one.packet(now, channel, value))

    def report(self, device: str, sentence: str, now: float) -> None:
        """Feed a sentence on what failed: a connection or a request without an answer, for instance."""
        self._feed(self._get(device), now, [trouble(sentence)])

    def disconnect(self, device: str, now: float) -> None:
        """Note that the connection was lost or given up."""
        one = self._get(device)
        if one.setup is not None:
            values, one.setup = one.setup.disconnect(), None
            self._feed(one, now, values)

    def advance(self, now: float) -> list[HostCommand]:
        """Let time pass until `now`, and check the streams of all devices.

        If no packet came for a while, one that only says so is fed; without a device the session advances."""
        commands: list[HostCommand] = []
        for device, one in self._devices.items():
            due = None if one.setup is None else one.setup.next_check_at()
            if one.setup is not None and due is not None and now >= due:
                commands += self._use(device, now, one.setup.check(now))
        newest = self.session.now
        if newest is None or now - newest >= TICK_INTERVAL:
            if self._devices:
                self._feed_packet(Packet(now, next(iter(self._devices.values())).member.site, TICK, b""))
            else:
                self.observe(None, self.session.advance(now))
        return commands

    def restart_clock(self, now: float) -> None:
        """Go on at `now` after the clock restarted or was set, for instance because the phone did."""
        for one in self._devices.values():
            one.recent = RecentTroubles()
            one.member.wrong_since.clear()
            if one.setup is not None:
                one.setup.restart_clock(now)
        self.observe(None, self.session.restart_clock(now))

    def finish(self) -> None:
        """End the session; no call but `remove` may follow."""
        for one in self._devices.values():
            one.setup = None
        self.observe(None, self.session.finish())

    def _use(self, device: str, now: float, values: list[Value]) -> list[HostCommand]:
        """Feed the values of a setup and return what it requests next."""
        one, setup = self._devices[device], self._setup(device)
        self._feed(one, now, values)
        if setup.end is not None:
            return [HostCommand(device, None, setup.end, device in one.member.wrong_since)]
        return [] if setup.request is None else [HostCommand(device, setup.request)]

    def _feed(self, one: HostDevice, now: float, values: list[Value]) -> None:
        for channel, data in one.recent.leave_out(values, now):
            self._feed_packet(one.packet(now, channel, data))

    def _feed_packet(self, packet: Packet) -> None:
        self.observe(packet, self.session.feed(packet))

    def _get(self, device: str) -> HostDevice:
        if device not in self._devices:
            raise ValueError(f"{device!r:.80} was not added")
        return self._devices[device]

    def _setup(self, device: str) -> DeviceSetup:
        setup = self._get(device).setup
        if setup is None:
            raise ValueError(f"{device!r:.80} is not connected")
        return setup

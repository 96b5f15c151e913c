"""Virtual Bluetooth controllers on a shared medium: bumble's, corrected here to follow the Core specification.

Three corrections matter in tests of a reconnect. A cancelled connection request ends. When two centrals request a
connection, the device accepts one, and the other does not keep its half-open link. A scan response has its own data.
Extended advertising and privacy are left out because nothing here needs them."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from functools import partial
from math import ceil

from bumble import core, hci, ll
from bumble.controller import Connection, Controller
from bumble.link import LocalLink

_LOGGER = logging.getLogger("bumble")
if _LOGGER.level == logging.NOTSET:  # its warnings are harmless: packets in flight at the end of a link
    _LOGGER.setLevel(logging.CRITICAL)

RSSI = -50
"""Received signal strength of every advertisement, dBm; the virtual link has no distances."""


class VirtualMedium(LocalLink):
    """The radio medium that virtual controllers share.

    `interval` is the time between the connection events of every link, s; None: packets do not wait."""

    def __init__(self, interval: float | None = None) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._interval = interval
        self._events: dict[frozenset[hci.Address], ConnectionEvents] = {}

    def send_advertising_pdu(self, sender_controller: Controller, packet: ll.AdvertisingPdu) -> None:
        if self._interval is not None and isinstance(packet, ll.ConnectInd):
            self._end(packet.initiator_address, packet.advertiser_address)
            addresses = frozenset((packet.initiator_address, packet.advertiser_address))
            self._events[addresses] = ConnectionEvents(self._interval)
        super().send_advertising_pdu(sender_controller, packet)

    def send_acl_data(
        self,
        sender_controller: Controller,
        destination_address: hci.Address,
        transport: core.PhysicalTransport,
        data: bytes,
    ) -> None:
        deliver = partial(super().send_acl_data, sender_controller, destination_address, transport, data)
        events = self._events.get(frozenset((sender_controller.random_address, destination_address)))
        if events is None:
            deliver()
        else:
            events.send(deliver)

    def send_ll_control_pdu(
        self, sender_address: hci.Address, receiver_address: hci.Address, packet: ll.ControlPdu
    ) -> None:
        deliver = partial(super().send_ll_control_pdu, sender_address, receiver_address, packet)
        events = self._events.get(frozenset((sender_address, receiver_address)))
        if events is None:
            deliver()
        elif isinstance(packet, ll.TerminateInd):
            # bumble's controller forgets a link as soon as it ends it, so earlier packets must be delivered first
            events.flush()
            deliver()
            self._end(sender_address, receiver_address)
        else:
            events.send(deliver)

    def _end(self, one: hci.Address, other: hci.Address) -> None:
        events = self._events.pop(frozenset((one, other)), None)
        if events is not None:
            events.clear()

    def lose(self, controller: Controller, connection: Connection) -> None:
        """End a link as when the radio falls silent: both sides report a supervision timeout."""
        self._end(connection.self_address, connection.peer_address)
        for candidate in [candidate for candidate in self.controllers if candidate is not controller]:
            its_connection = candidate.le_connections.get(connection.self_address)
            if its_connection is not None and its_connection.self_address == connection.peer_address:
                candidate.on_le_disconnected(its_connection, hci.HCI_ErrorCode.CONNECTION_TIMEOUT_ERROR)
        if controller.le_connections.get(connection.peer_address) is connection:
            controller.on_le_disconnected(connection, hci.HCI_ErrorCode.CONNECTION_TIMEOUT_ERROR)

    def leave(self, controller: Controller) -> None:
        """Remove a controller from the medium, as if it had lost power."""
        controller.le_legacy_advertiser.stop()
        for connection in list(controller.le_connections.values()):
            self.lose(controller, connection)
        for addresses in [addresses for addresses in self._events if controller.random_address in addresses]:
            self._end(*addresses)
        self.controllers.discard(controller)


class VirtualController(Controller):
    """A controller on the medium; `advertisement()` returns the data to advertise, or None for no advertisement."""

    le_acl_data_packet_length = 251  # data length extension: an ATT MTU of 247 needs no fragments
    le_features = Controller.le_features & ~(
        hci.LeFeatureMask.LE_EXTENDED_ADVERTISING
        | hci.LeFeatureMask.LE_PERIODIC_ADVERTISING
        | hci.LeFeatureMask.LL_PRIVACY
    )

    def __init__(self, name: str, link: VirtualMedium, advertisement: Callable[[], bytes | None] | None = None) -> None:
        super().__init__(name, link=link)
        self.medium = link  # bumble calls the medium `link`
        self.advertisement = advertisement

    def send_advertising_pdu(self, packet: ll.AdvertisingPdu) -> None:
        """Send a PDU on the advertising channels; an advertisement has the data that the device has now."""
        if isinstance(packet, ll.AdvInd) and self.advertisement is not None:
            data = self.advertisement()
            if data is None:
                return
            packet = ll.AdvInd(packet.advertiser_address, data)
        super().send_advertising_pdu(packet)

    def on_advertising_pdu(self, pdu: ll.AdvInd | ll.AdvExtInd) -> None:
        """Report the advertisement, and in an active scan also the scan response of the device."""
        address = pdu.advertiser_address
        if self.le_scan_enable:
            self._report(hci.HCI_LE_Advertising_Report_Event.EventType.ADV_IND, address, pdu.data)
            if self.le_scan_type == hci.HCI_LE_Set_Scan_Parameters_Command.ACTIVE_SCANNING:
                device = self.medium.find_le_controller(address)
                answer = device.le_legacy_advertiser.scan_response_data if device is not None else b""
                self._report(hci.HCI_LE_Advertising_Report_Event.EventType.SCAN_RSP, address, answer)
        pending = self.pending_le_connection
        if pending is not None and pending.peer_address == address:
            self.create_le_connection(address)

    def _report(self, kind: int, address: hci.Address, data: bytes) -> None:
        report = hci.HCI_LE_Advertising_Report_Event.Report(
            event_type=hci.HCI_LE_Advertising_Report_Event.EventType(kind),
            address_type=address.address_type,
            address=address,
            data=data,
            rssi=RSSI,
        )
        self.send_hci_packet(hci.HCI_LE_Advertising_Report_Event([report]))

    def on_le_connect_ind(self, packet: ll.ConnectInd) -> None:
        """Accept a connection; when not advertising, do not answer, so that the link is not established (0x3E)."""
        is_addressed = packet.advertiser_address == self.random_address
        if is_addressed and not self.le_legacy_advertiser.enabled:
            initiator = self.medium.find_le_controller(packet.initiator_address)
            half_open_link = initiator.le_connections.get(packet.advertiser_address) if initiator is not None else None
            if initiator is not None and half_open_link is not None:
                initiator.on_le_disconnected(
                    half_open_link, hci.HCI_ErrorCode.CONNECTION_FAILED_TO_BE_ESTABLISHED_ERROR
                )
            return
        super().on_le_connect_ind(packet)

    def on_hci_le_create_connection_cancel_command(
        self, _command: hci.HCI_LE_Create_Connection_Cancel_Command
    ) -> hci.HCI_StatusReturnParameters:
        """End the attempt by a connection complete event of status 0x02 (Core specification Vol 4, Part E, 7.8.13)."""
        pending, self.pending_le_connection = self.pending_le_connection, None
        if pending is not None:
            self.send_hci_packet(
                hci.HCI_LE_Connection_Complete_Event(
                    status=hci.HCI_ErrorCode.UNKNOWN_CONNECTION_IDENTIFIER_ERROR,
                    connection_handle=0,
                    role=hci.Role.CENTRAL,
                    peer_address_type=pending.peer_address.address_type,
                    peer_address=pending.peer_address,
                    connection_interval=0,
                    peripheral_latency=0,
                    supervision_timeout=0,
                    central_clock_accuracy=0,
                )
            )
        return hci.HCI_StatusReturnParameters(hci.HCI_ErrorCode.SUCCESS)


_INTERVAL_TOLERANCE = 1e-6
"""Rounding error by which an event may seem just past and is still used, as a share of an interval."""


class ConnectionEvents:
    """The connection events of one link, `interval` s apart; the first is `interval` s after the link starts.

    At an event all ready packets are sent in order; unlike on a real radio, their number is not limited. An answer to
    a packet is sent at the next event."""

    def __init__(self, interval: float) -> None:
        self.interval = interval
        self._loop = asyncio.get_running_loop()
        self._t_start = self._loop.time()
        self._last_event = 0
        """Number of the last event at which a packet was sent."""
        self._ready_packets: list[Callable[[], None]] = []
        self._timer: asyncio.TimerHandle | None = None

    def send(self, deliver: Callable[[], None]) -> None:
        """Call `deliver`, which delivers one packet, at the next event."""
        self._ready_packets.append(deliver)
        if self._timer is None:
            number = max(
                self._last_event + 1, ceil((self._loop.time() - self._t_start) / self.interval - _INTERVAL_TOLERANCE)
            )
            self._timer = self._loop.call_at(self._t_start + number * self.interval, self._event, number)

    def flush(self) -> None:
        """Send all ready packets now: at an event, or because one side ends the link."""
        ready_packets = self._ready_packets
        self.clear()
        for deliver in ready_packets:
            deliver()

    def clear(self) -> None:
        """Discard all ready packets and cancel the timer of the next event."""
        self._ready_packets = []
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _event(self, number: int) -> None:
        self._last_event = number
        self.flush()

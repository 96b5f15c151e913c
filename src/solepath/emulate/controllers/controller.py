"""The virtual radio: bumble's controllers on a shared link, mended where they fall short of the Core specification.

Three things matter to whoever tests a reconnect. A connection request that is taken back must really end; a device that
has just accepted somebody else must not leave the second caller with a link that is dead from the beginning; and a scan
response must carry its own data. Extended advertising and privacy are left out: nothing here needs them.
"""

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
if _LOGGER.level == logging.NOTSET:  # it warns of much that is no trouble: packets in flight when their link ends, ...
    _LOGGER.setLevel(logging.CRITICAL)

RSSI = -50  # dBm; there are no distances in this air


class VirtualAir(LocalLink):
    """The air that virtual controllers share.

    `interval`: s between the connection events of every link made in it; None: everything goes at once.
    """

    def __init__(self, interval: float | None = None) -> None:
        super().__init__()  # type: ignore[no-untyped-call]
        self._interval = interval
        self._events: dict[frozenset[hci.Address], ConnectionEvents] = {}

    def send_advertising_pdu(self, sender_controller: Controller, packet: ll.AdvertisingPdu) -> None:
        if self._interval is not None and isinstance(packet, ll.ConnectInd):
            self._end(packet.initiator_address, packet.advertiser_address)
            ends = frozenset((packet.initiator_address, packet.advertiser_address))
            self._events[ends] = ConnectionEvents(self._interval)
        super().send_advertising_pdu(sender_controller, packet)

    def send_acl_data(
        self,
        sender_controller: Controller,
        destination_address: hci.Address,
        transport: core.PhysicalTransport,
        data: bytes,
    ) -> None:
        go = partial(super().send_acl_data, sender_controller, destination_address, transport, data)
        events = self._events.get(frozenset((sender_controller.random_address, destination_address)))
        if events is None:
            go()
        else:
            events.send(go)

    def send_ll_control_pdu(
        self, sender_address: hci.Address, receiver_address: hci.Address, packet: ll.ControlPdu
    ) -> None:
        go = partial(super().send_ll_control_pdu, sender_address, receiver_address, packet)
        events = self._events.get(frozenset((sender_address, receiver_address)))
        if events is None:
            go()
        elif isinstance(packet, ll.TerminateInd):
            # bumble's controllers forget a link that they end, so what was said before must be heard now
            events.flush()
            go()
            self._end(sender_address, receiver_address)
        else:
            events.send(go)

    def _end(self, one: hci.Address, other: hci.Address) -> None:
        events = self._events.pop(frozenset((one, other)), None)
        if events is not None:
            events.end()

    def lose(self, controller: Controller, connection: Connection) -> None:
        """Ends a link as radio silence does: both sides see a supervision timeout."""
        self._end(connection.self_address, connection.peer_address)
        for end in list(self.controllers):
            other = end.le_connections.get(connection.self_address)
            if end is not controller and other is not None and other.self_address == connection.peer_address:
                end.on_le_disconnected(other, hci.HCI_ErrorCode.CONNECTION_TIMEOUT_ERROR)
        if controller.le_connections.get(connection.peer_address) is connection:
            controller.on_le_disconnected(connection, hci.HCI_ErrorCode.CONNECTION_TIMEOUT_ERROR)

    def leave(self, controller: Controller) -> None:
        """Takes a controller out of the air, as if its battery had been pulled."""
        controller.le_legacy_advertiser.stop()
        for connection in list(controller.le_connections.values()):
            self.lose(controller, connection)
        for ends in [ends for ends in self._events if controller.random_address in ends]:
            self._end(*ends)
        self.controllers.discard(controller)


class VirtualController(Controller):
    """One controller on a Link. `advertisement` is asked for the data before each one is sent; None: it is silent."""

    le_acl_data_packet_length = 251  # data length extension: an ATT MTU of 247 needs no fragments
    le_features = Controller.le_features & ~(
        hci.LeFeatureMask.LE_EXTENDED_ADVERTISING
        | hci.LeFeatureMask.LE_PERIODIC_ADVERTISING
        | hci.LeFeatureMask.LL_PRIVACY
    )

    def __init__(self, name: str, link: VirtualAir, advertisement: Callable[[], bytes | None] | None = None) -> None:
        super().__init__(name, link=link)
        self.air = link
        self.advertisement = advertisement

    def send_advertising_pdu(self, packet: ll.AdvertisingPdu) -> None:
        if isinstance(packet, ll.AdvInd) and self.advertisement is not None:
            data = self.advertisement()
            if data is None:
                return
            packet = ll.AdvInd(packet.advertiser_address, data)
        super().send_advertising_pdu(packet)

    def on_advertising_pdu(self, pdu: ll.AdvInd | ll.AdvExtInd) -> None:
        """Reports the advertisement, and to an active scan what the device answers to a scan request."""
        address = pdu.advertiser_address
        if self.le_scan_enable:
            self._report(hci.HCI_LE_Advertising_Report_Event.EventType.ADV_IND, address, pdu.data)
            if self.le_scan_type == hci.HCI_LE_Set_Scan_Parameters_Command.ACTIVE_SCANNING:
                device = self.air.find_le_controller(address)
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
        """A device that no longer advertises does not answer, and the caller's link fails to be established (0x3E)."""
        mine = packet.advertiser_address == self.random_address
        if mine and not self.le_legacy_advertiser.enabled:
            caller = self.air.find_le_controller(packet.initiator_address)
            half = caller.le_connections.get(packet.advertiser_address) if caller is not None else None
            if caller is not None and half is not None:
                caller.on_le_disconnected(half, hci.HCI_ErrorCode.CONNECTION_FAILED_TO_BE_ESTABLISHED_ERROR)
            return
        super().on_le_connect_ind(packet)

    def on_hci_le_create_connection_cancel_command(
        self, _command: hci.HCI_LE_Create_Connection_Cancel_Command
    ) -> hci.HCI_StatusReturnParameters:
        """Core specification Vol 4, Part E, 7.8.13: the attempt ends by a connection complete event of status 0x02."""
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


_TOLERANCE = 1e-6
"""Of an interval: what the sums of floats may be out by."""


class ConnectionEvents:
    """One link's. The first is `interval` s after it was made, and the others at the same distance.

    At an event everything goes that is ready by then, in its order, however much it is: a radio that can send no more
    than some packets at each is not modelled. What is said in answer goes at the next.
    """

    def __init__(self, interval: float) -> None:
        self.interval = interval
        self._loop = asyncio.get_running_loop()
        self._t_start = self._loop.time()
        self._done = 0
        """The number of the last event at which anything went."""
        self._ready: list[Callable[[], None]] = []
        self._timer: asyncio.TimerHandle | None = None

    def send(self, packet: Callable[[], None]) -> None:
        """Call it at the next event."""
        self._ready.append(packet)
        if self._timer is None:
            number = max(self._done + 1, ceil((self._loop.time() - self._t_start) / self.interval - _TOLERANCE))
            self._timer = self._loop.call_at(self._t_start + number * self.interval, self._event, number)

    def flush(self) -> None:
        """Send what is ready without waiting any longer: the link ends in an orderly way."""
        ready = self._ready
        self.end()
        for packet in ready:
            packet()

    def end(self) -> None:
        """Forget what is ready: the link is gone."""
        self._ready = []
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def _event(self, number: int) -> None:
        self._done = number
        self.flush()

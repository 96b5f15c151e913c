"""The virtual radio: bumble's controllers on a shared link, mended where they fall short of the Core specification.

Three things matter to whoever tests a reconnect. A connection request that is taken back must really end; a device that
has just accepted somebody else must not leave the second caller with a link that is dead from the beginning; and a scan
response must carry its own data. Extended advertising and privacy are left out: nothing here needs them.
"""

from __future__ import annotations

import logging
from collections.abc import Callable

from bumble import hci, ll
from bumble.controller import Connection, Controller
from bumble.link import LocalLink

_NOISY = logging.getLogger("bumble")
if (
    _NOISY.level == logging.NOTSET
):  # bumble warns of much that is no trouble: packets in flight when their link ends, ...
    _NOISY.setLevel(logging.CRITICAL)

RSSI = -50  # dBm; there are no distances in this air


class Link(LocalLink):
    """The air that virtual controllers share."""

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]

    def lose(self, controller: Controller, connection: Connection) -> None:
        """Ends a link as radio silence does: both sides see a supervision timeout."""
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
        self.controllers.discard(controller)


class VirtualController(Controller):
    """One controller on a Link. `advertisement` is asked for the data before each one is sent; None: it is silent."""

    le_acl_data_packet_length = 251  # data length extension: an ATT MTU of 247 needs no fragments
    le_features = Controller.le_features & ~(
        hci.LeFeatureMask.LE_EXTENDED_ADVERTISING
        | hci.LeFeatureMask.LE_PERIODIC_ADVERTISING
        | hci.LeFeatureMask.LL_PRIVACY
    )

    def __init__(self, name: str, link: Link, advertisement: Callable[[], bytes | None] | None = None) -> None:
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

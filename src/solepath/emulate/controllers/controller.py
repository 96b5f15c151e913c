"""Virtual Bluetooth controllers on a shared medium: bumble's, corrected here to follow the Core specification.

Two corrections matter in tests of a reconnect. A cancelled connection request ends. When two centrals request a
connection, the device accepts one, and the other does not keep its half-open link. Extended advertising and privacy are
left out because nothing here needs them."""

from __future__ import annotations

import logging
from collections.abc import Callable

from bumble import hci, ll
from bumble.controller import Connection, Controller
from bumble.link import LocalLink

_LOGGER = logging.getLogger("bumble")
if _LOGGER.level == logging.NOTSET:  # its warnings are harmless: packets in flight at the end of a link
    _LOGGER.setLevel(logging.CRITICAL)


class VirtualMedium(LocalLink):
    """The radio medium that virtual controllers share."""

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]

    def lose(self, controller: Controller, connection: Connection) -> None:
        """End a link as when the radio falls silent: both sides report a supervision timeout."""
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

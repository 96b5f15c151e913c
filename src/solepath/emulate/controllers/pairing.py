"""How both ends of a virtual link pair: LE Secure Connections, Just Works, and the keys are kept (bonding)."""

from __future__ import annotations

from collections.abc import Callable

from bumble.device import Connection, Device
from bumble.pairing import PairingConfig, PairingDelegate

_KEYS = PairingDelegate.KeyDistribution.DISTRIBUTE_ENCRYPTION_KEY
"""No identities are exchanged: the addresses are static."""


class Consent(PairingDelegate):
    """`agrees` is asked whether a pairing that the other end begins is welcome."""

    def __init__(self, agrees: Callable[[], bool]) -> None:
        super().__init__(local_initiator_key_distribution=_KEYS, local_responder_key_distribution=_KEYS)
        self._agrees = agrees

    async def accept(self) -> bool:
        return self._agrees()


def just_works(device: Device, agrees: Callable[[], bool]) -> None:
    """The device pairs so from now on, if `agrees` says so when the other end begins."""
    consent = Consent(agrees)

    def config(link: Connection) -> PairingConfig:
        return PairingConfig(sc=True, mitm=False, bonding=True, delegate=consent)

    device.pairing_config_factory = config

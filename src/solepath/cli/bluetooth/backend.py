"""Opens the Bluetooth that a command uses, and turns errors of Bluetooth into Failure."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager

from ...ble import NATIVE, Backend, BluetoothError
from ...types.extras import install_hint
from ..common.failure import Failure


@asynccontextmanager
async def backend_of(via: str | None) -> AsyncIterator[Backend]:
    """Yield the Bluetooth of `--via`, or this machine's for None; raise Failure when it cannot be reached."""
    if via is None:
        yield NATIVE
        return
    try:
        from ...emulate.controllers import reach
    except ModuleNotFoundError as error:
        raise Failure(f"--via needs {error.name}: {install_hint('loopback')}") from None
    async with AsyncExitStack() as stack:
        try:
            backend = await stack.enter_async_context(reach(via))
        except (BluetoothError, ValueError) as error:
            raise Failure(f"--via: {error}") from None
        yield backend

"""Sends a browser the newest state of the scene, at most 30 times a second and no faster than the browser reads.

The times below were chosen by hand and not swept."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any, Protocol

from aiohttp import WSCloseCode, WSMessage, WSMsgType, web

from ..messages import MAX_MESSAGE_SIZE, Command, CommandError, encode, parse_command
from ..scene.scene import Follower, Scene
from .access import AccessDenied
from .client_errors import ClientErrors
from .connection import LOGGER

FRAME_INTERVAL = 1.0 / 30.0
"""Mean time from one frame to the next, s."""
MAX_FRAME_INTERVAL = 1.0
"""Longest time between two frames, s; after a longer one the page in the browser knows that the server is gone."""
READ_TIMEOUT = 10.0
"""Time after which a browser that reads nothing is disconnected, s."""
PING_INTERVAL = 20.0
"""Time after which a browser that sends nothing gets a ping, s."""


class WatchedPage(Protocol):
    """The members of a page that a watcher uses."""

    scene: Scene
    client_errors: ClientErrors
    commands: Callable[[Command], None] | None


class Watcher:
    """The connection to one browser that watches; `may_control` is true if the browser has sent the token."""

    def __init__(self, page: WatchedPage, may_control: bool) -> None:
        self.may_control = may_control
        self._page = page
        self._leaving: asyncio.Task[None] | None = None
        self._socket = web.WebSocketResponse(
            timeout=1.0,
            heartbeat=PING_INTERVAL,
            compress=False,
            max_msg_size=MAX_MESSAGE_SIZE + 1,
            writer_limit=0,  # together with the limit below: a message waits until the last one was read
        )
        self._transport: asyncio.WriteTransport | None = None
        self._follower = Follower()

    async def watch(self, request: web.BaseRequest) -> web.StreamResponse:
        """Serve the browser from the handshake to the end; raise AccessDenied if the request is not for a WebSocket."""
        try:
            await self._socket.prepare(request)
        except web.HTTPException:
            raise AccessDenied("a request for the socket is none for a WebSocket", 400) from None
        self._transport = request.transport
        if self._transport is None:
            return self._socket
        self._transport.set_write_buffer_limits(0)
        sending = asyncio.create_task(self._show())
        try:
            await self._listen()
        finally:
            sending.cancel()
            await asyncio.gather(sending, return_exceptions=True)
        return self._socket

    async def end(self) -> None:
        """Send what has changed since the last frame, then close the connection."""
        await self._close(WSCloseCode.GOING_AWAY, "ended", last=True)

    def make_room(self) -> None:
        """Start to close the connection, because a browser with the token came and there is no room for both."""
        self._leaving = asyncio.create_task(self._close(WSCloseCode.TRY_AGAIN_LATER, "no room", last=False))

    async def _close(self, code: int, reason: str, last: bool) -> None:
        """Close the connection within a second; with `last`, send what has changed before."""
        try:
            async with asyncio.timeout(1.0):
                message = self._next() if last and self._socket.prepared else None
                if message is not None:
                    await self._socket.send_str(encode(message))
                await self._socket.close(code=code, message=reason.encode())
        except (TimeoutError, ConnectionError, RuntimeError):
            self._abort()

    async def _show(self) -> None:
        """Send frames until the socket closes, or the browser reads nothing."""
        try:
            loop = asyncio.get_running_loop()
            sent = due = loop.time()
            while not self._socket.closed:
                message = self._next()
                if message is None and loop.time() - sent >= MAX_FRAME_INTERVAL:
                    message = self._page.scene.frame_message()
                if message is not None:
                    async with asyncio.timeout(READ_TIMEOUT):
                        await self._socket.send_str(encode(message))
                    sent = loop.time()
                due = max(due + FRAME_INTERVAL, loop.time())  # a sleep that was too long does not delay later frames
                await asyncio.sleep(due - loop.time())
        except TimeoutError:
            self._page.client_errors.report(f"a browser that had read nothing for {READ_TIMEOUT:.0f} s was let go")
            self._abort()
        except ConnectionError:
            self._abort()
        except Exception:
            LOGGER.exception("a browser could not be shown the session")
            self._abort()

    def _next(self) -> dict[str, Any] | None:
        """Return the next message; None when nothing has changed."""
        return self._follower.message(self._page.scene, self.may_control and self._page.commands is not None)

    def _abort(self) -> None:
        if self._transport is not None:
            self._transport.abort()

    async def _listen(self) -> None:
        async for message in self._socket:
            try:
                self._take(message)
            except CommandError as error:
                self._page.client_errors.report(f"{error}: its connection is closed")
                await self._socket.close(code=error.code, message=str(error).encode()[:120])
                return

    def _take(self, message: WSMessage) -> None:
        """Execute a message of the page; raise CommandError if it is not allowed or malformed."""
        if message.type is WSMsgType.BINARY:
            raise CommandError("a browser sent bytes instead of text", WSCloseCode.UNSUPPORTED_DATA)
        if message.type is not WSMsgType.TEXT:
            code = getattr(message.data, "code", None)  # the code with which the library has closed the connection
            if code in CLOSED_BY_LIBRARY:
                self._page.client_errors.report(CLOSED_BY_LIBRARY[code])
            return
        command = parse_command(message.data)
        if not self.may_control:
            raise CommandError(f"a browser without the token requested to {command.do}")
        if self._page.commands is None:
            raise CommandError(f"a browser requested to {command.do}, and there is nothing to play")
        self._page.commands(command)


CLOSED_BY_LIBRARY: dict[int | None, str] = {
    WSCloseCode.PROTOCOL_ERROR: "a browser broke the rules of WebSockets",
    WSCloseCode.INVALID_TEXT: "a browser sent text that is not UTF-8",
    WSCloseCode.MESSAGE_TOO_BIG: "a browser sent more than a message may hold",
}
"""Meaning of the close codes with which the library closes a connection before a message is complete."""

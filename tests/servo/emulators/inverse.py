"""The Haply Inverse service as its documentation has it: one device, a handle on a hand that is a spring.

On connecting it sends its inventory; then one state for each message.  Written from RFC 6455 and the pages
"WebSocket Protocol" and "Simulation Channel" of docs.haply.co, with Python's json and struct.
"""

import json
import socket
import struct
from base64 import b64encode
from contextlib import suppress
from hashlib import sha1
from threading import Thread
from typing import Any, Self

from servo.emulators.faults import Emulator, Fault, Handle


def frame(payload: bytes, kind: int = 1, last: bool = True) -> bytes:
    first = (0x80 if last else 0) | kind
    if len(payload) < 126:
        return bytes([first, len(payload)]) + payload
    if len(payload) < 65536:
        return struct.pack(">BBH", first, 126, len(payload)) + payload
    return struct.pack(">BBQ", first, 127, len(payload)) + payload


class InverseEmulator(Emulator):
    """Listens on a free port of this machine; `address` is where.  The last of its devices moves.

    `padding` are bytes of an unknown member in each state, to make it longer.
    """

    def __init__(
        self,
        fault: Fault | None = None,
        at: int = 0,
        *,
        devices: tuple[str, ...] = ("049D",),
        padding: int = 0,
        status: dict[str, Any] | None = None,
        scale: float = 1,
        greeting: bytes | None = None,
        parts: int = 1,
    ) -> None:
        super().__init__(fault, at)
        self.handle = Handle()
        self.positions: list[dict[str, float]] = []
        self.others: list[dict[str, float]] = []
        self.pongs: list[bytes] = []
        self.closed_by_client = False
        self.asked_again = 0
        self.found_when_asked: int | None = None
        self.ping_before: int | None = None
        self.not_ready_from: int | None = None
        self._devices, self._padding, self._status, self._scale = devices, padding, status, scale
        self._greeting, self._parts = greeting, parts
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        self._line: socket.socket | None = None
        self._thread = Thread(target=self._serve, daemon=True)

    def write(self, data: bytes) -> None:
        if self._line is not None:
            with suppress(OSError):
                self._line.sendall(data)

    def hang_up(self) -> None:
        line, self._line = self._line, None
        if line is not None:
            with suppress(OSError):
                line.shutdown(socket.SHUT_RDWR)
            line.close()

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):  # one who waits for a line waits no more
            socket.create_connection(self._listener.getsockname(), timeout=60).close()
        self._thread.join(timeout=60)
        self._listener.close()
        self.hang_up()

    def _serve(self) -> None:
        with suppress(OSError):
            self._line, _ = self._listener.accept()
            self._line.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            if not self._shake_hands(self._line):
                return
            self.write(frame(self._greeting or self._document(full=True)))
            data = b""
            while self._line is not None and (part := self._line.recv(65536)):
                data += part
                while (found := _client_frame(data)) is not None:
                    kind, payload, data = found
                    self._hear(kind, payload)
        self.hang_up()

    def _shake_hands(self, line: socket.socket) -> bool:
        head = b""
        while b"\r\n\r\n" not in head:
            if not (part := line.recv(4096)):
                return False
            head += part
        lines = head.decode().split("\r\n")
        assert lines[0] == "GET / HTTP/1.1"
        fields = {
            name.lower(): value.strip() for name, _, value in (x.partition(":") for x in lines[1:] if x)
        }
        assert fields["upgrade"].lower() == "websocket"
        assert fields["sec-websocket-version"] == "13"
        key = fields["sec-websocket-key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        accept = b64encode(sha1(key.encode()).digest()).decode()
        line.sendall(
            "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Accept: {accept}\r\n\r\n".encode()
        )
        return True

    def _hear(self, kind: int, payload: bytes) -> None:
        if kind == 10:
            self.pongs.append(payload)
        if kind == 8:
            self.closed_by_client = True
            self.hang_up()
        if kind != 1:
            return
        message = json.loads(payload)
        if message == {"session": {"force_render_full_state": {}}}:
            self.asked_again += 1
            if self.asked_again == self.found_when_asked:
                self._devices = ("049D",)
            self.write(frame(self._greeting or self._document(full=True)))
            return
        (device,) = message["inverse3"]
        assert device["device_id"] == self._devices[-1]
        values = device["commands"]["set_cursor_force"]["values"]
        assert set(values) == {"x", "y", "z"}
        force = values["z"]
        self.others.append({"x": values["x"], "y": values["y"]})
        self.command(force)
        self.handle.step(force)
        if self.exchange == self.ping_before:
            self.write(frame(b"are you there", 9))
        self.answer(self._split(self._document()))

    def _split(self, payload: bytes) -> bytes:
        size = -(-len(payload) // self._parts)
        pieces = [payload[i : i + size] for i in range(0, len(payload), size)]
        return b"".join(
            frame(piece, 1 if i == 0 else 0, i == len(pieces) - 1) for i, piece in enumerate(pieces)
        )

    def nonsense(self, count: int) -> bytes:
        """Inside a right frame, or nothing behind it could be told from garbage."""
        return frame(b'{"inverse3": [' + super().nonsense(40).hex().encode())

    def _document(self, full: bool = False) -> bytes:
        """Members in an order that puts what is wanted last."""
        position = {"y": -0.12, "x": 0.0125, "z": round(self.handle.position, 9)}
        if not full:
            self.positions.append(position)
        devices = []
        for name in self._devices:
            moving = name == self._devices[-1]
            state = {
                "angular_position": {"a0": -69.31704, "a1": 137.62952, "a2": 19.832787},
                "current_cursor_position": {"x": 9.0, "y": 9.0, "z": 9.0},
                "cursor_velocity": {"x": -1.2e-05, "y": 0.0, "z": self.handle.speed},
                "cursor_position": position if moving else {"x": 8.0, "y": 8.0, "z": 8.0},
                "transform": {"scale": {"x": self._scale, "y": 1, "z": 1}} if full else {},
                "control_mode": 'idle "}{][',
            }
            config = {
                "type": "inverse3",
                "filters": {"force_gate": {"gain": 0.3}, "damping": {"scalar": 0.0}},
            }
            status = self._status or {"calibrated": True, "ready": True}
            if self.not_ready_from is not None and self.exchange >= self.not_ready_from:
                status = {"ready": False}
            device: dict[str, Any] = {"config": config} if full else {}
            devices.append({**device, "status": status, "state": state, "device_id": name})
        document = {"padding": "]}" * (self._padding // 2), "session_id": 7, "inverse3": devices}
        return json.dumps(document, indent=1 if full else None).encode()


def _client_frame(data: bytes) -> tuple[int, bytes, bytes] | None:
    """(What the first frame is, its payload without the mask, what is behind it); None if it is not whole."""
    if len(data) < 2:
        return None
    assert data[0] & 0xF0 == 0x80, "a client's frame here is whole"
    assert data[1] & 0x80, "a client's frame is masked"
    length, at = data[1] & 0x7F, 2
    if length == 126:
        if len(data) < 4:
            return None
        (length,), at = struct.unpack(">H", data[2:4]), 4
        assert length > 125, "the length is in its shortest form"
    if len(data) < at + 4 + length:
        return None
    mask, payload = data[at : at + 4], data[at + 4 : at + 4 + length]
    plain = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
    return data[0] & 0x0F, plain, data[at + 4 + length :]

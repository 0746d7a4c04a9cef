"""Laws of the viewer on a running simulator, watched as a page does (src/viewer/PROTOCOL.md)."""
import base64
import json
import os
import socket
import struct
import unittest
import urllib.parse
import urllib.request

import numpy

import sprung
from common import cloth, simulator


class Page:
    """The WebSocket of a page."""

    def __init__(self, address):
        url = urllib.parse.urlsplit(address)
        self.socket = socket.create_connection((url.hostname, url.port), timeout=20)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall((f"GET /live?{url.query} HTTP/1.1\r\nHost: {url.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                             f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        answer = b""
        while not answer.endswith(b"\r\n\r\n"):
            answer += self.take(1)
        assert b" 101 " in answer.split(b"\r\n")[0], answer

    def take(self, count):
        data = b""
        while len(data) < count:
            more = self.socket.recv(count - len(data))
            assert more, "the server closed the connection"
            data += more
        return data

    def next(self):
        """A message: a dict, or bytes."""
        first, size = self.take(2)
        if size == 126:
            size, = struct.unpack(">H", self.take(2))
        elif size == 127:
            size, = struct.unpack(">Q", self.take(8))
        data = self.take(size)
        return json.loads(data) if first & 15 == 1 else data

    def send(self, text):
        data, mask = text.encode(), b"\1\2\3\4"
        self.socket.sendall(bytes([0x81, 0x80 | len(data)]) + mask + bytes(c ^ mask[k % 4] for k, c in enumerate(data)))

    def until(self, is_wanted):
        while True:
            message = self.next()
            if is_wanted(message):
                return message


def is_frame(message):
    return isinstance(message, bytes) and message[:4] == struct.pack("<I", 2)


def positions(frame):
    count, = struct.unpack("<I", frame[24:28])
    return numpy.frombuffer(frame, "<f4", 3 * count, 32 + 10 * 4).reshape(-1, 3)


def time(frame):
    return struct.unpack("<d", frame[16:24])[0]


@unittest.skipIf("Not in this build" in sprung.show.__doc__, "the viewer is not built")
class Show(unittest.TestCase):
    def test_a_page_sees_the_steps_of_the_program(self):
        one, twin = simulator(cloth()), simulator(cloth())
        with sprung.show(one, open=False) as viewer:
            page = urllib.request.urlopen(viewer.address, timeout=20).read()
            self.assertIn(b"<html", page)
            watching = Page(viewer.address)
            self.assertEqual(watching.next()["mode"], "live")
            scene = watching.until(lambda message: isinstance(message, dict) and message["type"] == "scene")
            self.assertEqual(scene["bodies"], [{"name": "cloth", "first": 0, "count": 144}])
            self.assertEqual(time(watching.until(is_frame)), 0.0)
            one.step(30)
            viewer.refresh()
            frame = watching.until(lambda message: is_frame(message) and time(message) == one.time)
            numpy.testing.assert_array_equal(positions(frame), one.bodies["cloth"].particles.astype("f4"))
            watching.send('{"do": "reset"}')
            answer = watching.until(lambda message: isinstance(message, dict) and message["type"] == "error")
            self.assertIn("a program steps this simulator", answer["text"])
            watching.socket.close()
        one.step(30)
        twin.step(60)
        self.assertEqual(one.state(), twin.state())
        with self.assertRaises(OSError):
            urllib.request.urlopen(viewer.address, timeout=5)


if __name__ == "__main__":
    unittest.main()

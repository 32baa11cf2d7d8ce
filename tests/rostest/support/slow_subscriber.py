# SPDX-License-Identifier: Apache-2.0
"""A subscriber that lets messages wait at the publisher."""

import socket
import struct
from xmlrpc.client import ServerProxy

import rosgraph

CALLER = "/slow_subscriber"
SMALL = 4096  # of what its kernel takes without it [bytes]
PATIENCE = 60  # [s]


class SlowSubscriber:
    """Connected to a topic of a node, and reads nothing until asked."""

    def __init__(self, node, topic, kind):
        self._kind = kind
        uri = rosgraph.Master(CALLER).lookupNode(node)
        _, _, (_, host, port) = ServerProxy(uri).requestTopic(CALLER, topic, [["TCPROS"]])
        self._socket = socket.socket()
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SMALL)
        self._socket.settimeout(PATIENCE)
        self._socket.connect((host, port))
        names = {"callerid": CALLER, "topic": topic, "type": kind._type, "md5sum": kind._md5sum}
        fields = [f"{name}={value}".encode() for name, value in names.items()]
        header = b"".join(struct.pack("<I", len(field)) + field for field in fields)
        self._socket.sendall(struct.pack("<I", len(header)) + header)
        self._block()  # its answer

    def messages(self, count):
        """The next ones, in the order in which they come."""
        return [self._kind().deserialize(self._block()) for _ in range(count)]

    def close(self):
        self._socket.close()

    def _block(self):
        return self._read(struct.unpack("<I", self._read(4))[0])

    def _read(self, size):
        out = b""
        while len(out) < size:
            more = self._socket.recv(size - len(out))
            if not more:
                raise ConnectionError("the publisher closed the connection")
            out += more
        return out

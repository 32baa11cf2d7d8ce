# SPDX-License-Identifier: Apache-2.0
"""Hears all that passes a broker until it is told to end, and holds what this project sends to the
official schemas of 2.1.0. Ends with 1 if a message did not fit.

Arguments: the broker's port, and whose messages: vehicle (state, connection, factsheet,
visualization) or master (order, instantActions)."""

import json
import signal
import sys
import threading
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit" / "python" / "vda5050"))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "unit" / "python"))

from official_schemas import faults

from warehouse_vda5050.mqtt.loop import Link, MqttLoop
from warehouse_vda5050.mqtt.settings import BrokerSettings
from warehouse_vda5050.topics import FROM_VEHICLE, TO_VEHICLE, Topics

PORT, SIDE = int(sys.argv[1]), sys.argv[2]
KINDS = {"vehicle": FROM_VEHICLE, "master": TO_VEHICLE}[SIDE]
TOPICS = Topics()


class Witness:
    """Counts messages by kind, and keeps the faults of each."""

    def __init__(self):
        self.counts, self.faults = Counter(), []
        self.ended = threading.Event()

    def take(self, topic, payload, _retained):
        _, kind = TOPICS.parse(topic)
        self.counts[kind.value] += 1
        self.faults += [f"{topic}: {fault}" for fault in faults(kind, payload)]

    def run(self):
        loop = MqttLoop()
        filters = [(TOPICS.everyone(kind), 0) for kind in KINDS]
        loop.add(Link("witness", BrokerSettings("localhost", PORT), filters, self.take))
        while not self.ended.is_set():
            loop.poll(0.1)


def main():
    witness = Witness()
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: witness.ended.set())
    witness.run()
    print(f"witness: {sum(witness.counts.values())} messages, {json.dumps(witness.counts)}")
    for fault in witness.faults[:10]:
        print(f"witness: {fault}", file=sys.stderr)
    sys.exit(bool(witness.faults) or not witness.counts)


main()

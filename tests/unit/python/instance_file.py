# SPDX-License-Identifier: Apache-2.0
"""Instance files in RAWSim-O's format: one-way streets around blocks two deep, picking stations on
the right, replenishing stations on the left."""

import xml.etree.ElementTree as ElementTree

import numpy as np

BLOCK, LANE = 5, 4  # cells


def write_instance(
    path, bots=16, picking=2, replenishing=2, rows=7, blocks=3, spacing=1.0, filled=0.85, old=False
):
    """old: <Queue> instead of <Queues>, without ItemPickTime and ActivationOrderID.

    rows and blocks are odd, so that streets alternate and the outermost go round.
    """
    street_x = LANE + np.arange(blocks + 1) * (BLOCK + 1)
    street_y = np.arange(rows + 1) * 3
    edges, storage, queues = {}, set(), {}

    def join(a, b):
        edges.setdefault(a, []).append(b)
        edges.setdefault(b, [])

    for i, y in enumerate(street_y):
        for x in range(street_x[0], street_x[-1]):
            join((x, y), (x + 1, y)) if i % 2 == 0 else join((x + 1, y), (x, y))
    for i, x in enumerate(street_x):
        for y in range(street_y[-1]):
            join((x, y), (x, y + 1)) if i % 2 else join((x, y + 1), (x, y))
    for start in street_x[:-1]:
        for x in range(start + 1, start + 1 + BLOCK):
            for y in street_y[:-1]:
                storage |= {(x, y + 1), (x, y + 2)}
    for x, y in storage:
        for other in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            join((x, y), other)
            if other not in storage:
                join(other, (x, y))
    for k in range(picking):
        y = _height(street_y, k, picking)
        there = [(street_x[-1] + 1 + i, y) for i in range(LANE)]
        back = [(x, y + 1) for x, _ in there[::-1]]
        queues["OutputStation", k] = there[::-1]
        _chain(join, [(street_x[-1], y), *there, *back, (street_x[-1], y + 1)])
    for k in range(replenishing):
        y = _height(street_y, k, replenishing) + 1
        there = [(street_x[0] - 1 - i, y) for i in range(LANE)]
        back = [(x, y - 1) for x, _ in there[::-1]]
        queues["InputStation", k] = there[::-1]
        _chain(join, [(street_x[0], y), *there, *back, (street_x[0], y - 1)])

    places = np.random.default_rng(3).permutation(sorted(storage))
    pods = [tuple(place) for place in places[: int(filled * len(places))]]
    number = {place: i for i, place in enumerate(sorted(edges))}
    lanes = {place for queue in queues.values() for place in queue}
    lanes |= {(x, y + 1) for (tag, _), q in queues.items() if tag[0] == "O" for x, y in q}
    lanes |= {(x, y - 1) for (tag, _), q in queues.items() if tag[0] == "I" for x, y in q}
    own = {queue[0]: key for key, queue in queues.items()}

    root = ElementTree.Element("Instance", Name="test")

    def at(place):
        return {"X": f"{0.5 + place[0] * spacing:.4f}", "Y": f"{0.5 + place[1] * spacing:.4f}"}

    def add(group, tag, n, place, **attributes):
        parent = root.find(group)
        if parent is None:
            parent = ElementTree.SubElement(root, group)
        common = {"ID": str(n), "Tier": "0"} | at(place)
        return ElementTree.SubElement(parent, tag, common | attributes)

    bot = {"PodTransferTime": "2.2", "MaxAcceleration": "1", "MaxDeceleration": "1"}
    bot |= {"MaxVelocity": "1.5", "TurnSpeed": "2.5", "Radius": "0.35", "Orientation": "0"}
    for n in range(bots):
        add("Bots", "Bot", n, pods[n], **bot)
    for n, place in enumerate(pods):
        add("Pods", "Pod", n, place, Radius="0.4", Orientation="0", Capacity="500")
    for (tag, n), queue in queues.items():
        times = {"ItemTransferTime": "10"} if tag[0] == "O" else {"ItemBundleTransferTime": "10"}
        times["Capacity"] = "12" if tag[0] == "O" else "1000"
        if not old:
            times |= {"ActivationOrderID": "1"} | ({"ItemPickTime": "3"} if tag[0] == "O" else {})
        element = add(f"{tag}s", tag, n, queue[0], Radius="0.4", **times)
        name = "Queue" if old else "Queues"
        within = ElementTree.SubElement(element, name)
        for place in queue:
            text = str(number[place]) if old else f"{number[queue[0]]}/{number[place]}"
            ElementTree.SubElement(within, name).text = text
    for place, n in number.items():
        tag, which = own.get(place, ("", -1))
        element = add(
            "Waypoints",
            "Waypoint",
            n,
            place,
            OutputStation=str(which if tag == "OutputStation" else -1),
            InputStation=str(which if tag == "InputStation" else -1),
            Elevator="-1",
            Pod=str(pods.index(place)) if place in pods else "-1",
            PodStorageLocation=str(place in storage).lower(),
            IsQueueWaypoint=str(place in lanes).lower(),
        )
        paths = ElementTree.SubElement(element, "Paths")
        for other in dict.fromkeys(edges[place]):
            ElementTree.SubElement(paths, "Waypoint").text = str(number[other])
    ElementTree.indent(root)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
    return path


def _height(street_y, k, count):
    return int(round((k + 0.5) * street_y[-1] / count)) // 3 * 3


def _chain(join, places):
    for a, b in zip(places, places[1:]):
        join(a, b)

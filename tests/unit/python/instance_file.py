# SPDX-License-Identifier: Apache-2.0
"""Files in RAWSim-O's formats. Instances: one-way streets around blocks two deep, picking stations
on the right, replenishing stations on the left, with straight lanes or with halls and winding ones.
Layout configurations: the parameters of its generator, those of its BasicInstance among them."""

import copy
import itertools
import xml.etree.ElementTree as ElementTree

import numpy as np

BLOCK, LANE = 5, 4  # cells
QUEUE = 4  # cells before an elevator


def write_instance(
    path, bots=16, picking=2, replenishing=2, rows=7, blocks=3, spacing=1.0, filled=0.85, old=False
):
    """old: <Queue> instead of <Queues>, without ItemPickTime and ActivationOrderID.

    rows and blocks are odd, so that streets alternate and the outermost go round.
    """
    street_x = LANE + np.arange(blocks + 1) * (BLOCK + 1)
    street_y = np.arange(rows + 1) * 3
    storage, queues = set(), {}
    edges, join = _graph()

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
    _join_storage(join, storage)
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
    lanes = {place for queue in queues.values() for place in queue}
    lanes |= {(x, y + 1) for (tag, _), q in queues.items() if tag[0] == "O" for x, y in q}
    lanes |= {(x, y - 1) for (tag, _), q in queues.items() if tag[0] == "I" for x, y in q}
    return _write(path, edges, storage, queues, lanes, bots, spacing, filled, old)


HALL, BUFFER, CROSSING = 2, 4, 4  # streets before the stations; cells before those; units a block


def write_hall_instance(path, stations=2, blocks=5, bots=16, filled=0.85):
    """Returns an instance of the MaTi kind with these counts of picking and replenishing stations.

    Their queues wind over three rows, the last of which has two short cuts, from the hall and from
    the deep end of the row before; before them are a hall of two streets, one up and one down, and
    a buffer of one-way rows. Robots stand in the streets at
    first, and are slow: 0.5 m/s², 3 s a lift. blocks is odd, so that the outermost streets go
    round.
    """
    rows = 6 * stations + 4
    first = LANE + HALL + BUFFER  # the first street of the storage
    street_x = first + np.arange(blocks + 1) * (CROSSING + 1)
    right = street_x[-1] + 1 + BUFFER  # the hall there
    storage, queues = set(), {}
    edges, join = _graph()
    for y in range(0, rows, 3):
        _chain(join, _directed([(x, y) for x in range(street_x[0], street_x[-1] + 1)], y % 2 == 0))
    for i, x in enumerate(street_x):
        _chain(join, _directed([(x, y) for y in range(rows)], i % 2 == 1))
    for x, y in itertools.product(range(street_x[0], street_x[-1]), range(rows)):
        if x not in street_x and y % 3:
            storage.add((x, y))
    _join_storage(join, storage)
    for y in range(rows):
        for begin in (street_x[-1], first - BUFFER - 1):
            way = [(x, y) for x in range(begin, begin + BUFFER + 2)]
            _chain(join, _directed(way, y % 2 == 0))
        join(*_directed([(right, y), (right + 1, y)], y % 2 == 0))
        join(*_directed([(LANE, y), (LANE + 1, y)], y % 2 == 0))
    for up, down in ((right + 1, right), (LANE + 1, LANE)):
        _chain(join, [(up, y) for y in range(rows)])
        _chain(join, [(down, y) for y in range(rows)][::-1])
    lanes = set()
    for k in range(stations):
        bottom = 6 * k + 3
        out = [(right + 2 + i, bottom) for i in range(LANE)]
        rising = [[(x, bottom + j) for x, _ in out] for j in range(4)]
        queue = [*rising[3], *rising[2][::-1], *rising[1]]
        lane = [*queue, *out[::-1]]
        _chain(join, [(right + 1, bottom + 3), *lane, (right + 1, bottom)])
        cuts = [((right + 1, bottom + 1), rising[1][0]), (rising[2][-1], rising[1][-1])]
        for cut in cuts:
            join(*cut)
        queues["OutputStation", k] = [out[-1], *queue[::-1]]
        # The same turned by half a turn.
        turned = [(LANE - 1 - (x - right - 2), rows - 1 - y) for x, y in lane]
        for cut in cuts:
            join(*[(LANE - 1 - (x - right - 2), rows - 1 - y) for x, y in cut])
        entry, leave = rows - 1 - (bottom + 3), rows - 1 - bottom
        _chain(join, [(LANE, entry), *turned, (LANE, leave)])
        count = len(queue) + 1
        queues["InputStation", k] = turned[:count][::-1]
        lanes |= {*lane, *turned}
    free = sorted(edges.keys() - storage - lanes)
    starts = [free[i] for i in np.random.default_rng(4).permutation(len(free))[:bots]]
    kind = {"MaxAcceleration": "0.5", "MaxDeceleration": "0.5", "PodTransferTime": "3"}
    return _write(path, edges, storage, queues, lanes, starts, 1.0, filled, False, kind)


RIDE = 10.0  # from tier to tier [s]


def write_tiers_instance(path, tiers=2, **values):
    """Writes an instance with the floor of write_instance(**values) on each tier, and an elevator.

    Its lane leads along above the topmost street, from its right end, as the landing's left.
    """
    root = ElementTree.parse(write_instance(path, **values)).getroot()
    places = {
        (float(w.get("X")), float(w.get("Y"))): w for w in root.iter("Waypoint") if w.get("X")
    }
    top = max(y for _, y in places)
    row = sorted(x for x, y in places if y == top)[2 : 2 + QUEUE + 1]
    spacing = row[1] - row[0]
    lane = [_waypoint(root, x, top + spacing) for x in row]  # the landing first
    for ahead, behind in zip(lane, lane[1:]):
        _add_path(behind, ahead)
    _add_path(lane[0], places[row[0], top])
    _add_path(places[row[-1], top], lane[-1])
    elevator = ElementTree.SubElement(ElementTree.SubElement(root, "Elevators"), "Elevator", ID="0")
    parts = {part: ElementTree.SubElement(elevator, part) for part in ("Waypoints", "Timings")}
    single = [(group, list(group)) for group in root if group.tag != "Elevators"]
    stations = {group.tag: len(elements) for group, elements in single}
    landings, count = [], max(int(w.get("ID")) for w in root.find("Waypoints")) + 1
    for tier in range(tiers):
        landings.append(int(lane[0].get("ID")) + tier * count)
        ElementTree.SubElement(parts["Waypoints"], "Waypoint").text = str(landings[-1])
        for group, elements in single if tier else []:
            group.extend(
                _on_tier(element, tier, len(elements), count, stations) for element in elements
            )
    for a, b in itertools.permutations(range(tiers), 2):
        text = f"{landings[a]}/{landings[b]}/{RIDE * abs(a - b):g}"
        ElementTree.SubElement(parts["Timings"], "Timing").text = text
        ends = {w.get("ID"): w for w in root.find("Waypoints")}
        _add_path(ends[str(landings[a])], ends[str(landings[b])])
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
    return path


def _waypoint(root, x, y):
    """Adds a waypoint of a queue, without paths."""
    group = root.find("Waypoints")
    values = {"ID": str(len(group)), "X": f"{x:.4f}", "Y": f"{y:.4f}", "Tier": "0"}
    out = ElementTree.SubElement(group, "Waypoint", IsQueueWaypoint="true", **values)
    ElementTree.SubElement(out, "Paths")
    return out


def _add_path(start, end):
    ElementTree.SubElement(start.find("Paths"), "Waypoint").text = end.get("ID")


def _on_tier(element, tier, others, waypoints, stations):
    """A copy of an element on another tier. others, waypoints, stations: how many of its kind, and
    of those, a tier has."""
    out = copy.deepcopy(element)
    count = waypoints if out.tag == "Waypoint" else others
    out.set("ID", str(int(out.get("ID")) + tier * count))
    out.set("Tier", str(tier))
    for part in out.iter():
        if part.text and part.text.strip():
            numbers = [str(int(number) + tier * waypoints) for number in part.text.split("/")]
            part.text = "/".join(numbers)
    for kind in ("OutputStation", "InputStation"):
        if out.get(kind, "-1") != "-1":
            out.set(kind, str(int(out.get(kind)) + tier * stations[f"{kind}s"]))
    return out


def _join_storage(join, storage):
    for x, y in storage:
        for other in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            join((x, y), other)
            if other not in storage:
                join(other, (x, y))


def _graph():
    edges = {}

    def join(a, b):
        edges.setdefault(a, []).append(b)
        edges.setdefault(b, [])

    return edges, join


def _directed(way, ahead):
    return way if ahead else way[::-1]


def _write(path, edges, storage, queues, lanes, bots, spacing, filled, old, kind=None):
    """bots: where they stand, or how many stand beneath the first pods."""
    places = np.random.default_rng(3).permutation(sorted(storage))
    pods = [tuple(place) for place in places[: int(filled * len(places))]]
    number = {place: i for i, place in enumerate(sorted(edges))}
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
    bot |= kind or {}
    for n, place in enumerate(pods[:bots] if isinstance(bots, int) else bots):
        add("Bots", "Bot", n, place, **bot)
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


CONFIGURATION = """<?xml version="1.0" encoding="utf-8"?>
<LayoutConfiguration xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
{}</LayoutConfiguration>
"""
SMALL = {
    "TierCount": 1,
    "BotCount": 8,
    "PodAmount": 0.85,
    "PodCapacity": 500,
    "OStationCapacity": 18,
    "AisleLayoutType": "Tim",
    "AislesTwoDirectional": "false",
    "SingleLane": "true",
    "NameLayout": "1-2-2-8-0.85",
    "NrHorizontalAisles": 4,
    "NrVerticalAisles": 4,
    "HorizontalLengthBlock": 4,
    "WidthHall": 6,
    "WidthBuffer": 4,
    "DistanceEntryExitStation": 3,
    "CounterClockwiseRingwayDirection": "true",
    "NPickStationEast": 2,
    "NReplenishmentStationWest": 2,
}
BASIC_INSTANCE = {
    "BotCount": 16,
    "OStationCapacity": 12,
    "ItemTransferTime": 10,
    "ItemPickTime": 3,
    "AisleLayoutType": "HighwayHallway",
    "NameLayout": "1-2-2-16-0.85",
    "NrHorizontalAisles": 8,
    "NrVerticalAisles": 6,
}


def write_configuration(path, **values):
    """Writes a layout configuration, .xlayo: that of SMALL, but for the values given."""
    elements = "".join(f"  <{k}>{v}</{k}>\n" for k, v in {**SMALL, **values}.items())
    path.write_text(CONFIGURATION.format(elements))
    return path

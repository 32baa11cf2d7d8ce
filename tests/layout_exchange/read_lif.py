# SPDX-License-Identifier: Apache-2.0
"""Reads a LIF file by vdma-lif and by LIFReader, writes it again by the former, and prints as JSON
what each of them found: read_lif.py IN OUT."""

import json
import sys

from lif_reader.graph.lif_graph import LIFGraph
from lif_reader.lif_reader import LIFReader
from vdma_lif.parser import LIFParser


def by_vdma_lif(path, out):
    read = LIFParser.from_file(path)
    LIFParser.to_file(read, out)
    (layout,) = read.layouts
    return {
        "nodes": sorted([n.node_id, n.node_position.x, n.node_position.y] for n in layout.nodes),
        "edges": sorted([e.start_node_id, e.end_node_id] for e in layout.edges),
        "stations": sorted([s.station_id, *s.interaction_node_ids] for s in layout.stations),
    }


def by_lif_reader(path):
    graph = LIFGraph()
    LIFReader(graph).parse_lif_file(path)
    (layout,) = graph.layouts.values()
    at = [(name, node["nodePosition"]) for name, node in layout.nodes(data=True)]
    return {
        "nodes": sorted([name, place["x"], place["y"]] for name, place in at),
        "edges": sorted(map(list, layout.edges())),
        "stations": sorted([s.stationId, *s.interactionNodeIds] for s in graph.stations.values()),
    }


if __name__ == "__main__":
    source, out = sys.argv[1:]
    print(json.dumps({"vdma-lif": by_vdma_lif(source, out), "LIFReader": by_lif_reader(source)}))

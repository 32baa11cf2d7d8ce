# SPDX-License-Identifier: Apache-2.0
"""Circles in a graph of what uses what."""


def circles(graph):
    """Returns the sets of nodes that lead to each other, sorted; after Tarjan (1972).

    `graph` maps each node to those that it leads to.
    """
    index, low, stack, rings = {}, {}, [], []

    def visit(node):
        index[node] = low[node] = len(index)
        stack.append(node)
        for other in graph[node]:
            if other not in index:
                visit(other)
            if other in stack:
                low[node] = min(low[node], low[other])
        if low[node] == index[node]:
            at = stack.index(node)
            rings.append(sorted(stack[at:]))
            del stack[at:]

    for node in list(graph):
        if node not in index:
            visit(node)
    return [circle for circle in rings if len(circle) > 1]

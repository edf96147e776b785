# SPDX-License-Identifier: BSD-3-Clause
"""Algorithms on include graphs; a graph is {node: included nodes}."""
from collections import deque


def chains_from(start, graph):
    """A shortest chain from `start` to each reachable node (breadth-first search)."""
    came = {start: None}
    queue = deque([start])
    while queue:
        node = queue.popleft()
        for target in graph.get(node, ()):
            if target not in came:
                came[target] = node
                queue.append(target)
                chain = [target]
                while came[chain[-1]] is not None:
                    chain.append(came[chain[-1]])
                yield chain[::-1]


def circles_of(graph):
    """A shortest cycle in each strongly connected component; the first node is repeated at the end."""
    for component in components(graph):
        if len(component) > 1 or component[0] in graph.get(component[0], ()):
            inside = set(component)
            yield min((shortest_circle(graph, node, inside) for node in sorted(component)), key=len)


def components(graph):
    """Tarjan's strongly connected components, without recursion."""
    number, low, on_stack, stack, found = {}, {}, set(), [], []
    for root in graph:
        if root in number:
            continue
        work = [(root, iter(sorted(graph[root])))]
        number[root] = low[root] = len(number)
        stack.append(root)
        on_stack.add(root)
        while work:
            node, targets = work[-1]
            for target in targets:
                if target not in graph:
                    continue
                if target not in number:
                    number[target] = low[target] = len(number)
                    stack.append(target)
                    on_stack.add(target)
                    work.append((target, iter(sorted(graph[target]))))
                    break
                if target in on_stack:
                    low[node] = min(low[node], number[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == number[node]:
                    at = stack.index(node)
                    found.append(stack[at:])
                    on_stack.difference_update(stack[at:])
                    del stack[at:]
    return found


def shortest_circle(graph, start, inside):
    """A shortest cycle through `start` within a component (breadth-first search)."""
    came = {}
    queue = deque([start])
    while queue:
        node = queue.popleft()
        for target in sorted(graph.get(node, ())):
            if target == start:
                way = [start, node]
                while way[-1] != start:
                    way.append(came[way[-1]])
                return way[::-1] if len(way) > 2 else [start, start]
            if target in inside and target not in came:
                came[target] = node
                queue.append(target)
    return [start]

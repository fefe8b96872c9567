"""Meshes of blocks for the validation cases, written as Gmsh 2.2 text: hexahedra, or wedges or pyramids that they are split into."""
import itertools

EDGES = [(0, 1), (0, 3), (0, 4), (1, 2), (1, 5), (2, 3), (2, 6), (3, 7), (4, 5), (4, 7), (5, 6), (6, 7)]
FACES = [(0, 1, 2, 3), (0, 1, 4, 5), (0, 3, 4, 7), (1, 2, 5, 6), (2, 3, 6, 7), (4, 5, 6, 7)]
SIDES = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
CUBE = [(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0), (0, 0, 4), (4, 0, 4), (4, 4, 4), (0, 4, 4)]
# Corners of the cells that a hexahedron is split into, its middle being corner 8, and the edges of each.
SPLIT = {
    "hexahedra": ([range(8)], EDGES),
    "wedges": ([(0, 1, 2, 4, 5, 6), (0, 2, 3, 4, 6, 7)],
               [(0, 1), (0, 2), (0, 3), (1, 2), (1, 4), (2, 5), (3, 4), (3, 5), (4, 5)]),
    "pyramids": ([(*reversed(side), 8) for side in SIDES],
                 [(0, 1), (0, 3), (0, 4), (1, 2), (1, 4), (2, 3), (2, 4), (3, 4)]),
}
# Types of Gmsh by dimension and number of nodes.
KINDS = {(1, 3): 8, (2, 4): 3, (2, 8): 16, (2, 9): 10, (3, 8): 5, (3, 20): 17, (3, 27): 12, (3, 6): 6, (3, 15): 18, (3, 13): 19}


def mean(*points):
    return tuple(sum(c) // len(points) for c in zip(*points))


class Mesh:
    """Blocks that share the nodes in which they meet; `nodes` is 8, 20 or 27 of hexahedra, 6 or 15 of wedges, 13 of pyramids."""

    def __init__(self, nodes=27, digits=9, cells="hexahedra"):
        self.n_nodes, self.digits, (self.split, self.edges) = nodes, digits, SPLIT[cells]
        self.tags, self.points, self.cells = {}, [], []

    def node(self, x):
        key = tuple(round(c, 7) + 0.0 for c in x)
        if key not in self.tags:
            self.points.append(x)
            self.tags[key] = len(self.points)
        return self.tags[key]

    def block(self, counts, place):
        """counts cells along u, v, w in [0, 1]; place(u, v, w) is where a node is."""
        corners = CUBE + [(2, 2, 2)]
        for cell, of in itertools.product(itertools.product(*(range(n) for n in counts)), self.split):
            local = [corners[k] for k in of]
            if self.n_nodes > len(local):
                local += [mean(local[a], local[b]) for a, b in self.edges]
            if self.n_nodes == 27:
                local += [mean(*(CUBE[c] for c in face)) for face in FACES] + [(2, 2, 2)]
            at = [tuple((4 * c + k) / (4 * n) for c, k, n in zip(cell, of, counts)) for of in local]
            self.cells.append([self.node(place(*uvw)) for uvw in at])

    def faces(self, where):
        """The faces of hexahedra all of whose nodes are where it says."""
        found = []
        for cell in self.cells:
            for side in SIDES:
                middles = [8 + EDGES.index(tuple(sorted(pair))) for pair in zip(side, side[1:] + side[:1])]
                of = list(side) + (middles if self.n_nodes > 8 else [])
                if self.n_nodes == 27:
                    of.append(20 + FACES.index(tuple(sorted(side))))
                nodes = [cell[k] for k in of]
                if all(where(*self.points[n - 1]) for n in nodes):
                    found.append(nodes)
        return found

    def lines(self, where):
        """The edges all of whose nodes are where it says, each once."""
        found = set()
        for cell in self.cells:
            for k, (a, b) in enumerate(EDGES):
                line = cell[a], cell[b], cell[8 + k]
                if all(where(*self.points[n - 1]) for n in line):
                    found.add((min(line[:2]), max(line[:2]), line[2]))
        return sorted(found)

    def write(self, path, name="solid", lines=None, **regions):
        """The cells are the region `name`; `regions` are faces, `lines` edges, by where their nodes are."""
        groups = [(1, region, self.lines(where)) for region, where in (lines or {}).items()]
        groups += [(2, region, self.faces(where)) for region, where in regions.items()] + [(3, name, self.cells)]
        number = 0
        with open(path, "w") as file:
            print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", len(groups), sep="\n", file=file)
            for tag, (dimension, region, _) in enumerate(groups, 1):
                print(dimension, tag, f'"{region}"', file=file)
            print("$EndPhysicalNames\n$Nodes", len(self.points), sep="\n", file=file)
            for tag, x in enumerate(self.points, 1):
                print(tag, *(f"{round(c, self.digits) + 0.0:.{self.digits}g}" for c in x), file=file)
            print("$EndNodes\n$Elements", sum(len(cells) for _, _, cells in groups), sep="\n", file=file)
            for tag, (dimension, _, cells) in enumerate(groups, 1):
                for nodes in cells:
                    number += 1
                    print(number, KINDS[dimension, len(nodes)], 2, tag, tag, *nodes, file=file)
            print("$EndElements", file=file)


def blend(u, outer, inner):
    return tuple(u * a + (1 - u) * b for a, b in zip(outer, inner))

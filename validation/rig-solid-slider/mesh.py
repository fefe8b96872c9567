"""Writes rig.msh (mm): disc and bar of ../../meshes/rig-medium.msh, and the slider in 20-node hexahedra, two through its thickness.

python3 mesh.py [CELLS ALONG x, y, z] [FILE]"""
import math
import sys

sys.path.append("..")
from hexahedra import Mesh

LENGTH, WIDTH, TOP, THICKNESS = 200.0, 120.0, -75.0, 10.0


def sections(path):
    """The lines of a Gmsh file by section."""
    found, name = {}, None
    for line in open(path).read().split("\n"):
        if line.startswith("$End"):
            name = None
        elif line.startswith("$"):
            name = line[1:]
            found[name] = []
        elif name:
            found[name].append(line)
    return found


def disc_and_bar(path="../../meshes/rig-medium.msh"):
    """Coordinates by tag, and (type, region, nodes) of the elements that are not of the slider."""
    parts = sections(path)
    regions = {}
    for line in parts["PhysicalNames"][1:]:
        dimension, tag, name = line.split()
        regions[int(dimension), int(tag)] = name.strip('"')
    counts = [int(n) for n in parts["Entities"][0].split()]
    physical, row = {}, 1
    for dimension, count in enumerate(counts):
        for _ in range(count):
            values = parts["Entities"][row].split()
            at = 4 if dimension == 0 else 7
            physical[dimension, int(values[0])] = [int(v) for v in values[at + 1:at + 1 + int(values[at])]]
            row += 1
    points, row = {}, 1
    lines = parts["Nodes"]
    while row < len(lines):
        n = int(lines[row].split()[3])
        for k in range(n):
            points[int(lines[row + 1 + k])] = [float(c) for c in lines[row + 1 + n + k].split()]
        row += 1 + 2 * n
    elements, row = [], 1
    lines = parts["Elements"]
    while row < len(lines):
        dimension, entity, kind, n = (int(v) for v in lines[row].split())
        for k in range(n):
            nodes = [int(v) for v in lines[row + 1 + k].split()[1:]]
            elements += [(kind, (dimension, regions[dimension, tag]), nodes) for tag in physical[dimension, entity]]
        row += 1 + n
    elements = [e for e in elements if not e[1][1].startswith("slider")]
    used = {n for _, _, nodes in elements for n in nodes}
    return {tag: x for tag, x in points.items() if tag in used}, elements


def towards_the_middle(t):
    """Cells are half as long in the middle as on the average."""
    s = 2 * t - 1
    return 0.5 * (1 + 0.5 * s + 0.5 * s**3)


def slider(cells):
    mesh = Mesh(20)
    mesh.block(cells, lambda u, v, w: (LENGTH * (towards_the_middle(u) - 0.5), WIDTH * (towards_the_middle(v) - 0.5), TOP + THICKNESS * (w - 1)))
    middle = TOP - THICKNESS / 2

    elements = [(16, (2, "slider_top"), nodes) for nodes in mesh.faces(lambda x, y, z: z > TOP - 1e-9)]
    for end, sign in ("min", -1), ("max", 1):
        elements += [(16, (2, f"slider_side_y_{end}"), nodes) for nodes in mesh.faces(lambda x, y, z: sign * y > WIDTH / 2 - 1e-9)]
    for axis, name, half in (0, "x", LENGTH / 2), (1, "y", WIDTH / 2):
        for end, sign in ("min", -1), ("max", 1):
            elements += [(8, (1, f"slider_edge_{name}_{end}"), line) for line in
                         mesh.lines(lambda *x: abs(x[axis] - sign * half) < 1e-9 and abs(x[2] - middle) < 1e-9)]
    elements += [(17, (3, "slider"), nodes) for nodes in mesh.cells]
    return mesh.points, elements


def main(cells=(14, 10, 2), path="rig.msh"):
    points, elements = disc_and_bar()
    index = {tag: i for i, tag in enumerate(points, 1)}
    places = list(points.values())
    elements = [(kind, region, [index[n] for n in nodes]) for kind, region, nodes in elements]
    solid, cells = slider(cells)
    elements += [(kind, region, [n + len(places) for n in nodes]) for kind, region, nodes in cells]
    places += solid
    regions = sorted({region for _, region, _ in elements})
    with open(path, "w") as file:
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", len(regions), sep="\n", file=file)
        for tag, (dimension, name) in enumerate(regions, 1):
            print(dimension, tag, f'"{name}"', file=file)
        print("$EndPhysicalNames\n$Nodes", len(places), sep="\n", file=file)
        for tag, x in enumerate(places, 1):
            print(tag, *(f"{c + 0.0:.9g}" for c in x), file=file)
        print("$EndNodes\n$Elements", len(elements), sep="\n", file=file)
        for number, (kind, region, nodes) in enumerate(elements, 1):
            tag = regions.index(region) + 1
            print(number, kind, 2, tag, tag, *nodes, file=file)
        print("$EndElements", file=file)


arguments = sys.argv[1:]
main(tuple(int(n) for n in arguments[:3]) or (14, 10, 2), arguments[3] if len(arguments) > 3 else "rig.msh")

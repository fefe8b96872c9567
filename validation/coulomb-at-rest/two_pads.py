"""Writes two-pads.msh (Gmsh 2.2, mm): a disc with a pad of 11 by 9 nodes on either face."""
from math import cos, pi, sin

RADII = [20.75 + k * (75.0 - 20.75) / 9 for k in range(10)]
AROUND = 64
NAMES = {1: (2, "disc"), 2: (1, "hub"), 3: (2, "front"), 4: (2, "back")}

nodes, elements = [], []
for radius in RADII:
    for k in range(AROUND):
        angle = 2 * pi * k / AROUND
        nodes.append((0.0, radius * sin(angle), radius * cos(angle)))


def at(ring, k):
    return ring * AROUND + k % AROUND + 1


for k in range(AROUND):
    elements.append((1, 2, (at(0, k), at(0, k + 1))))
for ring in range(len(RADII) - 1):
    for k in range(AROUND):
        elements.append((3, 1, (at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1))))
for group, x in ((3, 3.0), (4, -3.0)):
    first = len(nodes) + 1
    for i in range(11):
        for j in range(9):
            nodes.append((x, -15.0 + 3.0 * i, 50.0 + 2.5 * j))
    for i in range(10):
        for j in range(8):
            a = first + 9 * i + j
            elements.append((3, group, (a, a + 9, a + 10, a + 1)))
with open("two-pads.msh", "w") as out:
    out.write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n" % len(NAMES))
    for tag, (dimension, name) in NAMES.items():
        out.write('%d %d "%s"\n' % (dimension, tag, name))
    out.write("$EndPhysicalNames\n$Nodes\n%d\n" % len(nodes))
    for number, place in enumerate(nodes, 1):
        out.write("%d %.6g %.6g %.6g\n" % (number, *place))
    out.write("$EndNodes\n$Elements\n%d\n" % len(elements))
    for number, (kind, group, corners) in enumerate(elements, 1):
        out.write("%d %d 2 %d %d %s\n" % (number, kind, group, group, " ".join(map(str, corners))))
    out.write("$EndElements\n")

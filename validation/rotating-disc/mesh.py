"""Writes ring.msh: a ring of mean radius 100 mm and section 1 mm × 1 mm about the z axis, 80 hexahedra of 20 nodes, in mm."""
import math
import sys

sys.path.append("..")
from hexahedra import Mesh

RADIUS, SIZE, AROUND = 100.0, 1.0, 80

mesh = Mesh(nodes=20)


def place(u, v, w):
    r, angle = RADIUS + SIZE * (u - 0.5), 2 * math.pi * v
    return r * math.cos(angle), r * math.sin(angle), SIZE * w


mesh.block((1, AROUND, 1), place)
mesh.write("ring.msh", "ring")

"""Writes the free disc of radius 100 mm in hexahedra of 20 nodes, a tenth, a twentieth and a fortieth of its radius thick (mm)."""
import math
import sys

sys.path.append("..")
from hexahedra import Mesh, blend

RADIUS, CORE = 100.0, 0.5


def angle(t):
    return math.tan(math.pi / 4 * (2 * t - 1))


def core(x, y):
    bulge = 0.2 * max(abs(x), abs(y)) / (math.hypot(x, y) or 1)
    return tuple(CORE * RADIUS * (0.6 + bulge) * c for c in (x, y))


for name, h in ("tenth", 10.0), ("twentieth", 5.0), ("fortieth", 2.5):
    mesh = Mesh(20)
    mesh.block((8, 8, 1), lambda u, v, w: (*core(angle(u), angle(v)), h * w))
    # Rings, the outer two as wide as the zone at the edge in which theories of plates differ.
    inner = 1 - 2 * h / (RADIUS * (1 - CORE * 0.75))
    breaks = [0, inner / 3, 2 * inner / 3, inner, (inner + 2) / 3, 1]
    for turn in range(4):

        def place(u, v, w, turn=turn):
            x, y = 1.0, angle(v)
            for _ in range(turn):
                x, y = -y, x
            size, k = math.hypot(x, y), min(int(5 * u), 4)
            out = breaks[k] + (5 * u - k) * (breaks[k + 1] - breaks[k])
            return (*blend(out, (RADIUS * x / size, RADIUS * y / size), core(x, y)), h * w)

        mesh.block((5, 8, 1), place)
    mesh.write(f"{name}.msh", "disc")

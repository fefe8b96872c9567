"""Writes the meshes of FV22, FV32, FV41, FV42 and FV52 in metres: hexahedra of 20 or 27 nodes, of half the thickness, a sector or the whole."""
import math
import sys

sys.path.append("..")
from hexahedra import Mesh


SLANT = math.sqrt(0.5)


def rhombus(u, v, z):
    """Sides of 10 m at 45 degrees; cells are smaller towards the edges."""
    u, v = ((1 - math.cos(math.pi * t)) * 0.25 + 0.5 * t for t in (u, v))
    return 10 * (u + SLANT * v), 10 * SLANT * v, z


def rhombic_plate():
    """FV22: the upper half of a thickness of 1 m."""
    mesh = Mesh()
    mesh.block((18, 18, 1), lambda u, v, w: rhombus(u, v, 0.5 * w))
    mesh.write("fv22.msh", "plate", middle=lambda x, y, z: z < 1e-9,
               edges=lambda x, y, z: min(y, 10 * SLANT - y, x - y, 10 - x + y) < 1e-6)


def rhombic_middle(n=32):
    """Its middle plane in quadrilaterals for the theory of plates."""
    def tag(i, j):
        return 1 + i + (n + 1) * j

    lines = [(1, tag(i, j), tag(i + 1, j)) for j in (0, n) for i in range(n)]
    lines += [(1, tag(i, j), tag(i, j + 1)) for i in (0, n) for j in range(n)]
    cells = [(2, tag(i, j), tag(i + 1, j), tag(i + 1, j + 1), tag(i, j + 1)) for j in range(n) for i in range(n)]
    with open("fv22-middle.msh", "w") as file:
        print('$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 "edges"\n2 2 "plate"\n$EndPhysicalNames', file=file)
        print("$Nodes", (n + 1) ** 2, sep="\n", file=file)
        for j in range(n + 1):
            for i in range(n + 1):
                x, y, _ = rhombus(i / n, j / n, 0)
                print(tag(i, j), f"{x:.9g} {y:.9g} 0", file=file)
        print("$EndNodes\n$Elements", len(lines + cells), sep="\n", file=file)
        for number, (region, *corners) in enumerate(lines + cells, 1):
            print(number, 1 if len(corners) == 2 else 3, 2, region, region, *corners, file=file)
        print("$EndElements", file=file)


def tapered_membrane():
    """FV32: 10 m long, 5 m wide where it is held and 1 m at its end, the upper half of 0.05 m."""
    mesh = Mesh(20)
    # Finer towards the root, whose corners are singular.
    mesh.block((16, 10, 1), lambda u, v, w: (10 * u**1.4, (v - 0.5) * (5 - 4 * u**1.4), 0.025 * w))
    mesh.write("fv32.msh", "membrane", middle=lambda x, y, z: z < 1e-9, root=lambda x, y, z: x < 1e-9)


def cylinder():
    """FV41: radii 1.8 and 2.2 m, length 10 m, 3 degrees of it."""
    mesh, angle = Mesh(20, 11), math.radians(3)

    def place(u, v, w):
        r, theta = 1.8 + 0.4 * u, angle * v
        return r * math.cos(theta), r * math.sin(theta), 10 * w

    mesh.block((2, 1, 40), place)
    mesh.write("fv41.msh", "cylinder", start=lambda x, y, z: abs(math.atan2(y, x)) < 1e-9,
               end=lambda x, y, z: abs(math.atan2(y, x) - angle) < 1e-9)


def sphere():
    """FV42: radii 1.8 and 6 m, what four planes through the centre cut out, 0.03 radians to either side of x."""
    mesh, angle = Mesh(27, 11), 0.03

    def place(u, v, w):
        r = 1.8 + 4.2 * u
        at = 1.0, math.tan(angle * (2 * v - 1)), math.tan(angle * (2 * w - 1))
        return tuple(r * x / math.hypot(*at) for x in at)

    mesh.block((12, 1, 1), place)
    sides = [("right", 1, -1), ("left", 1, 1), ("below", 2, -1), ("above", 2, 1)]
    mesh.write("fv42.msh", "sphere", **{
        name: lambda *x, k=k, sign=sign: abs(math.atan2(x[k], x[0]) - sign * angle) < 1e-9 for name, k, sign in sides})


def solid_plate():
    """FV52: 10 x 10 x 1 m, the mesh of the benchmark."""
    mesh = Mesh(20)
    mesh.block((4, 4, 1), lambda u, v, w: (10 * u, 10 * v, w))
    mesh.write("fv52.msh", "plate", {"edges": lambda x, y, z: z < 1e-9 and min(x, y, 10 - x, 10 - y) < 1e-9})


rhombic_plate()
rhombic_middle()
tapered_membrane()
cylinder()
sphere()
solid_plate()

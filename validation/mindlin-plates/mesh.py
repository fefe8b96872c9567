"""Writes quads.msh: the square of 100 mm in 24 x 24 quadrilaterals, none of those inside a rectangle, and its edges (Gmsh 2.2, text)."""
import math

N, SIDE = 24, 100.0


def place(i, j):
    """Node (i, j): a regular grid whose inside is pushed about by up to a fifth of a cell."""
    x, y = i / N, j / N
    push = 0.2 / N * math.sin(math.pi * x) * math.sin(math.pi * y)
    return SIDE * (x + push * math.sin(9 * i + 4 * j)), SIDE * (y + push * math.sin(5 * i - 7 * j))


def tag(i, j):
    return 1 + i + (N + 1) * j


lines = [(1, tag(i, j), tag(i + 1, j)) for j in (0, N) for i in range(N)]
lines += [(2, tag(i, j), tag(i, j + 1)) for i in (0, N) for j in range(N)]
cells = [(3, tag(i, j), tag(i + 1, j), tag(i + 1, j + 1), tag(i, j + 1)) for j in range(N) for i in range(N)]
with open("quads.msh", "w") as file:
    print("$MeshFormat\n2.2 0 8\n$EndMeshFormat", file=file)
    print('$PhysicalNames\n3\n1 1 "along_x"\n1 2 "along_y"\n2 3 "plate"\n$EndPhysicalNames', file=file)
    print(f"$Nodes\n{(N + 1) ** 2}", file=file)
    for j in range(N + 1):
        for i in range(N + 1):
            x, y = place(i, j)
            print(f"{tag(i, j)} {x:.7f} {y:.7f} 0", file=file)
    print(f"$EndNodes\n$Elements\n{len(lines) + len(cells)}", file=file)
    for number, (region, *corners) in enumerate(lines + cells, 1):
        print(number, 1 if len(corners) == 2 else 3, 2, region, region, *corners, file=file)
    print("$EndElements", file=file)

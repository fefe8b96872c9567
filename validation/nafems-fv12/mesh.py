"""Writes quads.msh: the plate of 10 m by 10 m in 24 x 24 quadrilaterals, none of them a rectangle (Gmsh 4.1, text)."""
import math

N, SIDE = 24, 10.0


def place(i, j):
    """Node (i, j): a regular grid whose inside is pushed about by up to a fifth of a cell."""
    x, y = i / N, j / N
    push = 0.2 / N * math.sin(math.pi * x) * math.sin(math.pi * y)
    return SIDE * (x + push * math.sin(9 * i + 4 * j)), SIDE * (y + push * math.sin(5 * i - 7 * j))


nodes = [(1 + i + (N + 1) * j, *place(i, j)) for j in range(N + 1) for i in range(N + 1)]
cells = [(1 + i + (N + 1) * j, 2 + i + (N + 1) * j, 2 + i + (N + 1) * (j + 1), 1 + i + (N + 1) * (j + 1))
         for j in range(N) for i in range(N)]
with open("quads.msh", "w") as file:
    print(f"""$MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
1
2 1 "plate"
$EndPhysicalNames
$Entities
0 0 1 0
1 0 0 0 {SIDE} {SIDE} 0 1 1 0
$EndEntities
$Nodes
1 {len(nodes)} 1 {len(nodes)}
2 1 0 {len(nodes)}""", file=file)
    for tag, _, _ in nodes:
        print(tag, file=file)
    for _, x, y in nodes:
        print(f"{x:.9f} {y:.9f} 0", file=file)
    print(f"""$EndNodes
$Elements
1 {len(cells)} 1 {len(cells)}
2 1 3 {len(cells)}""", file=file)
    for tag, corners in enumerate(cells, 1):
        print(tag, *corners, file=file)
    print("$EndElements", file=file)

"""Writes rotor.msh, a disc on a hollow shaft held at both ends, 20-node hexahedra in mm, and rotor.inp, the same for CalculiX (ccx rotor)."""
import math
import sys

sys.path.append("..")
from hexahedra import EDGES, Mesh

AROUND, SPEED = 12, 3000.0   # cells around; rad/s
RADII = (2.0, 4.0, 12.0, 20.0)  # bore and shaft, disc
LEVELS = (0.0, 12.0, 24.0, 36.0, 38.0, 52.0, 66.0, 80.0)
DISC = 3                    # the layer with the disc
# The edges of C3D20 in its order: around the bottom, around the top, upright.
ABAQUS = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]

mesh = Mesh(20)


def ring(inner, outer, low, high):
    def place(u, v, w):
        r, angle = inner + (outer - inner) * u, 2 * math.pi * v
        return r * math.cos(angle), r * math.sin(angle), low + (high - low) * w
    mesh.block((1, AROUND, 1), place)


for layer, (low, high) in enumerate(zip(LEVELS, LEVELS[1:])):
    for inner, outer in zip(RADII, RADII[1:] if layer == DISC else RADII[1:2]):
        ring(inner, outer, low, high)
ends = lambda x, y, z: min(z, LEVELS[-1] - z) < 1e-9
mesh.write("rotor.msh", "rotor", held=ends)
with open("rotor.inp", "w") as file:
    print("*NODE,NSET=NALL", file=file)
    for tag, x in enumerate(mesh.points, 1):
        print(tag, *(f"{c:.9g}" for c in x), sep=",", file=file)
    print("*ELEMENT,TYPE=C3D20,ELSET=EALL", file=file)
    for number, cell in enumerate(mesh.cells, 1):
        nodes = list(cell[:8]) + [cell[8 + EDGES.index(tuple(sorted(edge)))] for edge in ABAQUS]
        print(number, *nodes[:10], sep=",", end=",\n", file=file)
        print(*nodes[10:], sep=",", file=file)
    print("*NSET,NSET=NFIX", *(tag for tag, x in enumerate(mesh.points, 1) if ends(*x)), sep="\n", file=file)
    print(f"""*BOUNDARY
NFIX,1,3
*SOLID SECTION,ELSET=EALL,MATERIAL=STEEL
*MATERIAL,NAME=STEEL
*ELASTIC
210000.,.3
*DENSITY
7.8E-9
*STEP
*STATIC
*DLOAD
EALL,CENTRIF,{SPEED**2},0.,0.,0.,0.,0.,1.
*END STEP
*STEP,PERTURBATION
*FREQUENCY,STORAGE=YES
60,
*END STEP
*STEP,PERTURBATION
*COMPLEX FREQUENCY,CORIOLIS
24,
*END STEP""", file=file)

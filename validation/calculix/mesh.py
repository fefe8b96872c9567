"""Writes plate-8.msh, plate-20.msh and beam-20.msh in mm: the boxes of CalculiX' tests dloadlinIf, dloadlin20f and beamf, cell by cell."""
import sys

sys.path.append("..")
from hexahedra import Mesh


def box(name, nodes, lengths, cells, along):
    """Held where the coordinate `along` is zero."""
    mesh = Mesh(nodes)
    mesh.block(cells, lambda *part: tuple(p * length for p, length in zip(part, lengths)))
    mesh.write(name, "body", held=lambda *x: x[along] < 1e-9)


box("plate-8.msh", 8, (300, 30, 1), (15, 1, 1), 0)
box("plate-20.msh", 20, (300, 30, 1), (15, 1, 1), 0)
box("beam-20.msh", 20, (1, 1.5, 8), (2, 2, 8), 2)

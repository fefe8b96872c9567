"""The models of the benches, made by stridor itself and stored for every program: `models.py STRIDOR FOLDER KIND DOFS`.

`real`: a steel annulus (15 to 75 mm, 1 mm thick) clamped at its hub, triangles of one size, three degrees of freedom a node.

`complex`: two such discs, 1 mm and 1.3 mm thick, pressed on each other at about 100 nodes. Each pair carries the normal
stiffness k and damping c between the two deflections; friction μ on faces 2.5 mm off the mid-planes turns the normal force
into moments about the radius, which makes K and C unsymmetric in 600 rows. Rayleigh damping besides.

`solid`: a steel ring (75 to 150 mm, 25 mm thick) clamped at its bore, of 10-node tetrahedra of one size: bricks cut into six.

`brake`: that ring of another size with a pad that slides on 60° of its face, of DOFS and POINTS (`brake-1000`: about 1,000 contact
points); K and C have the contact at steady sliding, friction μ = 0.5, and are not symmetric. case.toml has the contact as such.

`step`: one such disc with Rayleigh damping, pressed at ten nodes on a counter-body that slides past. The stiffness and friction of
the contact stay out of the matrices: case.toml has them.

FOLDER gets m.mtx, k.mtx, c.mtx for stridor, the same as .npz for the others, and case files.
"""
import csv
import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import scipy.io
import scipy.sparse as sp
from scipy.spatial import cKDTree

OUTER, HUB = 0.075, 0.015
CASE = """title = "A clamped disc"
[mesh]
file = "disc.msh"
unit = "mm"
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[shell.disc]
material = "steel"
thickness = {thickness}
bending_only = true
rotary_inertia = false
[support.hub]
on = "hub"
"""
SOLID = """title = "A clamped ring of solids"
[mesh]
file = "ring.msh"
unit = "m"
[material.steel]
youngs_modulus = "210 GPa"
poissons_ratio = 0.3
density = "7850 kg/m^3"
[solid.ring]
material = "steel"
[support.bore]
on = "bore"
"""
BRAKE = """title = "A pad on a ring"
[mesh]
file = "brake.msh"
unit = "m"
[material.iron]
youngs_modulus = "120 GPa"
poissons_ratio = 0.26
density = "7200 kg/m^3"
rayleigh = { alpha = "10 1/s", beta = "1e-8 s" }
[material.lining]
youngs_modulus = "8 GPa"
poissons_ratio = 0.25
density = "2500 kg/m^3"
rayleigh = { alpha = "10 1/s", beta = "1e-8 s" }
[solid.disc]
material = "iron"
[solid.pad]
material = "lining"
[support.bore]
on = "bore"
[support.back]
on = "pad_back"
held = ["ux", "uy"]
[contact.pad]
body = "pad_face"
counter = "disc_face"
approach = 0
rotation = { axis = [0, 0, 1], speed = "300 rpm" }
normal = { per = "area", stiffness = "100 GN/m^3" }
friction = { law = "coulomb", mu0 = 0.5 }
[force.piston]
on = "pad_back"
pressure = "1 MPa"
"""
STEP = """title = "A disc in sliding contact at ten points"
[matrices]
mass = "m.mtx"
stiffness = "k.mtx"
damping = "c.mtx"
[contact.pad]
points = {points}
load = "50 N"
sliding_velocity = "0.5 m/s"
normal = {{ per = "point", stiffness = "1 MN/m" }}
friction = {{ law = "exponential", mu0 = 0.3, mu1 = 0.2, alpha = "2 s/m", regularisation = "1 mm/s" }}
"""
# Normal stiffness [N/m] and damping [N s/m] of all pairs, friction, lever of the faces [m], Rayleigh damping [1/s, s].
STIFFNESS, DAMPING, FRICTION, LEVER, ALPHA, BETA = 1e6, 1.0, 0.5, 2.5e-3, 5.0, 1.6e-8


def disc(stridor, folder, dofs, thickness):
    """M and K of a disc, and y, z of its nodes; every node has a deflection ux and the rotations ry, rz."""
    folder.mkdir(parents=True, exist_ok=True)
    # Equilateral triangles of side h: one node for every √3/2 h² of area.
    nodes = dofs / 3
    size = np.sqrt(np.pi * (OUTER**2 - HUB**2) / (nodes * np.sqrt(3) / 2))
    mesh = folder / "disc.msh"
    if not mesh.exists():
        subprocess.run([stridor, "mesh", "disc", "--out", mesh, "--outer-radius", f"{OUTER} m", "--hub-radius",
                        f"{HUB} m", "--size", f"{size} m", "--contact-size", f"{size} m", "--quiet"], check=True)
    (folder / "case.toml").write_text(CASE.format(thickness=thickness))
    out = folder / f"{thickness}"
    subprocess.run([stridor, "export", folder / "case.toml", "--out", out, "--quiet"], check=True)
    m, k = (sp.csr_matrix(scipy.io.mmread(out / f"{name}.mtx")) for name in ("mass", "stiffness"))
    with open(out / "dofs.csv") as rows:
        places = np.array([[float(row["y"]), float(row["z"])] for row in csv.DictReader(rows) if row["ux"] == "1"])
    assert m.shape[0] == 3 * len(places)
    return m, k, places


class Grid:
    """A block of rings or sectors of 10-node tetrahedra: bricks cut into six that have one diagonal in common. Nodes are the points of
    a grid of half the bricks' size: corners, and the middles of all edges. A whole turn closes on itself."""

    def __init__(self, radii, angles, heights, bricks):
        self.bricks = bricks
        closed = np.isclose(angles[1] - angles[0], 2 * np.pi)
        self.points = [2 * n + 1 for n in bricks]
        self.points[1] -= closed
        steps = np.meshgrid(*(np.arange(n) for n in self.points), indexing="ij")
        radius, angle, height = (low + (high - low) * step / (2 * n)
                                 for (low, high), step, n in zip((radii, angles, heights), steps, bricks))
        self.nodes = np.stack([radius * np.cos(angle), radius * np.sin(angle), height], -1).reshape(-1, 3)
        self.corners = 2 * np.stack(np.meshgrid(*(np.arange(n) for n in bricks), indexing="ij"), -1).reshape(-1, 3)

    def number(self, at):
        return (at[..., 0] * self.points[1] + at[..., 1] % self.points[1]) * self.points[2] + at[..., 2]

    def cells(self):
        cells = []
        for first, second in ((0, 1), (1, 2), (2, 0), (0, 2), (2, 1), (1, 0)):
            steps = np.zeros((4, 3), int)
            steps[1:, first], steps[2:, second], steps[3] = 2, 2, 2
            if np.linalg.det(steps[1:] - steps[0]) < 0:
                steps[[1, 2]] = steps[[2, 1]]
            # The order of Gmsh.
            edges = [(0, 1), (1, 2), (2, 0), (3, 0), (2, 3), (1, 3)]
            cells.append(self.number(self.corners[:, None] + with_middles(steps, edges)))
        return np.concatenate(cells)

    def faces(self, axis, high):
        """The sides of bricks at one end of an axis, in two triangles along the diagonal that the tetrahedra have."""
        at = 2 * (self.bricks[axis] - 1) if high else 0
        walls, faces = self.corners[self.corners[:, axis] == at], []
        for first in (axis + 1) % 3, (axis + 2) % 3:
            steps = np.zeros((3, 3), int)
            steps[:, axis] = 2 * high
            steps[1:, first], steps[2] = 2, [2 * high if k == axis else 2 for k in range(3)]
            faces.append(self.number(walls[:, None] + with_middles(steps, [(0, 1), (1, 2), (2, 0)])))
        return np.concatenate(faces)


def with_middles(steps, edges):
    return np.concatenate([steps, [(steps[a] + steps[b]) // 2 for a, b in edges]])


def write_mesh(path, nodes, groups):
    """`groups` are pairs of a name and cells, of 10 nodes (bodies) or 6 (faces)."""
    kinds = {10: (3, 11), 6: (2, 9)}
    with open(path, "w") as file:
        file.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{len(groups)}\n")
        for tag, (name, cells) in enumerate(groups, 1):
            file.write(f'{kinds[cells.shape[1]][0]} {tag} "{name}"\n')
        file.write(f"$EndPhysicalNames\n$Nodes\n{len(nodes)}\n")
        np.savetxt(file, np.c_[np.arange(1, len(nodes) + 1), nodes], fmt="%d %.17g %.17g %.17g")
        file.write(f"$EndNodes\n$Elements\n{sum(len(cells) for _, cells in groups)}\n")
        first = 1
        for tag, (_, cells) in enumerate(groups, 1):
            head = np.tile([kinds[cells.shape[1]][1], 2, tag, tag], (len(cells), 1))
            np.savetxt(file, np.c_[np.arange(first, first + len(cells)), head, 1 + cells], fmt="%d")
            first += len(cells)
        file.write("$EndElements\n")


def ring(dofs):
    inner, outer, thickness = 0.075, 0.15, 0.025
    radial = max(2, round((dofs / 75) ** (1 / 3)))
    through = max(1, round(radial * thickness / (outer - inner)))
    around = max(8, round(np.pi * (outer + inner) * radial / (outer - inner)))
    return Grid((inner, outer), (0, 2 * np.pi), (0, thickness), (radial, around, through))


def brake(stridor, folder, dofs, points):
    """M, C and K of small motions of a ring on which a pad of about so many contact points slides; the case beside them has the contact
    as such."""
    folder.mkdir(parents=True, exist_ok=True)
    disc = ring(dofs)
    # Three points a triangle, sides of one length.
    radial = max(2, round((points / 12) ** 0.5))
    pad = Grid((0.085, 0.145), np.radians([60, 120]), (0.025, 0.037), (radial, 2 * radial, max(2, radial // 5)))
    own = len(disc.nodes)
    write_mesh(folder / "brake.msh", np.concatenate([disc.nodes, pad.nodes]), [
        ("disc", disc.cells()), ("bore", disc.faces(0, False)), ("disc_face", disc.faces(2, True)),
        ("pad", own + pad.cells()), ("pad_face", own + pad.faces(2, False)), ("pad_back", own + pad.faces(2, True))])
    (folder / "case.toml").write_text(BRAKE)
    subprocess.run([stridor, "export", folder / "case.toml", "--linearised", "--out", folder / "matrices", "--quiet"], check=True)
    return [sp.csr_matrix(scipy.io.mmread(folder / "matrices" / f"{name}.mtx")) for name in ("mass", "damping", "stiffness")]


def solid(stridor, folder, dofs):
    """M and K of a ring of solids; every node has ux, uy, uz."""
    folder.mkdir(parents=True, exist_ok=True)
    grid = ring(dofs)
    write_mesh(folder / "ring.msh", grid.nodes, [("ring", grid.cells()), ("bore", grid.faces(0, False))])
    (folder / "case.toml").write_text(SOLID)
    subprocess.run([stridor, "export", folder / "case.toml", "--out", folder / "matrices", "--quiet"], check=True)
    return [sp.csr_matrix(scipy.io.mmread(folder / "matrices" / f"{name}.mtx")) for name in ("mass", "stiffness")]


def two_discs(stridor, folder, dofs):
    (m_1, k_1, places), (m_2, k_2, _) = (disc(stridor, folder / "parts", dofs / 2, h) for h in (1e-3, 1.3e-3))
    n = m_1.shape[0]
    m, k = sp.block_diag((m_1, m_2), "csr"), sp.block_diag((k_1, k_2), "csr")
    radius, angle = np.meshgrid(np.linspace(0.05, 0.07, 10), np.radians(np.linspace(-25, 25, 10)))
    wanted = np.c_[(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()]
    touching = np.unique(cKDTree(places).query(wanted)[1])
    pairs = len(touching)
    columns = np.arange(pairs)

    def directions(*parts):
        rows = np.concatenate([row for row, _ in parts])
        values = np.concatenate([np.broadcast_to(value, pairs) for _, value in parts])
        return sp.csr_matrix((values, (rows, np.tile(columns, len(parts)))), (2 * n, pairs))

    theta = np.arctan2(places[touching, 1], places[touching, 0])
    first, second = 3 * touching, n + 3 * touching
    gap = directions((first, 1.0), (second, -1.0))
    moment = directions(*((side + 1 + axis, FRICTION * LEVER * turn) for side in (first, second)
                          for axis, turn in enumerate((np.cos(theta), np.sin(theta)))))
    normal, friction = gap @ gap.T, moment @ gap.T
    stiffness, damping = STIFFNESS / pairs, DAMPING / pairs
    return (m, ALPHA * m + BETA * (k + stiffness * normal) + damping * (normal + friction),
            k + stiffness * (normal + friction))


def pressed(places):
    """The case of `step`: normal ux; the sliding direction is that of the circumference on a face off the mid-plane."""
    angle = np.radians(36 * np.arange(10))
    nodes = cKDTree(places).query(0.065 * np.c_[np.cos(angle), np.sin(angle)])[1]
    points = []
    for node in nodes:
        cos, sin = places[node] / np.linalg.norm(places[node])
        along, across = (" ".join(f"{LEVER * turn:.17e}*{3 * node + axis}" for axis, turn in ((2, a), (3, b)))
                         for a, b in ((cos, sin), (-sin, cos)))
        points.append([str(3 * node + 1), along, across])
    return STEP.format(points=json.dumps(points))


def main(stridor, folder, kind, dofs):
    if kind in ("real", "step"):
        m, k, places = disc(stridor, folder / "parts", dofs, 1e-3)
        matrices = {"m": m, "k": k}
        if kind == "step":
            matrices["c"] = ALPHA * m + BETA * k
            (folder / "case.toml").write_text(pressed(places))
    elif kind.startswith("brake"):
        matrices = dict(zip("mck", brake(stridor, folder / "parts", dofs, float(kind.partition("-")[2]))))
    elif kind == "solid":
        matrices = dict(zip("mk", solid(stridor, folder / "parts", dofs)))
    else:
        matrices = dict(zip("mck", two_discs(stridor, folder, dofs)))
    for name, matrix in matrices.items():
        matrix = matrix.tocsr()
        matrix.sort_indices()
        sp.save_npz(folder / f"{name}.npz", matrix, compressed=False)
        symmetry = "symmetric" if abs(matrix - matrix.T).max() == 0 else "general"
        scipy.io.mmwrite(folder / f"{name}.mtx", matrix, symmetry=symmetry, precision=17)
    skew = matrices["k"] - matrices["k"].T
    skew.eliminate_zeros()
    print(f"{kind}: {matrices['k'].shape[0]} degrees of freedom, {matrices['k'].nnz} entries of K, "
          f"{len(np.unique(skew.nonzero()[0]))} rows not symmetric")


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]).absolute(), sys.argv[3], float(sys.argv[4]))

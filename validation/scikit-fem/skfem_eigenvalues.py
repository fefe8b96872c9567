"""Natural frequencies [Hz] of curved.msh and straight.msh with the matrices of scikit-fem 12.0.2 (scipy), the face z = 0 held."""
import numpy as np
from scipy.sparse.linalg import eigsh
from skfem import Basis, BilinearForm, ElementTetP2, ElementVector, MeshTet1, MeshTet2, condense
from skfem.helpers import dot
from skfem.models.elasticity import lame_parameters, linear_elasticity

YOUNG, POISSON, DENSITY = 210e9, 0.3, 7850.0


def walkington():
    """14 points, exact to degree five (N. J. Walkington, Quadrature on simplices of arbitrary dimension, 2000), those of stridor."""
    points, weights = [], []
    for a, weight in (0.3108859192633006, 0.11268792571801585), (0.09273525031089123, 0.07349304311636195):
        b = 1 - 3 * a
        points += [[a, a, a], [b, a, a], [a, b, a], [a, a, b]]
        weights += [weight / 6] * 4
    a, b = 0.04550370412564965, 0.45449629587435035
    points += [[a, a, b], [a, b, a], [b, a, a], [a, b, b], [b, a, b], [b, b, a]]
    weights += [0.04254602077708147 / 6] * 6
    return np.array(points).T, np.array(weights)


def read(path):
    """Coordinates [m] and the 10 nodes of each tetrahedron of a Gmsh 2.2 file."""
    lines = iter(open(path).read().split("\n"))
    points, cells = {}, []
    for line in lines:
        if line == "$Nodes":
            for _ in range(int(next(lines))):
                tag, *x = next(lines).split()
                points[int(tag)] = [float(c) * 1e-3 for c in x]
        if line == "$Elements":
            for _ in range(int(next(lines))):
                row = [int(c) for c in next(lines).split()]
                if row[1] == 11:
                    cells.append(row[3 + row[2]:])
    used = sorted({n for cell in cells for n in cell})
    index = {tag: i for i, tag in enumerate(used)}
    return np.array([points[tag] for tag in used]), np.array([[index[n] for n in cell] for cell in cells])


def quadratic(points, cells):
    """The mesh of scikit-fem with these nodes in the middle of its edges."""
    corners = np.unique(cells[:, :4])
    back = {n: i for i, n in enumerate(corners)}
    linear = MeshTet1(points[corners].T, np.array([[back[n] for n in cell[:4]] for cell in cells]).T)
    mesh = MeshTet2.from_mesh(linear)
    where = mesh.doflocs.copy()
    # Gmsh's order of the edges.
    edges = [(0, 1), (1, 2), (0, 2), (0, 3), (2, 3), (1, 3)]
    middle = {tuple(sorted((back[c[a]], back[c[b]]))): points[c[4 + k]] for c in cells for k, (a, b) in enumerate(edges)}
    basis = Basis(mesh, ElementTetP2())
    for edge, dof in zip(linear.edges.T, basis.dofs.edge_dofs[0]):
        where[:, dof] = middle[tuple(sorted(edge))]
    for node, dof in enumerate(basis.dofs.nodal_dofs[0]):
        where[:, dof] = linear.p[:, node]
    return MeshTet2(where, mesh.t)


def frequencies(path, rule, count):
    """`rule` of scikit-fem's Basis."""
    points, cells = read(path)
    mesh = quadratic(points, cells)
    basis = Basis(mesh, ElementVector(ElementTetP2()), **rule)
    stiffness = linear_elasticity(*lame_parameters(YOUNG, POISSON)).assemble(basis)
    mass = BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(basis)
    held = basis.get_dofs(lambda x: np.abs(x[2]) < 1e-9).all()
    k, m, _, _ = condense(stiffness, mass, D=held)
    values = eigsh(k, count, m, sigma=0, tol=0, v0=np.ones(k.shape[0]), return_eigenvectors=False)
    return np.sort(np.sqrt(values) / 2 / np.pi)


if __name__ == "__main__":
    # Exact on straight cells, where K is of degree 2 and M of degree 4; on curved ones K is rational.
    for name, rule in (("straight", {"intorder": 4}), ("curved", {"quadrature": walkington()}), ("curved", {"intorder": 8})):
        found = frequencies(f"{name}.msh", rule, 12)
        print(name, rule.get("intorder", "14 points"), *(f"{f:.9f}" for f in found), sep="\n  ")

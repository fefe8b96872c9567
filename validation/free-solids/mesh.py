"""Writes sphere.msh, ring.msh (hexahedra of 27 nodes), cylinder.msh (of 20), cylinder-8.msh, cylinder-wedges-6.msh, cylinder-wedges-15.msh,
cylinder-pyramids.msh and sphere-tetrahedra.msh (by Gmsh), all in mm. The middles of edges and faces lie on the curved surfaces."""
import math
import sys

sys.path.append("..")
from hexahedra import Mesh, blend

# CORE: the half edge of the block in the middle, as a part of the radius.
RADIUS, CORE, LENGTH = 50.0, 0.5, 60.0


def sphere():
    """A cube in the middle, bulged a little, and a block of each of its sides up to the surface."""
    mesh = Mesh()

    def angle(t):
        return math.tan(math.pi / 4 * (2 * t - 1))

    def out(x):
        size = math.hypot(*x)
        return tuple(RADIUS * c / size for c in x)

    def core(x):
        """Between a cube and a sphere."""
        bulge = 0.4 * max(map(abs, x)) / (math.hypot(*x) or 1)
        return tuple(CORE * RADIUS * (0.4 + bulge) * c for c in x)

    mesh.block((4, 4, 4), lambda u, v, w: core((angle(u), angle(v), angle(w))))
    for axis in range(3):
        for sign in (-1, 1):

            def place(u, v, w, axis=axis, sign=sign):
                x = [0.0, 0.0, 0.0]
                x[axis] = float(sign)
                # Right-handed on either side.
                x[(axis + 1) % 3], x[(axis + 2) % 3] = sign * angle(u), angle(v)
                return blend(w, out(x), core(x))

            mesh.block((4, 4, 3), place)
    mesh.write("sphere.msh", "sphere")


def cylinder(name, mesh, around=4, along=7, **regions):
    """Radius 25 mm, length 60 mm: a square in the middle and a block of each of its sides, along z."""
    radius, length = 25.0, LENGTH

    def core(x, y):
        bulge = 0.2 * max(abs(x), abs(y)) / (math.hypot(x, y) or 1)
        return tuple(CORE * radius * (0.6 + bulge) * c for c in (x, y))

    def side(x, y, w):
        size = math.hypot(x, y)
        return blend(w, (radius * x / size, radius * y / size), core(x, y))

    def angle(t):
        return math.tan(math.pi / 4 * (2 * t - 1))

    mesh.block((around, around, along), lambda u, v, w: (*core(angle(u), angle(v)), length * w))
    for turn in range(4):

        def place(u, v, w, turn=turn):
            x, y = 1.0, angle(v)
            for _ in range(turn):
                x, y = -y, x
            return (*side(x, y, u), length * w)

        mesh.block((around // 2, around, along), place)
    mesh.write(name, "cylinder", **regions)


def ring():
    """Radii 30 and 50 mm, height 30 mm."""
    mesh = Mesh()

    def place(u, v, w):
        r, theta = 30 + 20 * u, 2 * math.pi * v
        return r * math.cos(theta), r * math.sin(theta), 30 * w

    mesh.block((3, 24, 3), place)
    mesh.write("ring.msh", "ring", bottom=lambda x, y, z: z < 1e-6, top=lambda x, y, z: z > 30 - 1e-6)


def tetrahedra():
    """The same sphere."""
    import gmsh

    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("General.NumThreads", 1)
    gmsh.option.setNumber("Mesh.MeshSizeMin", 15)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 15)
    gmsh.option.setNumber("Mesh.ElementOrder", 2)
    gmsh.option.setNumber("Mesh.HighOrderOptimize", 0)
    gmsh.option.setNumber("Mesh.MshFileVersion", 2.2)
    gmsh.model.occ.addSphere(0, 0, 0, RADIUS)
    gmsh.model.occ.synchronize()
    gmsh.model.addPhysicalGroup(3, [1], name="sphere")
    gmsh.model.mesh.generate(3)
    gmsh.write("sphere-tetrahedra.msh")
    gmsh.finalize()


sphere()
cylinder("cylinder.msh", Mesh(20), bottom=lambda x, y, z: z < 1e-6, top=lambda x, y, z: z > LENGTH - 1e-6)
cylinder("cylinder-8.msh", Mesh(8), around=6, along=12)
cylinder("cylinder-wedges-6.msh", Mesh(6, cells="wedges"), around=6, along=12)
cylinder("cylinder-wedges-15.msh", Mesh(15, cells="wedges"), along=5)
cylinder("cylinder-pyramids.msh", Mesh(13, cells="pyramids"), around=2, along=4)
ring()
tetrahedra()

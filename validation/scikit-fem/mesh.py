"""Writes curved.msh and straight.msh (mm): 10-node tetrahedra of a round disc with a hole off its middle, with the middles of edges on the curved
faces and in the middle of the corners (Gmsh 4.15)."""
import gmsh

for name, linear in ("curved", 0), ("straight", 1):
    gmsh.initialize()
    for option, value in {"General.Terminal": 0, "General.NumThreads": 1, "Mesh.MeshSizeMin": 14, "Mesh.MeshSizeMax": 14,
                          "Mesh.ElementOrder": 2, "Mesh.HighOrderOptimize": 0, "Mesh.SecondOrderLinear": linear,
                          "Mesh.MshFileVersion": 2.2}.items():
        gmsh.option.setNumber(option, value)
    disc = gmsh.model.occ.addCylinder(0, 0, 0, 0, 0, 15, 40)
    hole = gmsh.model.occ.addCylinder(10, 5, 0, 0, 0, 15, 12)
    gmsh.model.occ.cut([(3, disc)], [(3, hole)])
    gmsh.model.occ.synchronize()
    bottom = [tag for _, tag in gmsh.model.getEntitiesInBoundingBox(-50, -50, -1, 50, 50, 1, 2)]
    gmsh.model.addPhysicalGroup(2, bottom, name="bottom")
    gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="disc")
    gmsh.model.mesh.generate(3)
    gmsh.write(f"{name}.msh")
    gmsh.finalize()

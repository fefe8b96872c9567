"""SLEPc with MUMPS, shift and invert: Krylov–Schur for real modes (the real build of PETSc), two-level orthogonal Arnoldi
(TOAR) on the quadratic problem for complex pairs (the complex build). `run` chooses the build by PETSC_DIR, SLEPC_DIR."""
import sys

import numpy as np
import slepc4py

slepc4py.init(sys.argv[:1])
from petsc4py import PETSc   # noqa: E402  (after init)
from slepc4py import SLEPc   # noqa: E402

from common import Clock, arguments, matrices   # noqa: E402


def petsc(matrix):
    rows = (matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32))
    return PETSc.Mat().createAIJ(matrix.shape, csr=(*rows, matrix.data.astype(PETSc.ScalarType)))


def shift_and_invert(solver, factor):
    transform = solver.getST()
    transform.setType("sinvert")
    direct = transform.getKSP()
    direct.setType("preonly")
    direct.getPC().setType(factor)
    direct.getPC().setFactorSolverType("mumps")


def main(args):
    real = args.job == "real"
    if real == np.issubdtype(PETSc.ScalarType, np.complexfloating):
        sys.exit(f"{args.job} pairs need the other build of PETSc")
    given = matrices(args.model, "mk" if real else "mck")
    own = [petsc(matrix) for matrix in given]
    if real:
        [matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True) for matrix in own]
        own[1].setOption(PETSc.Mat.Option.SPD, True)
        solver = SLEPc.EPS().create()
        solver.setOperators(own[1], own[0])
        solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
        solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_MAGNITUDE)
        solver.setTarget(0.0)
    else:
        solver = SLEPc.PEP().create()
        solver.setOperators(own[::-1])
        solver.setType("toar")
        solver.setScale(SLEPc.PEP.Scale.SCALAR)
        solver.setWhichEigenpairs(SLEPc.PEP.Which.TARGET_MAGNITUDE)
        solver.setTarget(2j * np.pi * args.nearest)
    solver.setDimensions(args.count)
    solver.setTolerances(args.tolerance, 500)
    shift_and_invert(solver, "cholesky" if real else "lu")
    clock = Clock()
    solver.setUp()
    clock.lap("factorise")
    solver.solve()
    clock.lap("iterate")
    vector = own[0].createVecLeft()
    values, vectors = [], []
    for i in range(min(solver.getConverged(), args.count)):
        values.append(solver.getEigenpair(i, vector))
        vectors.append(vector.getArray().copy())
    values = np.array(values)
    name = "SLEPc Krylov–Schur + MUMPS" if real else "SLEPc TOAR + MUMPS"
    clock.finish(args, name, given[-1], values.real if real else values, np.array(vectors).T)


if __name__ == "__main__":
    parser = arguments(__doc__)
    parser.add_argument("job", choices=["real", "complex"])
    main(parser.parse_args())

"""ARPACK (scipy) with shift and invert: real modes, or complex pairs through a companion form.

Real modes: K x = ω² M x at the shift 0, which K = L Lᵀ (PARDISO or CHOLMOD) inverts.

Complex pairs: with λ = σ + γ θ⁻¹ the operator is the shift-inverted companion matrix of λ² M + λ C + K: it takes one
complex LU of P(σ) = σ² M + σ C + K for every step, and γ = |σ| makes both halves of its vectors of one size.
"""
import numpy as np
import scipy.sparse.linalg as sla

from common import Clock, arguments, matrices


def factorised(matrix, kind, solver):
    if solver == "cholmod":
        from sksparse.cholmod import cholesky
        return cholesky(matrix.tocsc(), mode="supernodal")
    from pardiso import Pardiso
    return Pardiso(matrix, kind).solve


def real_modes(args):
    m, k = matrices(args.model, "mk")
    clock = Clock()
    solve = factorised(k, "definite", args.solver)
    clock.lap("factorise")
    n = k.shape[0]
    inverse = sla.LinearOperator((n, n), matvec=solve, dtype=float)
    values, vectors = sla.eigsh(k, args.count, m, sigma=0.0, OPinv=inverse, which="LM", tol=args.tolerance,
                                v0=np.ones(n))
    clock.lap("iterate")
    clock.finish(args, f"ARPACK + {args.solver.upper()}", k, values, vectors)


def complex_pairs(args):
    m, c, k = matrices(args.model, "mck")
    n = k.shape[0]
    shift = 2j * np.pi * args.nearest
    size = abs(shift)
    clock = Clock()
    pencil = (shift * shift * m + shift * c + k).tocsr()
    solve = factorised(pencil, "general", args.solver)
    clock.lap("factorise")
    slope, mass = (shift * m + c) * size, m * size ** 2

    def step(v):
        x, y = v[:n], v[n:]
        z = solve(-(slope @ x + mass @ y))
        return np.concatenate([z, x + shift / size * z])

    operator = sla.LinearOperator((2 * n, 2 * n), matvec=step, dtype=complex)
    theta, vectors = sla.eigs(operator, args.count, which="LM", tol=args.tolerance, v0=np.ones(2 * n, complex))
    clock.lap("iterate")
    clock.finish(args, f"complex ARPACK + {args.solver.upper()}", k, shift + size / theta, vectors[:n])


if __name__ == "__main__":
    parser = arguments(__doc__)
    parser.add_argument("job", choices=["real", "complex"])
    chosen = parser.parse_args()
    (real_modes if chosen.job == "real" else complex_pairs)(chosen)

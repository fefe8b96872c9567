"""MKL PARDISO through the library that the package pypardiso brings, for real and complex, symmetric and general matrices.

Its own Python wrapper knows real matrices only, so the C entry point is called here. Settings: nested dissection (METIS),
no iterative refinement, weighted matching and scaling for unsymmetric matrices, as the manual recommends.
"""
import ctypes
import numpy as np
import scipy.sparse as sp
import pypardiso

KINDS = {("definite", False): 2, ("symmetric", False): -2, ("symmetric", True): 6,
         ("general", False): 11, ("general", True): 13}


class Pardiso:
    """A factorised; `solve(b)` gives A⁻¹b for one column."""

    def __init__(self, matrix, kind):
        is_complex = np.iscomplexobj(matrix)
        self.kind = KINDS[kind, is_complex]
        stored = matrix if kind == "general" else sp.triu(matrix)
        stored = sp.csr_matrix(stored)
        stored.sort_indices()
        self.dtype = np.dtype(complex if is_complex else float)
        self.order = matrix.shape[0]
        self.values = np.ascontiguousarray(stored.data, self.dtype)
        self.starts = stored.indptr.astype(np.int32)
        self.columns = stored.indices.astype(np.int32)
        self.call = pypardiso.PyPardisoSolver().libmkl.pardiso
        self.call.argtypes = None
        self.handle = np.zeros(64, np.int64)
        self.settings = np.zeros(64, np.int32)
        for index, value in {1: 1, 2: 2, 35: 1}.items():   # counted from 1, as in the manual
            self.settings[index - 1] = value
        general = kind == "general"
        self.settings[9] = 13 if general else 8
        self.settings[10] = self.settings[12] = int(general)
        self._phase(12)

    def _phase(self, phase, rhs=None, solution=None):
        pointer = lambda array: array.ctypes.data_as(ctypes.c_void_p)
        whole = lambda number: ctypes.byref(ctypes.c_int32(number))
        nothing, error = np.zeros(1, self.dtype), ctypes.c_int32(0)
        permutation = np.zeros(1, np.int32)
        self.call(pointer(self.handle), whole(1), whole(1), whole(self.kind), whole(phase), whole(self.order),
                  pointer(self.values), pointer(self.starts), pointer(self.columns), pointer(permutation), whole(1),
                  pointer(self.settings), whole(0), pointer(nothing if rhs is None else rhs),
                  pointer(nothing if solution is None else solution), ctypes.byref(error))
        if error.value:
            raise RuntimeError(f"PARDISO, phase {phase}: error {error.value}")

    def solve(self, rhs):
        rhs = np.ascontiguousarray(rhs, self.dtype)
        solution = np.empty_like(rhs)
        self._phase(33, rhs, solution)
        return solution

    def close(self):
        self._phase(-1)

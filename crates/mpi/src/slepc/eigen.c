#include "shim.h"

/* The same outcome on all ranks, where one of them may have failed on its own before it comes to a collective call. */
static int agreed(int code) {
    int worst = code, failed = (int)MPI_Allreduce(&code, &worst, 1, MPI_INT, MPI_MAX, PETSC_COMM_WORLD);
    if (failed) return failed;
    if (worst && !code) snprintf(stridor_text, sizeof stridor_text, "another rank failed: its memory or its indices do not suffice");
    return worst;
}

/* ---- PETSc: matrices whose rows are shared out ---- */

/* The n x n matrix of which this rank has the next `own` rows, compressed; `parts` is 2 for complex values, 1 for real ones. */
int stridor_matrix_new(int64_t n, int64_t own, const int64_t *starts, const int64_t *columns, const double *values, int parts,
                       Mat *matrix) {
    int64_t entries = starts[own];
    PetscInt *i = malloc((own + 1) * sizeof *i), *j = malloc((entries + 1) * sizeof *j);
    PetscScalar *v = malloc((entries + 1) * sizeof *v);
    int code = 0;
    if (n > PETSC_MAX_INT || entries > PETSC_MAX_INT) {
        snprintf(stridor_text, sizeof stridor_text,
                 "a part of %lld rows and %lld entries needs 64-bit indices: build PETSc with --with-64-bit-indices, or take more ranks",
                 (long long)own, (long long)entries);
        code = 1;
    } else if (!i || !j || !v) {
        snprintf(stridor_text, sizeof stridor_text, "memory does not suffice for the rows of a matrix");
        code = 1;
    }
    code = agreed(code);
    if (!code) {
        for (int64_t k = 0; k <= own; k++) i[k] = (PetscInt)starts[k];
        for (int64_t k = 0; k < entries; k++) {
            j[k] = (PetscInt)columns[k];
            v[k] = parts == 2 ? values[2 * k] + values[2 * k + 1] * PETSC_i : values[k];
        }
        code = (int)MatCreateMPIAIJWithArrays(PETSC_COMM_WORLD, (PetscInt)own, (PetscInt)own, (PetscInt)n, (PetscInt)n, i, j, v,
                                              matrix);
    }
    free(i);
    free(j);
    free(v);
    return code;
}

void stridor_matrix_free(Mat matrix) { MatDestroy(&matrix); }

/* ---- SLEPc: Krylov-Schur on K x = theta M x, with the factors of K - shift M ---- */

struct inverse {
    struct factor *factor;
    Vec whole;          /* a vector on rank 0 */
    VecScatter to_first;
    const int *order;   /* on rank 0: the row of the factors that is row k of the matrices */
    double *columns;    /* on rank 0: real and imaginary part of a right-hand side */
};

static PetscErrorCode scatter(VecScatter way, Vec from, Vec to, ScatterMode mode) {
    PetscCall(VecScatterBegin(way, from, to, INSERT_VALUES, mode));
    return VecScatterEnd(way, from, to, INSERT_VALUES, mode);
}

/* y = (K - shift M)^-1 x. Vectors that start real stay real: then one right-hand side is solved for. */
static PetscErrorCode apply_inverse(PC pc, Vec x, Vec y) {
    struct inverse *inverse;
    PetscScalar *whole;
    PetscInt n;
    int parts = 1;
    PetscCall(PCShellGetContext(pc, &inverse));
    PetscCall(scatter(inverse->to_first, x, inverse->whole, SCATTER_FORWARD));
    PetscCall(VecGetLocalSize(inverse->whole, &n));
    PetscCall(VecGetArray(inverse->whole, &whole));
    for (PetscInt k = 0; k < n; k++) {
        inverse->columns[inverse->order[k]] = PetscRealPart(whole[k]);
        inverse->columns[n + inverse->order[k]] = PetscImaginaryPart(whole[k]);
        if (PetscImaginaryPart(whole[k]) != 0) parts = 2;
    }
    PetscCallMPI(MPI_Bcast(&parts, 1, MPI_INT, 0, PETSC_COMM_WORLD));
    int status = stridor_mumps_solve(inverse->factor, inverse->columns, parts, (int)n);
    PetscCheck(status >= 0, PETSC_COMM_WORLD, PETSC_ERR_LIB, "solution by MUMPS, INFOG(1) = %d", status);
    for (PetscInt k = 0; k < n; k++) {
        int row = inverse->order[k];
        whole[k] = inverse->columns[row] + (parts == 2 ? inverse->columns[n + row] * PETSC_i : 0);
    }
    PetscCall(VecRestoreArray(inverse->whole, &whole));
    return scatter(inverse->to_first, inverse->whole, y, SCATTER_REVERSE);
}

/* A start that is the same in every run, whatever the number of ranks. */
static PetscErrorCode start(struct inverse *inverse, Vec x) {
    PetscScalar *whole;
    PetscInt n;
    PetscCall(VecGetLocalSize(inverse->whole, &n));
    PetscCall(VecGetArray(inverse->whole, &whole));
    for (PetscInt i = 0; i < n; i++) {
        double place = (inverse->order[i] + 1.0) * 0.6180339887498949;
        whole[i] = place - floor(place) - 0.5;
    }
    PetscCall(VecRestoreArray(inverse->whole, &whole));
    return scatter(inverse->to_first, inverse->whole, x, SCATTER_REVERSE);
}

static PetscErrorCode krylov_schur(struct inverse *inverse, Mat k, Mat m, double shift, int count, double tolerance, int *found,
                                   double *values, double *vectors) {
    EPS eps;
    ST st;
    KSP ksp;
    PC pc;
    Vec x;
    PetscInt converged, n;
    PetscCall(MatCreateVecs(k, &x, NULL));
    PetscCall(VecScatterCreateToZero(x, &inverse->to_first, &inverse->whole));
    PetscCall(VecGetLocalSize(inverse->whole, &n));
    PetscCall(EPSCreate(PETSC_COMM_WORLD, &eps));
    PetscCall(EPSSetOperators(eps, k, m));
    PetscCall(EPSSetProblemType(eps, EPS_GHEP));
    PetscCall(EPSSetType(eps, EPSKRYLOVSCHUR));
    PetscCall(EPSSetDimensions(eps, count, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(EPSSetTarget(eps, shift));
    PetscCall(EPSSetWhichEigenpairs(eps, EPS_TARGET_MAGNITUDE));
    PetscCall(EPSSetTolerances(eps, tolerance, 1000));
    PetscCall(EPSGetST(eps, &st));
    PetscCall(STSetType(st, STSINVERT));
    PetscCall(STSetMatMode(st, ST_MATMODE_SHELL)); /* K - shift M is factorised already */
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(KSPSetType(ksp, KSPPREONLY));
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCSetType(pc, PCSHELL));
    PetscCall(PCShellSetContext(pc, inverse));
    PetscCall(PCShellSetApply(pc, apply_inverse));
    PetscCall(start(inverse, x));
    PetscCall(EPSSetInitialSpace(eps, 1, &x));
    PetscCall(EPSSetFromOptions(eps));
    PetscCall(EPSSolve(eps));
    PetscCall(EPSGetConverged(eps, &converged));
    *found = converged < count ? (int)converged : count;
    for (int pair = 0; pair < *found; pair++) {
        PetscScalar theta;
        const PetscScalar *whole;
        PetscCall(EPSGetEigenpair(eps, pair, &theta, NULL, x, NULL));
        values[pair] = PetscRealPart(theta);
        PetscCall(scatter(inverse->to_first, x, inverse->whole, SCATTER_FORWARD));
        PetscCall(VecGetArrayRead(inverse->whole, &whole));
        for (PetscInt i = 0; i < n; i++) vectors[(int64_t)pair * n + inverse->order[i]] = PetscRealPart(whole[i]);
        PetscCall(VecRestoreArrayRead(inverse->whole, &whole));
    }
    PetscCall(EPSDestroy(&eps));
    PetscCall(VecDestroy(&x));
    PetscCall(VecDestroy(&inverse->whole));
    return VecScatterDestroy(&inverse->to_first);
}

/* The `count` eigenvalues nearest the shift, nearest first, `found` of them converged; on rank 0 their vectors (n numbers each,
 * x'Mx = 1) and `order`, the row of the factors that is row k of the matrices. */
int stridor_krylov_schur(Mat k, Mat m, struct factor *factor, const int *order, double shift, int count, double tolerance,
                         int *found, double *values, double *vectors) {
    struct inverse inverse = {.factor = factor, .order = order};
    PetscInt n = 0;
    int rank, code;
    if ((code = MPI_Comm_rank(PETSC_COMM_WORLD, &rank))) return code;
    if (rank == 0 && (code = (int)MatGetSize(m, &n, NULL))) return code;
    inverse.columns = malloc((2 * (size_t)n + 1) * sizeof *inverse.columns);
    if ((code = agreed(inverse.columns ? 0 : 1))) return code;
    code = (int)krylov_schur(&inverse, k, m, shift, count, tolerance, found, values, vectors);
    free(inverse.columns);
    return code;
}

/* ---- SLEPc: TOAR on (lambda^2 M + lambda (C + B diag(c) B') + K) x = 0 ---- */

struct shifted {
    KSP sparse;          /* P = K + s C + s^2 M */
    PetscInt rank;       /* columns of B */
    Mat basis, response; /* B and P^-1 B */
    Mat small;           /* diag(1/(s c)) + B' P^-1 B, factorised, on every rank */
    Vec coordinates, force, all;
    VecScatter to_all;
};

/* y = (P + s B diag(c) B')^-1 x by Sherman, Morrison and Woodbury. */
static PetscErrorCode apply_shifted(PC pc, Vec x, Vec y) {
    struct shifted *shifted;
    PetscCall(PCShellGetContext(pc, &shifted));
    PetscCall(KSPSolve(shifted->sparse, x, y));
    if (shifted->rank == 0) return 0;
    PetscCall(MatMultTranspose(shifted->basis, y, shifted->coordinates));
    PetscCall(scatter(shifted->to_all, shifted->coordinates, shifted->all, SCATTER_FORWARD));
    PetscCall(MatSolve(shifted->small, shifted->all, shifted->force));
    /* Every rank has all of the force: it keeps its own part. */
    PetscInt first, last;
    const PetscScalar *force;
    PetscScalar *own;
    PetscCall(VecGetOwnershipRange(shifted->coordinates, &first, &last));
    PetscCall(VecGetArrayRead(shifted->force, &force));
    PetscCall(VecGetArray(shifted->coordinates, &own));
    for (PetscInt i = first; i < last; i++) own[i - first] = -force[i];
    PetscCall(VecRestoreArray(shifted->coordinates, &own));
    PetscCall(VecRestoreArrayRead(shifted->force, &force));
    return MatMultAdd(shifted->response, shifted->coordinates, y, y);
}

static PetscErrorCode factorize_shifted(struct shifted *shifted, Mat k, Mat c, Mat m, const double *coefficients,
                                        PetscScalar shift) {
    Mat p;
    PC pc;
    PetscCall(MatDuplicate(k, MAT_COPY_VALUES, &p));
    PetscCall(MatAXPY(p, shift, c, DIFFERENT_NONZERO_PATTERN));
    PetscCall(MatAXPY(p, shift * shift, m, DIFFERENT_NONZERO_PATTERN));
    PetscCall(KSPCreate(PETSC_COMM_WORLD, &shifted->sparse));
    PetscCall(KSPSetOperators(shifted->sparse, p, p));
    PetscCall(KSPSetType(shifted->sparse, KSPPREONLY));
    PetscCall(KSPGetPC(shifted->sparse, &pc));
    PetscCall(PCSetType(pc, PCLU));
    PetscCall(PCFactorSetMatSolverType(pc, MATSOLVERMUMPS));
    PetscCall(KSPSetErrorIfNotConverged(shifted->sparse, PETSC_TRUE));
    PetscCall(KSPSetUp(shifted->sparse));
    PetscCall(MatDestroy(&p));
    if (shifted->rank == 0) return 0;
    PetscCall(MatCreateVecs(shifted->basis, &shifted->coordinates, NULL));
    PetscCall(VecScatterCreateToAll(shifted->coordinates, &shifted->to_all, &shifted->all));
    PetscCall(VecDuplicate(shifted->all, &shifted->force));
    PetscCall(MatDuplicate(shifted->basis, MAT_DO_NOT_COPY_VALUES, &shifted->response));
    PetscCall(MatCreateSeqDense(PETSC_COMM_SELF, shifted->rank, shifted->rank, NULL, &shifted->small));
    for (PetscInt j = 0; j < shifted->rank; j++) {
        Vec b, y;
        const PetscScalar *column;
        PetscCall(MatDenseGetColumnVecRead(shifted->basis, j, &b));
        PetscCall(MatDenseGetColumnVecWrite(shifted->response, j, &y));
        PetscCall(KSPSolve(shifted->sparse, b, y));
        PetscCall(MatDenseRestoreColumnVecRead(shifted->basis, j, &b));
        PetscCall(MatMultTranspose(shifted->basis, y, shifted->coordinates));
        PetscCall(MatDenseRestoreColumnVecWrite(shifted->response, j, &y));
        PetscCall(scatter(shifted->to_all, shifted->coordinates, shifted->all, SCATTER_FORWARD));
        PetscCall(VecGetArrayRead(shifted->all, &column));
        for (PetscInt i = 0; i < shifted->rank; i++) {
            PetscScalar own = i == j ? 1.0 / (shift * coefficients[i]) : 0.0;
            PetscCall(MatSetValue(shifted->small, i, j, column[i] + own, INSERT_VALUES));
        }
        PetscCall(VecRestoreArrayRead(shifted->all, &column));
    }
    PetscCall(MatAssemblyBegin(shifted->small, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(shifted->small, MAT_FINAL_ASSEMBLY));
    return MatLUFactor(shifted->small, NULL, NULL, NULL);
}

static PetscErrorCode toar(struct shifted *shifted, Mat k, Mat c, Mat m, const double *coefficients, PetscScalar shift, int count,
                           double tolerance, int *found, double *values) {
    Mat damping = c, operators[3];
    Vec weights = NULL;
    PEP pep;
    ST st;
    KSP ksp;
    PC pc;
    PetscInt converged;
    PetscCall(factorize_shifted(shifted, k, c, m, coefficients, shift));
    if (shifted->rank > 0) {
        PetscScalar *own;
        PetscCall(VecDuplicate(shifted->all, &weights));
        PetscCall(VecGetArray(weights, &own));
        for (PetscInt i = 0; i < shifted->rank; i++) own[i] = coefficients[i];
        PetscCall(VecRestoreArray(weights, &own));
        PetscCall(MatCreateLRC(c, shifted->basis, weights, NULL, &damping));
    }
    operators[0] = k;
    operators[1] = damping;
    operators[2] = m;
    PetscCall(PEPCreate(PETSC_COMM_WORLD, &pep));
    PetscCall(PEPSetOperators(pep, 3, operators));
    PetscCall(PEPSetType(pep, PEPTOAR));
    PetscCall(PEPSetDimensions(pep, count, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(PEPSetTarget(pep, shift));
    PetscCall(PEPSetWhichEigenpairs(pep, PEP_TARGET_MAGNITUDE));
    PetscCall(PEPSetTolerances(pep, tolerance, 1000));
    /* By the size of the eigenvalues, not by the norms of the matrices, which belong to those far above. */
    PetscCall(PEPSetScale(pep, PEP_SCALE_SCALAR, PetscAbsScalar(shift), NULL, NULL, PETSC_DEFAULT, PETSC_DEFAULT));
    PetscCall(PEPGetST(pep, &st));
    PetscCall(STSetType(st, STSINVERT));
    PetscCall(STSetMatMode(st, ST_MATMODE_SHELL));
    PetscCall(STSetTransform(st, PETSC_FALSE));
    PetscCall(STGetKSP(st, &ksp));
    PetscCall(KSPSetType(ksp, KSPPREONLY));
    PetscCall(KSPGetPC(ksp, &pc));
    PetscCall(PCSetType(pc, PCSHELL));
    PetscCall(PCShellSetContext(pc, shifted));
    PetscCall(PCShellSetApply(pc, apply_shifted));
    PetscCall(PEPSetFromOptions(pep));
    PetscCall(PEPSolve(pep));
    PetscCall(PEPGetConverged(pep, &converged));
    *found = converged < count ? (int)converged : count;
    for (int pair = 0; pair < *found; pair++) {
        PetscScalar lambda;
        PetscCall(PEPGetEigenpair(pep, pair, &lambda, NULL, NULL, NULL));
        values[2 * pair] = PetscRealPart(lambda);
        values[2 * pair + 1] = PetscImaginaryPart(lambda);
    }
    PetscCall(PEPDestroy(&pep));
    if (shifted->rank > 0) {
        PetscCall(MatDestroy(&damping));
        PetscCall(VecDestroy(&weights));
        PetscCall(MatDestroy(&shifted->response));
        PetscCall(MatDestroy(&shifted->small));
        PetscCall(VecDestroy(&shifted->coordinates));
        PetscCall(VecDestroy(&shifted->force));
        PetscCall(VecDestroy(&shifted->all));
        PetscCall(VecScatterDestroy(&shifted->to_all));
    }
    return KSPDestroy(&shifted->sparse);
}

/* The `count` eigenvalues nearest the shift, nearest first, `found` of them converged. B has `rank` columns, of which this rank
 * has its own rows, column after column, and their coefficients c. */
int stridor_toar(Mat k, Mat c, Mat m, const double *basis, const double *coefficients, int rank, double shift_re, double shift_im,
                 int count, double tolerance, int *found, double *values) {
    struct shifted shifted = {.rank = rank};
    PetscInt n, own;
    int code;
    if ((code = (int)MatGetSize(m, &n, NULL)) || (code = (int)MatGetLocalSize(m, &own, NULL))) return code;
    if (rank > 0) {
        PetscScalar *columns;
        if ((code = (int)MatCreateDense(PETSC_COMM_WORLD, own, PETSC_DECIDE, n, rank, NULL, &shifted.basis))) return code;
        if ((code = (int)MatDenseGetArrayWrite(shifted.basis, &columns))) return code;
        for (int64_t i = 0; i < (int64_t)own * rank; i++) columns[i] = basis[i];
        if ((code = (int)MatDenseRestoreArrayWrite(shifted.basis, &columns))) return code;
        MatAssemblyBegin(shifted.basis, MAT_FINAL_ASSEMBLY);
        MatAssemblyEnd(shifted.basis, MAT_FINAL_ASSEMBLY);
    }
    code = (int)toar(&shifted, k, c, m, coefficients, shift_re + shift_im * PETSC_i, count, tolerance, found, values);
    if (rank > 0) MatDestroy(&shifted.basis);
    return code;
}

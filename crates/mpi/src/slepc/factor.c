#include "shim.h"
#include <dmumps_c.h>

/* ---- MUMPS: real symmetric matrices, with their inertia ---- */

#define ICNTL(k) icntl[(k) - 1]

_Static_assert(sizeof(MUMPS_INT) == sizeof(int), "MUMPS with 32-bit integers (-DINTSIZE32) is needed: its matrices are numbered by them");

/* Working memory beyond what the analysis expects, in percent, and what is tried where it does not suffice. */
static const int SPARE[] = {30, 100, 400};

struct factor {
    DMUMPS_STRUC_C mumps;
};

/* L B L' of the n x n matrix whose entries of one triangle lie on all ranks: irn and jcn from 1; `place`, on rank 0, is the place of
 * every row in the order of elimination, from 1. The arrays are read during the call alone. `kept` is 0 for the inertia alone. The
 * status is INFOG(1). */
struct factor *stridor_mumps_new(int n, int64_t entries, int *irn, int *jcn, double *values, int *place, int kept, int *status) {
    struct factor *factor = calloc(1, sizeof *factor);
    if (!factor) return NULL;
    DMUMPS_STRUC_C *mumps = &factor->mumps;
    mumps->comm_fortran = (MUMPS_INT)MPI_Comm_c2f(MPI_COMM_WORLD);
    mumps->sym = 2;
    mumps->par = 1;
    mumps->job = -1;
    dmumps_c(mumps);
    for (int k = 1; k <= 4; k++) mumps->ICNTL(k) = 0; /* prints nothing */
    mumps->ICNTL(7) = 1;                              /* the order is given */
    mumps->ICNTL(12) = 1;
    mumps->ICNTL(13) = 1; /* no ScaLAPACK at the root, which would hide its inertia */
    mumps->ICNTL(18) = 3; /* entries on all ranks */
    mumps->ICNTL(24) = 1; /* counts pivots that are zero to rounding */
    mumps->ICNTL(28) = 1;
    mumps->ICNTL(31) = !kept;
    mumps->n = n;
    mumps->nnz_loc = entries;
    mumps->irn_loc = irn;
    mumps->jcn_loc = jcn;
    mumps->a_loc = values;
    mumps->perm_in = place;
    for (size_t attempt = 0; attempt < sizeof SPARE / sizeof *SPARE; attempt++) {
        mumps->ICNTL(14) = SPARE[attempt];
        mumps->job = attempt == 0 ? 4 : 2;
        dmumps_c(mumps);
        *status = mumps->infog[0];
        if (*status != -8 && *status != -9) break; /* workspace too small */
    }
    mumps->irn_loc = mumps->jcn_loc = mumps->perm_in = NULL;
    mumps->a_loc = NULL;
    return factor;
}

int stridor_mumps_solve(struct factor *factor, double *columns, int count, int stride) {
    DMUMPS_STRUC_C *mumps = &factor->mumps;
    mumps->rhs = columns;
    mumps->nrhs = count;
    mumps->lrhs = stride;
    mumps->job = 3;
    dmumps_c(mumps);
    mumps->rhs = NULL;
    return mumps->infog[0];
}

int stridor_mumps_infog(const struct factor *factor, int k) { return factor->mumps.infog[k - 1]; }

void stridor_mumps_free(struct factor *factor) {
    factor->mumps.job = -2;
    dmumps_c(&factor->mumps);
    free(factor);
}

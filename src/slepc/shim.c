/* The C side of this module: what only the headers of the machine know. Types of MPI, indices and scalars of PETSc, values of
 * SLEPc's enumerators and the layout of MUMPS's structure differ from version to version; here the compiler checks them.
 * Every function that returns an int gives 0, or an error whose text stridor_error_text has. */

#include <slepceps.h>
#include <slepcpep.h>
#include <dmumps_c.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#if !defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
#error "stridor needs PETSc and SLEPc with complex scalars in double precision (Debian: libslepc-complex-dev)"
#endif

/* ---- errors ---- */

static char error_text[1024];

const char *stridor_error_text(void) { return error_text; }

/* Keeps the message of the place where an error is first seen; PETSc calls the handler once more for every function above it. */
static PetscErrorCode keep_text(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                PetscErrorType kind, const char *message, void *context) {
    (void)comm; (void)line; (void)file; (void)context;
    if (kind == PETSC_ERROR_INITIAL) {
        const char *general = NULL;
        PetscErrorMessage(code, &general, NULL);
        snprintf(error_text, sizeof error_text, "%s: %s%s%s", function ? function : "PETSc", general ? general : "error",
                 message && *message ? ": " : "", message ? message : "");
    }
    return code;
}

static int mpi_error(int code) {
    if (code != MPI_SUCCESS) {
        int length = 0;
        MPI_Error_string(code, error_text, &length);
        error_text[length < (int)sizeof error_text ? length : (int)sizeof error_text - 1] = 0;
    }
    return code;
}

/* ---- MPI ---- */

int stridor_start(int *rank, int *size) {
    static char program[] = "stridor", no_handler[] = "-no_signal_handler";
    char *arguments[] = {program, no_handler, NULL}, **argv = arguments;
    int argc = 2, provided = 0, code;
    if ((code = MPI_Init_thread(NULL, NULL, MPI_THREAD_SERIALIZED, &provided))) return code;
    if (provided < MPI_THREAD_SERIALIZED) {
        snprintf(error_text, sizeof error_text, "this MPI library does not allow calls from several threads");
        return 1;
    }
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    if ((code = mpi_error(MPI_Comm_rank(MPI_COMM_WORLD, rank)))) return code;
    if ((code = mpi_error(MPI_Comm_size(MPI_COMM_WORLD, size)))) return code;
    if ((code = (int)SlepcInitialize(&argc, &argv, NULL, NULL))) return code;
    return (int)PetscPushErrorHandler(keep_text, NULL);
}

void stridor_stop(void) {
    SlepcFinalize();
    MPI_Finalize();
}

void stridor_abort(int code) { MPI_Abort(MPI_COMM_WORLD, code); }

/* Counts of MPI are ints. */
#define PIECE ((int64_t)1 << 30)

int stridor_broadcast(char *bytes, int64_t count) {
    for (int64_t at = 0; at < count; at += PIECE) {
        int64_t length = count - at < PIECE ? count - at : PIECE;
        int code = mpi_error(MPI_Bcast(bytes + at, (int)length, MPI_BYTE, 0, MPI_COMM_WORLD));
        if (code) return code;
    }
    return 0;
}

/* The same for ranks that may wait for long: they sleep, up to a fifth of a millisecond at a time. */
int stridor_announce(char *bytes, int64_t count) {
    struct timespec pause = {0, 1000};
    MPI_Request request;
    int arrived = 0, code = mpi_error(MPI_Ibcast(bytes, (int)count, MPI_BYTE, 0, MPI_COMM_WORLD, &request));
    while (!code && !arrived) {
        code = mpi_error(MPI_Test(&request, &arrived, MPI_STATUS_IGNORE));
        if (!arrived) nanosleep(&pause, NULL);
        if (pause.tv_nsec < 200000) pause.tv_nsec += pause.tv_nsec / 8;
    }
    return code;
}

int stridor_send(const char *bytes, int64_t count, int to) {
    for (int64_t at = 0; at < count; at += PIECE) {
        int64_t length = count - at < PIECE ? count - at : PIECE;
        int code = mpi_error(MPI_Send(bytes + at, (int)length, MPI_BYTE, to, 0, MPI_COMM_WORLD));
        if (code) return code;
    }
    return 0;
}

int stridor_receive(char *bytes, int64_t count, int from) {
    for (int64_t at = 0; at < count; at += PIECE) {
        int64_t length = count - at < PIECE ? count - at : PIECE;
        int code = mpi_error(MPI_Recv(bytes + at, (int)length, MPI_BYTE, from, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE));
        if (code) return code;
    }
    return 0;
}

/* ---- MUMPS: real symmetric matrices, with their inertia ---- */

#define ICNTL(k) icntl[(k) - 1]

/* Working memory beyond what the analysis expects, in percent, and what is tried where it does not suffice. */
static const int SPARE[] = {30, 100, 400};

struct factor {
    DMUMPS_STRUC_C mumps;
};

/* L B L' of the n x n matrix whose entries of one triangle lie on all ranks; irn and jcn, from 1, and the order of elimination,
 * place of every row from 1 (on rank 0), stay in use as long as the factor. `kept` is 0 for the inertia alone. The status is INFOG(1). */
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
    mumps->a_loc = NULL;
    return factor;
}

/* The `columns` right-hand sides on rank 0, `stride` numbers apart, become solutions. */
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

double stridor_mumps_rinfog(const struct factor *factor, int k) { return factor->mumps.rinfog[k - 1]; }

void stridor_mumps_free(struct factor *factor) {
    factor->mumps.job = -2;
    dmumps_c(&factor->mumps);
    free(factor);
}

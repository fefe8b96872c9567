#include "shim.h"
#include <time.h>

/* ---- errors ---- */

char stridor_text[1024];

const char *stridor_error_text(void) { return stridor_text; }

/* Keeps the message of the place where an error is first seen; PETSc calls the handler once more for every function above it. */
static PetscErrorCode keep_text(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                PetscErrorType kind, const char *message, void *context) {
    (void)comm; (void)line; (void)file; (void)context;
    if (kind == PETSC_ERROR_INITIAL) {
        const char *general = NULL;
        PetscErrorMessage(code, &general, NULL);
        snprintf(stridor_text, sizeof stridor_text, "%s: %s%s%s", function ? function : "PETSc", general ? general : "error",
                 message && *message ? ": " : "", message ? message : "");
    }
    return code;
}

static int mpi_error(int code) {
    if (code != MPI_SUCCESS) {
        int length = 0;
        MPI_Error_string(code, stridor_text, &length);
        stridor_text[length < (int)sizeof stridor_text ? length : (int)sizeof stridor_text - 1] = 0;
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
        snprintf(stridor_text, sizeof stridor_text, "this MPI library does not allow calls from several threads");
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

/* The rank whose message comes next; -1 where there is none. */
int stridor_waiting(int *from) {
    MPI_Status status;
    int there = 0, code = mpi_error(MPI_Iprobe(MPI_ANY_SOURCE, 0, MPI_COMM_WORLD, &there, &status));
    *from = !code && there ? status.MPI_SOURCE : -1;
    return code;
}

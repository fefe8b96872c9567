/* Counts the messages of each rank of an MPI program, by the profiling interface of MPI, and what MUMPS is asked for:
 *
 *     mpirun -n 2 env LD_PRELOAD=./libmessages.so PROGRAM
 *
 * MPI_Pcontrol(k) ends phase k; MPI_Finalize ends the last one, 0. Each rank then writes a line to stderr:
 *
 *     messages PHASE RANK SENT BYTES COLLECTIVE BYTES FACTORISATIONS RIGHT_HAND_SIDES PEAK_MIB
 *
 * SENT are messages from one rank to another; bytes of a collective are those of the rank's own buffer. The names that
 * Fortran calls are there as well, because MUMPS is written in it. */

#define _GNU_SOURCE
#include <dlfcn.h>
#include <dmumps_c.h>
#include <mpi.h>
#include <stdio.h>
#include <sys/resource.h>

static double sent, sent_bytes, shared, shared_bytes;
static long factorisations, right_hand_sides;

static double bytes_of(int count, MPI_Datatype type) {
    int size = 0;
    PMPI_Type_size(type, &size);
    return (double)count * size;
}

static void count_sent(int count, MPI_Datatype type) {
    sent += 1;
    sent_bytes += bytes_of(count, type);
}

static void count_shared(int count, MPI_Datatype type) {
    shared += 1;
    shared_bytes += bytes_of(count, type);
}

static void write_phase(int phase) {
    int rank = 0;
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
    fprintf(stderr, "messages %d %d %.0f %.0f %.0f %.0f %ld %ld %ld\n", phase, rank, sent, sent_bytes, shared, shared_bytes,
            factorisations, right_hand_sides, use.ru_maxrss / 1024);
    sent = sent_bytes = shared = shared_bytes = 0;
    factorisations = right_hand_sides = 0;
}

int MPI_Pcontrol(const int phase, ...) {
    write_phase(phase);
    return MPI_SUCCESS;
}

int MPI_Finalize(void) {
    write_phase(0);
    return PMPI_Finalize();
}

/* ---- MUMPS ---- */

void dmumps_c(DMUMPS_STRUC_C *mumps) {
    void (*original)(DMUMPS_STRUC_C *) = (void (*)(DMUMPS_STRUC_C *))dlsym(RTLD_NEXT, "dmumps_c");
    int job = mumps->job;
    factorisations += job == 2 || job == 4;
    right_hand_sides += job == 3 ? mumps->nrhs : 0;
    original(mumps);
}

/* ---- C ---- */

int MPI_Send(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c) {
    count_sent(n, t);
    return PMPI_Send(b, n, t, to, tag, c);
}
int MPI_Isend(const void *b, int n, MPI_Datatype t, int to, int tag, MPI_Comm c, MPI_Request *r) {
    count_sent(n, t);
    return PMPI_Isend(b, n, t, to, tag, c, r);
}
int MPI_Bcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c) {
    count_shared(n, t);
    return PMPI_Bcast(b, n, t, root, c);
}
int MPI_Ibcast(void *b, int n, MPI_Datatype t, int root, MPI_Comm c, MPI_Request *r) {
    count_shared(n, t);
    return PMPI_Ibcast(b, n, t, root, c, r);
}
int MPI_Reduce(const void *s, void *b, int n, MPI_Datatype t, MPI_Op o, int root, MPI_Comm c) {
    count_shared(n, t);
    return PMPI_Reduce(s, b, n, t, o, root, c);
}
int MPI_Allreduce(const void *s, void *b, int n, MPI_Datatype t, MPI_Op o, MPI_Comm c) {
    count_shared(n, t);
    return PMPI_Allreduce(s, b, n, t, o, c);
}

/* ---- Fortran: every argument is an address ---- */

typedef MPI_Fint F;
#define TYPE(t) MPI_Type_f2c(*(t))

void pmpi_send_(void *, F *, F *, F *, F *, F *, F *);
void mpi_send_(void *b, F *n, F *t, F *to, F *tag, F *c, F *e) {
    count_sent(*n, TYPE(t));
    pmpi_send_(b, n, t, to, tag, c, e);
}
void pmpi_ssend_(void *, F *, F *, F *, F *, F *, F *);
void mpi_ssend_(void *b, F *n, F *t, F *to, F *tag, F *c, F *e) {
    count_sent(*n, TYPE(t));
    pmpi_ssend_(b, n, t, to, tag, c, e);
}
void pmpi_isend_(void *, F *, F *, F *, F *, F *, F *, F *);
void mpi_isend_(void *b, F *n, F *t, F *to, F *tag, F *c, F *r, F *e) {
    count_sent(*n, TYPE(t));
    pmpi_isend_(b, n, t, to, tag, c, r, e);
}
void pmpi_bcast_(void *, F *, F *, F *, F *, F *);
void mpi_bcast_(void *b, F *n, F *t, F *root, F *c, F *e) {
    count_shared(*n, TYPE(t));
    pmpi_bcast_(b, n, t, root, c, e);
}
void pmpi_reduce_(void *, void *, F *, F *, F *, F *, F *, F *);
void mpi_reduce_(void *s, void *b, F *n, F *t, F *o, F *root, F *c, F *e) {
    count_shared(*n, TYPE(t));
    pmpi_reduce_(s, b, n, t, o, root, c, e);
}
void pmpi_allreduce_(void *, void *, F *, F *, F *, F *, F *);
void mpi_allreduce_(void *s, void *b, F *n, F *t, F *o, F *c, F *e) {
    count_shared(*n, TYPE(t));
    pmpi_allreduce_(s, b, n, t, o, c, e);
}

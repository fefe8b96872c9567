/* Factorises K - s M of a block of 8-node bricks by MUMPS with the settings of the distributed engine (crates/mpi), and
 * writes what it took as one line of JSON:
 *
 *     mpirun -n P factor NX NY NZ RING WHAT
 *
 * NX, NY, NZ are nodes along the edges; with RING = 1 the block is closed along x to a ring, as a disc is. K is that of unit
 * cubes with E = 1 and Poisson's ratio 0.3 (2 x 2 x 2 Gauss points), M the unit matrix, s = 0.001. WHAT is `analyse` for the
 * analysis alone, or `factorise` for factors and 8 solutions, one after the other
 * as Krylov-Schur asks for them. Rank 0 orders the nodes by METIS. Phases of
 * messages.c: 1 matrix and order, 2 analysis, 3 factorisation, 4 solution. */

#include <dmumps_c.h>
#include <metis.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define ICNTL(k) icntl[(k) - 1]
#define SHIFT 0.001
#define SOLUTIONS 8

static int nx, ny, nz, ring;

/* ---- the brick ---- */

/* K of a unit cube; node a at the corner with the bits of a as x, y, z. */
static double brick[24][24];

static void integrate_brick(void) {
    const double poisson = 0.3, shear = 0.5 / (1 + poisson);
    const double lambda = poisson / ((1 + poisson) * (1 - 2 * poisson));
    const double points[2] = {0.2113248654051871, 0.7886751345948129};
    for (int g = 0; g < 8; g++) {
        double x[3] = {points[g & 1], points[g >> 1 & 1], points[g >> 2]}, gradient[8][3];
        for (int a = 0; a < 8; a++)
            for (int d = 0; d < 3; d++) {
                gradient[a][d] = 1;
                for (int e = 0; e < 3; e++) {
                    int high = a >> e & 1;
                    gradient[a][d] *= e == d ? (high ? 1 : -1) : (high ? x[e] : 1 - x[e]);
                }
            }
        for (int a = 0; a < 8; a++)
            for (int b = 0; b < 8; b++) {
                double *ga = gradient[a], *gb = gradient[b];
                double product = ga[0] * gb[0] + ga[1] * gb[1] + ga[2] * gb[2];
                for (int i = 0; i < 3; i++)
                    for (int j = 0; j < 3; j++)
                        brick[3 * a + i][3 * b + j] +=
                            (lambda * ga[i] * gb[j] + shear * ga[j] * gb[i] + (i == j ? shear * product : 0)) / 8;
            }
    }
}

/* ---- the block ---- */

static long node(int x, int y, int z) { return ((long)((x + nx) % nx) * ny + y) * nz + z; }

/* The node at a distance from another; -1 outside. */
static long neighbour(const int at[3], const int step[3]) {
    int x = at[0] + step[0], y = at[1] + step[1], z = at[2] + step[2];
    int inside = (ring || (x >= 0 && x < nx)) && y >= 0 && y < ny && z >= 0 && z < nz;
    return inside ? node(x, y, z) : -1;
}

/* The 3 x 3 block of K between a node and its neighbour: a sum over the bricks that have both. */
static void block(const int at[3], const int step[3], double sum[3][3]) {
    memset(sum, 0, 9 * sizeof(double));
    const int size[3] = {nx, ny, nz};
    for (int corner = 0; corner < 8; corner++) {
        int other = 0, whole = 1;
        for (int d = 0; d < 3; d++) {
            int own = corner >> d & 1, low = at[d] - own, there = own + step[d];
            whole &= there >= 0 && there <= 1 && ((d == 0 && ring) || (low >= 0 && low + 1 < size[d]));
            other |= (there & 1) << d;
        }
        for (int i = 0; whole && i < 3; i++)
            for (int j = 0; j < 3; j++) sum[i][j] += brick[3 * corner + i][3 * other + j];
    }
}

/* Calls `visit` for each neighbour of each node from `begin` to `end`, and the node itself. */
static void each_pair(long begin, long end, void (*visit)(const int *, const int *, long, long)) {
    for (long a = begin; a < end; a++) {
        int at[3] = {(int)(a / ((long)ny * nz)), (int)(a / nz % ny), (int)(a % nz)};
        for (int k = 0; k < 27; k++) {
            int step[3] = {k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
            long b = neighbour(at, step);
            if (b >= 0) visit(at, step, a, b);
        }
    }
}

/* The lower triangle, and the graph of the nodes. */
static MUMPS_INT *rows, *columns;
static double *values;
static long entries;
static idx_t *near, *starts;

static void add_entries(const int *at, const int *step, long a, long b) {
    double sum[3][3];
    if (b < a) return;
    block(at, step, sum);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            if (a == b && j < i) continue;
            columns[entries] = (MUMPS_INT)(3 * a + i + 1);
            rows[entries] = (MUMPS_INT)(3 * b + j + 1);
            values[entries++] = sum[i][j] - (a == b && i == j ? SHIFT : 0);
        }
}

static void add_neighbour(const int *at, const int *step, long a, long b) {
    (void)at, (void)step;
    if (a == b) return;
    near[starts[a + 1]++] = (idx_t)b;
}

/* The place of every row in an order by nested dissection. */
static MUMPS_INT *dissect(long nodes) {
    idx_t count = (idx_t)nodes, options[METIS_NOPTIONS];
    starts = calloc(nodes + 2, sizeof *starts);
    near = malloc(27 * nodes * sizeof *near);
    idx_t *order = malloc(nodes * sizeof *order), *place = malloc(nodes * sizeof *place);
    for (long a = 0; a < nodes; a++) {
        starts[a + 1] = starts[a];
        each_pair(a, a + 1, add_neighbour);
    }
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    options[METIS_OPTION_COMPRESS] = 0;
    if (METIS_NodeND(&count, starts, near, NULL, options, order, place) != METIS_OK) exit(1);
    MUMPS_INT *rows_at = malloc(3 * nodes * sizeof *rows_at);
    for (long row = 0; row < 3 * nodes; row++) rows_at[row] = (MUMPS_INT)(3 * place[row / 3] + row % 3 + 1);
    free(starts), free(near), free(order), free(place);
    return rows_at;
}

/* ---- the run ---- */

static DMUMPS_STRUC_C mumps;

/* Seconds of this rank's core since the last call. */
static double cpu(void) {
    static clock_t last;
    clock_t now = clock(), since = now - last;
    last = now;
    return (double)since / CLOCKS_PER_SEC;
}

/* Seconds of a job of MUMPS, which ends a phase of messages.c. */
static double run(int job, int phase) {
    MPI_Barrier(MPI_COMM_WORLD);
    cpu();
    double begin = MPI_Wtime();
    mumps.job = job;
    dmumps_c(&mumps);
    if (mumps.infog[0] < 0) {
        fprintf(stderr, "MUMPS: INFOG(1) = %d, INFOG(2) = %d\n", mumps.infog[0], mumps.infog[1]);
        MPI_Abort(MPI_COMM_WORLD, 1);
    }
    MPI_Barrier(MPI_COMM_WORLD);
    double took = MPI_Wtime() - begin;
    MPI_Pcontrol(phase);
    return took;
}

/* A count of MUMPS, which gives millions as negative numbers. */
static double large(int value) { return value < 0 ? -1e6 * value : value; }

static double peak_mib(void) {
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    return use.ru_maxrss / 1024.0;
}

static void set_up(int rank, long nodes) {
    mumps.comm_fortran = (MUMPS_INT)MPI_Comm_c2f(MPI_COMM_WORLD);
    mumps.sym = 2;
    mumps.par = 1;
    mumps.job = -1;
    dmumps_c(&mumps);
    for (int k = 1; k <= 4; k++) mumps.ICNTL(k) = 0;
    mumps.ICNTL(7) = 1;
    mumps.ICNTL(12) = 1;
    mumps.ICNTL(13) = 1;
    mumps.ICNTL(14) = 100; /* the engine begins with 30 and takes more where that does not suffice */
    mumps.ICNTL(18) = 3;
    mumps.ICNTL(24) = 1;
    mumps.ICNTL(28) = 1;
    mumps.n = (MUMPS_INT)(3 * nodes);
    mumps.nnz_loc = entries;
    mumps.irn_loc = rows;
    mumps.jcn_loc = columns;
    mumps.a_loc = values;
    if (rank == 0) mumps.perm_in = dissect(nodes);
}

int main(int argc, char **argv) {
    int rank, ranks;
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (argc != 6) {
        fprintf(stderr, "usage: factor NX NY NZ RING analyse|factorise\n");
        return 2;
    }
    nx = atoi(argv[1]), ny = atoi(argv[2]), nz = atoi(argv[3]), ring = atoi(argv[4]);
    int analysis_alone = !strcmp(argv[5], "analyse");
    long nodes = (long)nx * ny * nz, begin = nodes * rank / ranks, end = nodes * (rank + 1) / ranks;
    integrate_brick();
    rows = malloc(126 * (end - begin) * sizeof *rows);
    columns = malloc(126 * (end - begin) * sizeof *columns);
    values = malloc(126 * (end - begin) * sizeof *values);
    each_pair(begin, end, add_entries);
    set_up(rank, nodes);
    MPI_Pcontrol(1);
    double own = peak_mib(), analysis = run(1, 2), analysed = peak_mib(), factorisation = 0, solution = 0;
    double factorisation_cpu = 0, solution_cpu = 0;
    if (!analysis_alone) {
        factorisation = run(2, 3);
        factorisation_cpu = cpu();
        if (rank == 0) {
            mumps.rhs = malloc(3 * nodes * sizeof *mumps.rhs);
            for (long i = 0; i < 3 * nodes; i++) mumps.rhs[i] = (double)(i % 17) - 8;
        }
        for (int k = 0; k < SOLUTIONS; k++) {
            solution += run(3, 4) / SOLUTIONS;
            solution_cpu += cpu() / SOLUTIONS;
        }
    }
    long all = 0;
    MPI_Reduce(&entries, &all, 1, MPI_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
    if (rank == 0)
        printf("{\"dofs\": %ld, \"ranks\": %d, \"nonzeros\": %ld, \"fill\": %.0f, \"flops\": %.4e, \"front\": %d, "
               "\"negative\": %d, \"analysis\": %.3f, \"factorisation\": %.3f, \"solution\": %.3f, "
               "\"factorisation_cpu\": %.3f, \"solution_cpu\": %.3f, "
               "\"peak_mib_before\": %.0f, \"peak_mib_analysis\": %.0f}\n",
               3 * nodes, ranks, 2 * all - 3 * nodes, large(mumps.infog[analysis_alone ? 19 : 28]),
               mumps.rinfog[analysis_alone ? 0 : 2], mumps.infog[analysis_alone ? 4 : 10], mumps.infog[11], analysis,
               factorisation, solution, factorisation_cpu, solution_cpu, own, analysed);
    mumps.job = -2;
    dmumps_c(&mumps);
    MPI_Finalize();
    return 0;
}

/* The C side of this module: what only the headers of the machine know. Types of MPI, indices and scalars of PETSc, values of
 * SLEPc's enumerators and the layout of MUMPS's structure differ from version to version; here the compiler checks them.
 * Every function that returns an int gives 0, or an error whose text stridor_error_text has. */

#include <slepceps.h>
#include <slepcpep.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#if !defined(PETSC_USE_COMPLEX) || !defined(PETSC_USE_REAL_DOUBLE)
#error "stridor needs PETSc and SLEPc with complex scalars in double precision (Debian: libslepc-complex-dev)"
#endif

/* The text of the last error. */
extern char stridor_text[1024];

/* Factors of MUMPS. */
struct factor;

/* The right-hand sides on rank 0, `count` of them, `stride` numbers apart, become solutions. Gives INFOG(1), negative for an
 * error. */
int stridor_mumps_solve(struct factor *factor, double *columns, int count, int stride);

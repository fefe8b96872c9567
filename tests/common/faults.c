/* Makes calls of a program to the system fail: built as a shared library by tests/processes/faults.rs, loaded by LD_PRELOAD, Linux only.
 *
 *   FAULT_CALLS   which calls are counted, from main() on:
 *                 writes: those that write to, make, rename or delete files below the folder FAULT_BELOW;
 *                 memory: allocations of at least FAULT_LEAST bytes; threads: starts of threads;
 *                 clock: readings of the time of day, none of which fails: they jump by a day back and a year ahead
 *   FAULT_AT      the call that fails, counted from 1; 0: none
 *   FAULT_LASTS   1: all later ones fail, too
 *   FAULT_ERROR   the error number of a failing call
 *   FAULT_REPORT  a file that gets a line with the first failing call and its file, or the library that it comes from;
 *                 with FAULT_AT=0 a line with each call to a file; and at exit the number of calls
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <time.h>
#include <unistd.h>

enum calls { NONE, WRITES, MEMORY, THREADS, CLOCK };

static enum calls counted = NONE;
static long count, at, lasts, least;
static int error = ENOSPC;
static const char *below, *report;
static size_t below_length;

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static void tell(const char *name, const char *what)
{
    if (!report)
        return;
    char line[PATH_MAX + 64];
    int length = snprintf(line, sizeof line, "%s %s\n", name, what);
    int file = syscall(SYS_openat, AT_FDCWD, report, O_WRONLY | O_CREAT | O_APPEND, 0600);
    if (file >= 0) {
        syscall(SYS_write, file, line, length);
        syscall(SYS_close, file);
    }
}

/* The library or program that an address is in. */
static const char *owner(void *address)
{
    Dl_info info;
    return dladdr(address, &info) && info.dli_fname ? info.dli_fname : "";
}

/* Whether this call, of a file or from an address, fails. Not inlined, so that a debugger can stop here. */
__attribute__((noinline)) static int fails(enum calls kind, const char *name, void *what)
{
    if (kind != counted)
        return 0;
    long number = __atomic_add_fetch(&count, 1, __ATOMIC_RELAXED);
    if (number == at || (at == 0 && kind == WRITES))
        tell(name, kind == MEMORY ? owner(what) : what);
    if (at == 0 || number < at || (number > at && !lasts))
        return 0;
    errno = error;
    return 1;
}

static long number_of(const char *name)
{
    const char *text = getenv(name);
    return text ? atol(text) : 0;
}

static int (*real_main)(int, char **, char **);

static int counting_main(int argc, char **argv, char **envp)
{
    const char *words[] = { "", "writes", "memory", "threads", "clock" };
    const char *calls = getenv("FAULT_CALLS");
    at = number_of("FAULT_AT");
    lasts = number_of("FAULT_LASTS");
    least = number_of("FAULT_LEAST");
    if (number_of("FAULT_ERROR"))
        error = number_of("FAULT_ERROR");
    report = getenv("FAULT_REPORT");
    below = getenv("FAULT_BELOW");
    below_length = below ? strlen(below) : 0;
    for (int k = 1; calls && k < 5; k++)
        if (!strcmp(calls, words[k]))
            counted = k;
    return real_main(argc, argv, envp);
}

int __libc_start_main(int (*main)(int, char **, char **), int argc, char **argv, void (*init)(void), void (*fini)(void),
                      void (*rtld_fini)(void), void *stack_end)
{
    int (*next)() = (int (*)())dlsym(RTLD_NEXT, "__libc_start_main");
    real_main = main;
    return next(counting_main, argc, argv, init, fini, rtld_fini, stack_end);
}

__attribute__((destructor)) static void total(void)
{
    char number[32];
    snprintf(number, sizeof number, "%ld", count);
    if (counted != NONE && at == 0)
        tell("calls", number);
}

/* Files */

static int is_below(const char *path)
{
    return below && !strncmp(path, below, below_length) && (path[below_length] == '/' || path[below_length] == 0);
}

static int path_fails(const char *call, const char *path)
{
    char whole[2 * PATH_MAX];
    if (counted != WRITES || !path)
        return 0;
    if (path[0] == '/')
        return is_below(path) && fails(WRITES, call, (void *)path);
    if (syscall(SYS_getcwd, whole, PATH_MAX) < 0)
        return 0;
    size_t length = strlen(whole);
    snprintf(whole + length, sizeof whole - length, "/%s", path);
    return is_below(whole) && fails(WRITES, call, whole);
}

static int file_fails(const char *call, int file)
{
    char name[32], path[PATH_MAX];
    if (counted != WRITES)
        return 0;
    snprintf(name, sizeof name, "/proc/self/fd/%d", file);
    long length = syscall(SYS_readlinkat, AT_FDCWD, name, path, sizeof path - 1);
    if (length < 0)
        return 0;
    path[length] = 0;
    return is_below(path) && fails(WRITES, call, (void *)path);
}

#define NEXT(name) \
    static __typeof__(&name) next; \
    if (!next) \
        next = (__typeof__(&name))dlsym(RTLD_NEXT, #name)

#define ON_FILE(type, name, parameters, file, arguments) \
    type name parameters \
    { \
        NEXT(name); \
        return file_fails(#name, file) ? -1 : next arguments; \
    }

#define ON_PATH(name, parameters, path, arguments) \
    int name parameters \
    { \
        NEXT(name); \
        return path_fails(#name, path) ? -1 : next arguments; \
    }

ON_FILE(ssize_t, write, (int file, const void *bytes, size_t size), file, (file, bytes, size))
ON_FILE(ssize_t, writev, (int file, const struct iovec *parts, int number), file, (file, parts, number))
ON_FILE(ssize_t, pwrite, (int file, const void *bytes, size_t size, off_t from), file, (file, bytes, size, from))
ON_FILE(ssize_t, pwrite64, (int file, const void *bytes, size_t size, off64_t from), file, (file, bytes, size, from))
ON_FILE(ssize_t, copy_file_range, (int in, off64_t *from, int out, off64_t *to, size_t size, unsigned flags), out,
        (in, from, out, to, size, flags))
ON_FILE(int, fsync, (int file), file, (file))
ON_FILE(int, fdatasync, (int file), file, (file))
ON_FILE(int, ftruncate, (int file, off_t size), file, (file, size))
ON_FILE(int, ftruncate64, (int file, off64_t size), file, (file, size))
ON_PATH(rename, (const char *from, const char *to), to, (from, to))
ON_PATH(unlink, (const char *path), path, (path))
ON_PATH(mkdir, (const char *path, mode_t mode), path, (path, mode))

#define ON_OPEN(name) \
    int name(const char *path, int flags, ...) \
    { \
        NEXT(name); \
        va_list rest; \
        va_start(rest, flags); \
        mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg(rest, mode_t) : 0; \
        va_end(rest); \
        int writes = (flags & O_ACCMODE) != O_RDONLY; \
        return writes && path_fails(#name, path) ? -1 : next(path, flags, mode); \
    }

ON_OPEN(open)
ON_OPEN(open64)

/* Memory */

#define NO_MEMORY(size, name) \
    (counted == MEMORY && (size) >= (size_t)least && fails(MEMORY, name, __builtin_return_address(0)))

void *malloc(size_t size)
{
    return NO_MEMORY(size, "malloc") ? NULL : __libc_malloc(size);
}

void *calloc(size_t number, size_t size)
{
    return NO_MEMORY(number * size, "calloc") ? NULL : __libc_calloc(number, size);
}

void *realloc(void *old, size_t size)
{
    return NO_MEMORY(size, "realloc") ? NULL : __libc_realloc(old, size);
}

void *memalign(size_t alignment, size_t size)
{
    return NO_MEMORY(size, "memalign") ? NULL : __libc_memalign(alignment, size);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return NO_MEMORY(size, "aligned_alloc") ? NULL : __libc_memalign(alignment, size);
}

int posix_memalign(void **memory, size_t alignment, size_t size)
{
    if (NO_MEMORY(size, "posix_memalign"))
        return ENOMEM;
    *memory = __libc_memalign(alignment, size);
    return *memory ? 0 : ENOMEM;
}

/* Here, so that the allocation counts as one of its caller, not of the C library. */
char *strdup(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = NO_MEMORY(size, "strdup") ? NULL : __libc_malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

static void *map(void *address, size_t size, int protection, int flags, int file, off64_t from)
{
    if (flags & MAP_ANONYMOUS && NO_MEMORY(size, "mmap"))
        return MAP_FAILED;
    return (void *)syscall(SYS_mmap, address, size, protection, flags, file, from);
}

void *mmap(void *address, size_t size, int protection, int flags, int file, off_t from)
{
    return map(address, size, protection, flags, file, from);
}

void *mmap64(void *address, size_t size, int protection, int flags, int file, off64_t from)
{
    return map(address, size, protection, flags, file, from);
}

/* Threads */

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument)
{
    NEXT(pthread_create);
    return fails(THREADS, "pthread_create", "") ? EAGAIN : next(thread, attributes, start, argument);
}

/* The time of day */

static time_t jump(void)
{
    if (counted != CLOCK)
        return 0;
    const time_t day = 86400, jumps[] = { 0, -day, 365 * day };
    return jumps[__atomic_fetch_add(&count, 1, __ATOMIC_RELAXED) % 3];
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    int result = syscall(SYS_clock_gettime, clock, now);
    if (result == 0 && (clock == CLOCK_REALTIME || clock == CLOCK_REALTIME_COARSE))
        now->tv_sec += jump();
    return result;
}

int gettimeofday(struct timeval *now, void *zone)
{
    (void)zone;
    struct timespec precise;
    int result = clock_gettime(CLOCK_REALTIME, &precise);
    now->tv_sec = precise.tv_sec;
    now->tv_usec = precise.tv_nsec / 1000;
    return result;
}

time_t time(time_t *now)
{
    struct timespec precise;
    clock_gettime(CLOCK_REALTIME, &precise);
    if (now)
        *now = precise.tv_sec;
    return precise.tv_sec;
}

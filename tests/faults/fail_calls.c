/* A library to be preloaded: one call of the program or its libraries fails.
 *
 *   FAIL=CALL:N       the N-th call, from 0; N < 0: none
 *   FAIL_COUNT=FILE   gets, when the program ends, the number of calls, and of the program's own allocations
 * that were not freed
 *
 * CALL: memory (malloc, calloc and realloc: ENOMEM), own (those that the program itself calls), open
 * (EMFILE), read (EIO), write (ENOSPC), fsync (EIO), close (EIO), rename (EACCES) or vulkan (those of
 * pretend_layer.c, where that is loaded). A crash says whose it is: "crash in OBJECT". */
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *memory, size_t size);
void __libc_free(void *memory);

enum call { MEMORY, OWN, OPEN, READ, WRITE, FSYNC, CLOSE, RENAME, VULKAN, CALLS };
static const char *const names[CALLS] = {"memory", "own",   "open",   "read",  "write",
                                         "fsync",  "close", "rename", "vulkan"};

static enum call failing = CALLS;
static long failing_turn = -1;
static atomic_long calls;
static uintptr_t program_start, program_end;

static bool fails(enum call call)
{
    return call == failing && atomic_fetch_add(&calls, 1) == failing_turn;
}

/* The allocations that the program asked for itself. */
enum { SLOTS = 1 << 16 };
static void *_Atomic slots[SLOTS];

static size_t slot_of(const void *memory)
{
    return (size_t)((uintptr_t)memory >> 4) * 0x9E3779B1U % SLOTS;
}

static bool is_program(const void *caller)
{
    return (uintptr_t)caller >= program_start && (uintptr_t)caller < program_end;
}

static bool fails_to_allocate(const void *caller)
{
    return fails(MEMORY) || (is_program(caller) && fails(OWN));
}

static void note(void *memory, const void *caller)
{
    if (!memory || !is_program(caller))
        return;
    for (size_t i = slot_of(memory), tries = 0; tries < 64; i = (i + 1) % SLOTS, ++tries) {
        void *empty = NULL;
        if (atomic_compare_exchange_strong(&slots[i], &empty, memory))
            return;
    }
}

static void forget(void *memory)
{
    for (size_t i = slot_of(memory), tries = 0; memory && tries < 64; i = (i + 1) % SLOTS, ++tries) {
        void *expected = memory;
        if (atomic_compare_exchange_strong(&slots[i], &expected, NULL))
            return;
    }
}

static void *no_memory(void)
{
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size)
{
    const void *caller = __builtin_return_address(0);
    void *memory = fails_to_allocate(caller) ? no_memory() : __libc_malloc(size);
    note(memory, caller);
    return memory;
}

void *calloc(size_t count, size_t size)
{
    const void *caller = __builtin_return_address(0);
    void *memory = fails_to_allocate(caller) ? no_memory() : __libc_calloc(count, size);
    note(memory, caller);
    return memory;
}

void *realloc(void *old, size_t size)
{
    const void *caller = __builtin_return_address(0);
    if (fails_to_allocate(caller))
        return no_memory();
    forget(old);
    void *memory = __libc_realloc(old, size);
    note(memory, caller);
    return memory;
}

void free(void *memory)
{
    forget(memory);
    __libc_free(memory);
}

static int failure(int error)
{
    errno = error;
    return -1;
}

int open(const char *path, int flags, ...)
{
    va_list arguments;
    va_start(arguments, flags);
    const unsigned mode = flags & O_CREAT ? va_arg(arguments, unsigned) : 0;
    va_end(arguments);
    return fails(OPEN) ? failure(EMFILE) : (int)syscall(SYS_openat, AT_FDCWD, path, flags, mode);
}

ssize_t read(int file, void *bytes, size_t size)
{
    return fails(READ) ? failure(EIO) : syscall(SYS_read, file, bytes, size);
}

ssize_t write(int file, const void *bytes, size_t size)
{
    return file != STDERR_FILENO && fails(WRITE) ? failure(ENOSPC) : syscall(SYS_write, file, bytes, size);
}

int fsync(int file)
{
    return fails(FSYNC) ? failure(EIO) : (int)syscall(SYS_fsync, file);
}

int close(int file)
{
    const int result = (int)syscall(SYS_close, file);
    return fails(CLOSE) ? failure(EIO) : result;
}

int rename(const char *old, const char *new)
{
    return fails(RENAME) ? failure(EACCES) : (int)syscall(SYS_renameat2, AT_FDCWD, old, AT_FDCWD, new, 0);
}

/* For the layer. */
bool fails_in_vulkan(void);
bool fails_in_vulkan(void)
{
    return fails(VULKAN);
}

static void tell_crash(int number)
{
    void *frames[64];
    const int count = backtrace(frames, 64);
    const char *owner = "?";
    for (int i = 1; i < count; ++i) {
        Dl_info info;
        if (!dladdr(frames[i], &info) || !info.dli_fname)
            continue;
        const char *slash = strrchr(info.dli_fname, '/');
        owner = slash ? slash + 1 : info.dli_fname;
        if (!strstr(owner, "libc.so") && !strstr(owner, "fail_calls"))
            break;
    }
    dprintf(STDERR_FILENO, "crash in %s\n", owner);
    signal(number, SIG_DFL);
    raise(number);
}

static int find_program(struct dl_phdr_info *info, size_t size, void *unused)
{
    (void)size, (void)unused;
    for (int i = 0; i < info->dlpi_phnum; ++i)
        if (info->dlpi_phdr[i].p_type == PT_LOAD && info->dlpi_phdr[i].p_flags & PF_X) {
            program_start = info->dlpi_addr + info->dlpi_phdr[i].p_vaddr;
            program_end = program_start + info->dlpi_phdr[i].p_memsz;
        }
    return 1; /* the first one is the program */
}

__attribute__((constructor)) static void begin(void)
{
    void *frame[1];
    char name[16] = "";
    long turn = -1;
    const char *plan = getenv("FAIL");
    backtrace(frame, 1); /* loads what it needs */
    dl_iterate_phdr(find_program, NULL);
    for (const int *number = (const int[]){SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, 0}; *number; ++number)
        signal(*number, tell_crash);
    if (!plan || sscanf(plan, "%15[^:]:%ld", name, &turn) != 2)
        return;
    failing_turn = turn;
    for (enum call call = MEMORY; call < CALLS; ++call)
        if (strcmp(name, names[call]) == 0)
            failing = call;
}

__attribute__((destructor)) static void end(void)
{
    const long count = atomic_load(&calls);
    const char *path = getenv("FAIL_COUNT");
    size_t left = 0;
    failing = CALLS;
    for (size_t i = 0; i < SLOTS; ++i)
        left += slots[i] != NULL;
    if (!path)
        return;
    int file = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dprintf(file, "%ld %zu\n", count, left);
}

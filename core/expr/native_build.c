// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // environ, memfd_create
#include "expr/native_build.h"

#include "base/clock.h"
#include "base/file.h"
#include "base/hash.h"
#include "expr/native_emit.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

static const char *const COMPILERS[] = {"gcc", "clang", "tcc"};
// the same bits as the interpreter: no fused multiply-add; sqrt without errno is one instruction
static const char *const FLAGS[] = {"-ffp-contract=off", "-fno-math-errno", "-fno-plt",
                                    "-shared",           "-fPIC",           "-w"};
enum { N_FLAGS = sizeof FLAGS / sizeof *FLAGS, FORMAT = 3 };
// -O2 up to so many bytes of text, -O1 beyond: straight-line code in pieces runs as fast, and gcc
// takes two thirds of the time (3.2 in place of 5 s for the ladder of 200 loops)
enum { LONG_TEXT = 400000 };
// and each further piece of text of this size has a time limit of its own: some 3 s of gcc, which
// shares a busy machine with others
enum { TEXT_OF_A_LIMIT = 1000000 };
enum { MOST_BYTES = 64 << 20 };

/// The record behind the compiler's bytes.
typedef struct footer {
    char magic[8];
    uint64_t key;      // of text and builder
    uint64_t checksum; // of the bytes before
} footer;
static const char MAGIC[8] = "HNTAPE1";

// ---- the compiler ----

/// Finds `name` in the absolute folders of PATH.
static bool find_in_path(const char *name, char out[HN_NATIVE_PATH]) {
    const char *at = getenv("PATH");
    while (at && *at) {
        const size_t n = strcspn(at, ":");
        struct stat info;
        if (*at == '/' &&
            snprintf(out, HN_NATIVE_PATH, "%.*s/%s", (int)n, at, name) < HN_NATIVE_PATH &&
            stat(out, &info) == 0 && S_ISREG(info.st_mode) && access(out, X_OK) == 0) {
            return true;
        }
        at += n + (at[n] == ':');
    }
    return false;
}

static uint64_t add_file(uint64_t hash, const char *path) {
    struct stat info;
    if (stat(path, &info) == 0) {
        const long long marks[] = {(long long)info.st_size, (long long)info.st_mtim.tv_sec,
                                   (long long)info.st_mtim.tv_nsec};
        hash = hn_hash_bytes(hash, marks, sizeof marks);
    }
    return hn_hash_text(hash, path);
}

/// The folder must be ours alone to write, or its files could be anybody's code.
static hn_status check_folder(const char *folder, hn_diag *diag) {
    struct stat info;
    if (mkdir(folder, 0700) != 0 && errno != EEXIST) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot make the folder '%.200s': %s",
                           folder, strerror(errno));
    }
    if (lstat(folder, &info) != 0 || !S_ISDIR(info.st_mode) || info.st_uid != geteuid() ||
        (info.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, "make it a folder of yours with mode 0700",
                           "'%.200s' is not a folder that only this user may write", folder);
    }
    if (access(folder, W_OK) != 0) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot write to the folder '%.200s': %s",
                           folder, strerror(errno));
    }
    return HN_OK;
}

hn_status hn_native_builder_init(hn_native_builder *b, const char *folder, const char *compiler,
                                 double time_limit, hn_diag *diag) {
    *b = (hn_native_builder){.time_limit = time_limit};
    if (snprintf(b->folder, sizeof b->folder, "%s", folder) >= (int)sizeof b->folder) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "the name of the cache folder is too long");
    }
    HN_TRY(check_folder(folder, diag));

    // the first compiler there is
    bool found = false;
    if (compiler) {
        found =
            snprintf(b->compiler, sizeof b->compiler, "%s", compiler) < (int)sizeof b->compiler &&
            access(compiler, X_OK) == 0;
    }
    for (size_t i = 0; !compiler && !found && i < sizeof COMPILERS / sizeof *COMPILERS; i++) {
        found = find_in_path(COMPILERS[i], b->compiler);
    }
    if (!found) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, "install gcc, clang or tcc",
                           "there is no C compiler%s%.100s", compiler ? " at " : "",
                           compiler ? compiler : "");
    }

    uint64_t hash = add_file(HN_HASH_START + FORMAT, b->compiler);
    for (int i = 0; i < N_FLAGS; i++) {
        hash = hn_hash_text(hash, FLAGS[i]);
    }
    b->identity = hn_hash_mix(add_file(hash, "/proc/self/exe"));
    return HN_OK;
}

static double limit_of(const hn_native_builder *b, size_t text) {
    return b->time_limit * (double)(1 + text / TEXT_OF_A_LIMIT);
}

/// In the child, before the compiler: only calls that are safe after fork in a threaded program.
_Noreturn static void become_compiler(double limit, char *const argv[]) {
    const struct rlimit cpu = {(rlim_t)limit + 1, (rlim_t)limit + 2},
                        size = {MOST_BYTES, MOST_BYTES}, core = {0, 0};
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, NULL);
    setpgid(0, 0);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setrlimit(RLIMIT_CPU, &cpu);
    setrlimit(RLIMIT_FSIZE, &size);
    setrlimit(RLIMIT_CORE, &core);
    if (nice(10) == -1) { // background work; an error changes nothing
    }
    const int null = open("/dev/null", O_RDWR);
    dup2(null, STDIN_FILENO);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    execv(argv[0], argv);
    _exit(127);
}

/// Waits for the child, at most until the limit; then it and its children are killed.
static hn_status wait_for(const hn_native_builder *b, pid_t child, double start, double limit,
                          hn_diag *diag) {
    const struct timespec nap = {.tv_nsec = 3000000};
    int state = 0;

    // until it ends, is stopped or is too late
    for (;;) {
        const pid_t got = waitpid(child, &state, WNOHANG);
        if (got == child) {
            break;
        }
        const bool ending = b->ending && atomic_load(b->ending);
        if (ending || got < 0 || hn_clock_wall() - start > limit) {
            kill(-child, SIGKILL);
            kill(child, SIGKILL);
            waitpid(child, &state, 0);
            return hn_diag_set(diag, HN_ERR_STOPPED, NULL, NULL,
                               ending ? "%s was stopped" : "%s was killed after %.3g s",
                               b->compiler, limit);
        }
        nanosleep(&nap, NULL);
    }

    // how it ended
    if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) {
        return hn_diag_set(diag, HN_ERR_UNSUPPORTED, NULL, NULL, "%s failed (%s %d)", b->compiler,
                           WIFEXITED(state) ? "exit status" : "signal",
                           WIFEXITED(state) ? WEXITSTATUS(state) : WTERMSIG(state));
    }
    return HN_OK;
}

static hn_status run_compiler(const hn_native_builder *b, size_t text, const char *source,
                              const char *object, double *seconds, hn_diag *diag) {
    const char *argv[N_FLAGS + 7] = {b->compiler, text > LONG_TEXT ? "-O1" : "-O2"};
    const double limit = limit_of(b, text);
    int n = 2;

    // the command line
    for (int i = 0; i < N_FLAGS; i++) {
        argv[n++] = FLAGS[i];
    }
    argv[n++] = "-o";
    argv[n++] = object;
    argv[n++] = source;

    // a child of its own, waited for
    const double start = hn_clock_wall();
    const pid_t child = fork();
    if (child < 0) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "no process for %s: %s", b->compiler,
                           strerror(errno));
    }
    if (child == 0) {
        become_compiler(limit, (char *const *)argv);
    }
    const hn_status status = wait_for(b, child, start, limit, diag);
    *seconds = hn_clock_wall() - start;
    return status;
}

// ---- the folder ----

static uint64_t key_of(const hn_native_builder *b, const char *text, size_t n) {
    return hn_hash_mix(hn_hash_bytes(b->identity, text, n));
}

static void path_of(const hn_native_builder *b, uint64_t key, const char *suffix,
                    char out[2 * HN_NATIVE_PATH]) {
    char hex[17];
    hn_hash_hex(key, hex);
    snprintf(out, 2 * HN_NATIVE_PATH, "%s/%s%s", b->folder, hex, suffix);
}

/// The bytes of an open file if they are what hn_native_build() put there, else NULL; free them.
static char *read_sound(int fd, uint64_t key, size_t *n) {
    // a regular file of this user that nobody else may write
    struct stat info;
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode) || info.st_uid != geteuid() ||
        (info.st_mode & (S_IWGRP | S_IWOTH)) != 0 || info.st_size <= (off_t)sizeof(footer) ||
        info.st_size > MOST_BYTES) {
        return NULL;
    }

    // its footer must fit the key and the bytes before it
    *n = (size_t)info.st_size;
    char *bytes = malloc(*n);
    footer f = {0};
    bool sound = bytes && pread(fd, bytes, *n, 0) == (ssize_t)*n;
    if (sound) {
        memcpy(&f, bytes + *n - sizeof f, sizeof f);
        sound = memcmp(f.magic, MAGIC, sizeof MAGIC) == 0 && f.key == key &&
                f.checksum == hn_hash_bytes(HN_HASH_START, bytes, *n - sizeof f);
    }

    if (!sound) {
        free(bytes);
        return NULL;
    }
    return bytes;
}

/// Opens a copy in memory of the file at `path`, if it is sound; -1: it is not, or memory is out.
/// The file may change from now on: the program runs what has been checked.
static int open_checked(const char *path, uint64_t key) {
    const int fd = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        return -1;
    }
    size_t n = 0;
    char *bytes = read_sound(fd, key, &n);
    close(fd);
    int copy = bytes ? memfd_create("holonom-tape", MFD_CLOEXEC) : -1;
    if (copy >= 0 && write(copy, bytes, n) != (ssize_t)n) {
        close(copy);
        copy = -1;
    }
    free(bytes);
    return copy;
}

/// A name for an open file that no other call gives: the dynamic linker takes a name it knows for
/// the library it has. A running number stands in it in binary, "/" for 0 and "/./" for 1.
static void unique_name(int fd, char out[160]) {
    static atomic_uint calls;
    unsigned bits = atomic_fetch_add(&calls, 1);
    char middle[100] = "";
    for (size_t n = 0; bits > 0; bits /= 2) {
        n += (size_t)snprintf(middle + n, sizeof middle - n, bits % 2 ? "/." : "/");
    }
    snprintf(out, 160, "/proc/self%s/fd/%d", middle, fd);
}

hn_status hn_native_load(const hn_native_builder *b, const char *text, size_t n, void **handle,
                         hn_native_code *code) {
    char path[2 * HN_NATIVE_PATH], open_file[160];
    const uint64_t key = key_of(b, text, n);
    path_of(b, key, ".so", path);
    const int fd = open_checked(path, key);
    if (fd < 0) {
        return HN_ERR_IO;
    }

    // by a name of its own: a path loaded before would give the old code
    unique_name(fd, open_file);
    *handle = dlopen(open_file, RTLD_NOW | RTLD_LOCAL);
    close(fd);
    void *symbol = *handle ? dlsym(*handle, HN_NATIVE_SYMBOL) : NULL;
    if (!symbol) {
        if (*handle) {
            dlclose(*handle);
        }
        return HN_ERR_IO;
    }
    memcpy(code, &symbol, sizeof symbol);
    return HN_OK;
}

/// Adds the footer to what the compiler made and gives it its final name, as a whole.
static hn_status publish(const char *object, const char *path, uint64_t key, hn_diag *diag) {
    hn_strbuf bytes;
    hn_strbuf_init(&bytes);
    hn_status status = hn_file_read(object, MOST_BYTES - sizeof(footer), &bytes, diag);
    if (status == HN_OK) {
        footer f = {.key = key, .checksum = hn_hash_bytes(HN_HASH_START, bytes.text, bytes.n)};
        memcpy(f.magic, MAGIC, sizeof MAGIC);
        hn_strbuf_add_n(&bytes, (const char *)&f, sizeof f);
        // what stands under the name is not to be taken, or there is nothing: a link is not
        // followed
        unlink(path);
        status = bytes.failed ? HN_ERR_MEMORY : hn_file_write(path, bytes.text, bytes.n, diag);
        if (status == HN_OK && chmod(path, 0600) != 0) {
            status = hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot protect '%.200s': %s", path,
                                 strerror(errno));
        }
    }
    hn_strbuf_reset(&bytes);
    return status;
}

hn_status hn_native_build(const hn_native_builder *b, const char *text, size_t n, double *seconds,
                          hn_diag *diag) {
    char source[2 * HN_NATIVE_PATH], object[2 * HN_NATIVE_PATH], path[2 * HN_NATIVE_PATH];
    char suffix[64];
    const uint64_t key = key_of(b, text, n);
    *seconds = 0;

    // names of this process: another one may be at the same text
    snprintf(suffix, sizeof suffix, ".%ld.c", (long)getpid());
    path_of(b, key, suffix, source);
    snprintf(suffix, sizeof suffix, ".%ld.o", (long)getpid());
    path_of(b, key, suffix, object);
    path_of(b, key, ".so", path);

    hn_status status = hn_file_write(source, text, n, diag);
    HN_THEN(status, run_compiler(b, n, source, object, seconds, diag));
    HN_THEN(status, publish(object, path, key, diag));
    unlink(source);
    unlink(object);
    return status;
}

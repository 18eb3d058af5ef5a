// SPDX-License-Identifier: GPL-3.0-or-later
#include "program/sandbox.h"

#include "program/guest_process.h"

#include <errno.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// ---- words of a command line ----

static void add(hn_sandbox_command *c, const char *word) {
    HN_ASSERT(c->n + 1 < HN_SANDBOX_WORDS);
    c->argv[c->n++] = (char *)word;
    c->argv[c->n] = NULL;
}

static void add_all(hn_sandbox_command *c, const char *const *words) {
    for (; *words; words++) {
        add(c, *words);
    }
}

static void HN_PRINTF(2, 3) add_format(hn_sandbox_command *c, const char *format, ...) {
    char *const at = c->text + c->used;
    va_list args;
    va_start(args, format);
    const int n = vsnprintf(at, (size_t)(HN_SANDBOX_TEXT - c->used), format, args);
    va_end(args);
    HN_ASSERT(n >= 0 && c->used + n + 1 < HN_SANDBOX_TEXT);
    c->used += n + 1;
    add(c, at);
}

// ---- the sandbox ----

/// In order: later mounts lie over earlier ones.
static const char *const BUBBLEWRAP[] = {
    "/usr/bin/bwrap", "--unshare-all", "--unshare-user", "--disable-userns", "--die-with-parent",
    "--new-session", "--cap-drop", "ALL", "--hostname", "sandbox", "--clearenv", "--setenv", "PATH",
    "/usr/local/bin:/usr/bin:/bin", "--setenv", "LANG", "C.UTF-8", "--setenv", "HOME", "/tmp",
    // one thread is enough for matrices of this size, and threads count as processes
    "--setenv", "OMP_NUM_THREADS", "1", "--setenv", "OPENBLAS_NUM_THREADS", "1", "--setenv",
    "JAVA_TOOL_OPTIONS",
    "-Xmx256m -XX:+UseSerialGC -XX:TieredStopAtLevel=1 -XX:-UsePerfData -Xlog:disable", "--ro-bind",
    "/usr", "/usr", "--ro-bind-try", "/bin", "/bin", "--ro-bind-try", "/lib", "/lib",
    "--ro-bind-try", "/lib64", "/lib64", "--ro-bind-try", "/etc/alternatives", "/etc/alternatives",
    "--ro-bind-try", "/etc/ld.so.cache", "/etc/ld.so.cache", "--ro-bind-try",
    "/etc/java-17-openjdk", "/etc/java-17-openjdk", "--ro-bind-try", "/etc/java-21-openjdk",
    "/etc/java-21-openjdk", "--proc", "/proc", "--dev", "/dev", NULL};
/// Places that the program cannot write to are not only protected, they are read-only.
static const char *const CLOSED[] = {"--size", "1048576",      "--tmpfs", "/dev/shm",     "--chdir",
                                     "/tmp",   "--remount-ro", "/dev",    "--remount-ro", "/",
                                     NULL};

/// The kernel counts no processes of root, so root becomes nobody first.
static const char *const NOBODY[] = {"/usr/bin/setpriv", "--reuid", "65534", "--regid", "65534",
                                     "--clear-groups",   "--",      NULL};

static void add_sandbox(hn_sandbox_command *c, const char *name, const hn_program_limits *limits) {
    if (geteuid() == 0) {
        add_all(c, NOBODY);
    }
    add_all(c, BUBBLEWRAP);
    add(c, "--size");
    add_format(c, "%lld", limits->files);
    add(c, "--tmpfs");
    add(c, "/tmp");
    if (name) {
        // a copy of the open file: its folder may be closed to everybody else
        add(c, "--perms");
        add(c, "0755");
        add(c, "--ro-bind-data");
        add_format(c, "%d", HN_GUEST_FILE);
        add_format(c, "/program/%s", name);
    }
    add_all(c, CLOSED);
    add(c, "--");
}

/// Limits that the kernel keeps. Trusted programs share their count of processes with everything of
/// this user, so theirs is not limited.
static void add_limits(hn_sandbox_command *c, bool trusted, const hn_program_limits *limits) {
    add(c, "/usr/bin/prlimit");
    add_format(c, "--cpu=%.0f:%.0f", limits->cpu, limits->cpu + 1);
    add_format(c, "--data=%lld", limits->memory);
    add_format(c, "--fsize=%lld", limits->files);
    add(c, "--core=0");
    add(c, "--nofile=128");
    if (!trusted) {
        add_format(c, "--nproc=%d", limits->processes);
    }
    add(c, "--");
}

// ---- the program ----

static const struct {
    const char *ending, *words[4];
    bool is_compiler; ///< it leaves a program in /tmp, which must be the sandbox's own
} INTERPRETERS[] = {
    {".py", {"python3", "-B", "-u", NULL}, false},
    {".js", {"node", "--max-old-space-size=256", NULL}, false},
    {".m", {"octave-cli", "-q", "--no-history", NULL}, false},
    {".java", {"java", NULL}, false},
    {".jl", {"julia", NULL}, false},
    {".c",
     {"sh", "-c", "gcc -O1 -w -pipe -o /tmp/run \"$0\" -lm && exec /tmp/run \"$@\"", NULL},
     true},
    {".cpp",
     {"sh", "-c", "g++ -O1 -w -pipe -o /tmp/run \"$0\" && exec /tmp/run \"$@\"", NULL},
     true},
};

static bool ends_in(const char *text, const char *ending) {
    const size_t n = strlen(text), m = strlen(ending);
    return n > m && strcmp(text + n - m, ending) == 0;
}

static const char *const *find_interpreter(const char *file, bool trusted) {
    for (size_t i = 0; i < sizeof INTERPRETERS / sizeof *INTERPRETERS; i++) {
        if (ends_in(file, INTERPRETERS[i].ending) && !(trusted && INTERPRETERS[i].is_compiler)) {
            return INTERPRETERS[i].words;
        }
    }
    return NULL;
}

/// A trusted program's interpreter is looked up in PATH; the sandbox has /usr/bin alone.
static hn_status check_file(const char *file, bool trusted, hn_diag *diag) {
    struct stat info;
    if (stat(file, &info) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "there is no program '%.200s': %s", file,
                           strerror(errno));
    }
    if (!S_ISREG(info.st_mode)) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, "name the file that is to be started",
                           "'%.200s' is not a file", file);
    }
    if (!find_interpreter(file, trusted) && access(file, X_OK) != 0) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL,
                           trusted
                               ? "end its name in .py, .js, .m, .java or .jl, or make it executable"
                               : "end its name in .py, .js, .m, .java, .jl, .c or .cpp, or make it "
                                 "executable",
                           "'%.200s' cannot be started", file);
    }
    return HN_OK;
}

bool hn_sandbox_can_start(const char *file, bool trusted) {
    return check_file(file, trusted, NULL) == HN_OK;
}

hn_status hn_sandbox_build(hn_sandbox_command *c, const char *file, const char *argument,
                           bool trusted, const hn_program_limits *limits, hn_diag *diag) {
    enum { MOST_PATH = 1000 };
    char whole[MOST_PATH + 1];
    *c = (hn_sandbox_command){0};
    HN_TRY(check_file(file, trusted, diag));
    char *path = realpath(file, NULL);
    const bool fits = path && strlen(path) <= MOST_PATH;
    snprintf(whole, sizeof whole, "%s", fits ? path : "");
    free(path);
    if (!fits) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "the path of '%.100s' is too long",
                           file);
    }

    // the sandbox, the limits, the interpreter, the file
    const char *const name = strrchr(whole, '/') ? strrchr(whole, '/') + 1 : whole;
    if (!trusted) {
        HN_TRY(hn_sandbox_check(diag));
        add_sandbox(c, name, limits);
        snprintf(c->file, sizeof c->file, "%s", whole);
    }
    add_limits(c, trusted, limits);
    const char *const *interpreter = find_interpreter(file, trusted);
    if (interpreter) {
        add_all(c, interpreter);
    }
    add_format(c, "%s%s", trusted ? "" : "/program/", trusted ? whole : name);
    if (argument) {
        add(c, argument);
    }
    return HN_OK;
}

// ---- whether it works here ----

static pthread_once_t tried = PTHREAD_ONCE_INIT;
static hn_diag trouble; // set once

static void try_sandbox(void) {
    hn_sandbox_command c = {0};
    hn_program_limits limits = hn_program_limits_default();
    hn_guest_process process;
    char said[200];

    // the program that makes the sandbox
    if (access(BUBBLEWRAP[0], X_OK) != 0) {
        hn_diag_set(&trouble, HN_ERR_UNSUPPORTED, NULL,
                    "install the package bubblewrap; --trust-programs runs a program of your own "
                    "without a sandbox",
                    "untrusted programs run in a sandbox, and %s is not installed", BUBBLEWRAP[0]);
        return;
    }

    // a command that does nothing, inside
    add_sandbox(&c, NULL, &limits);
    add_limits(&c, false, &limits);
    add(&c, "true");
    hn_status status = hn_guest_process_start(&process, c.argv, NULL, &limits, &trouble);
    if (status != HN_OK) {
        return;
    }
    const int ended = hn_guest_process_wait(&process, limits.start);
    snprintf(said, sizeof said, "%.199s", hn_guest_process_errors(&process));
    hn_guest_process_end(&process);

    if (ended != 0) {
        said[strcspn(said, "\n")] = '\0';
        hn_diag_set(&trouble, HN_ERR_UNSUPPORTED, NULL,
                    "allow user namespaces (sysctl kernel.unprivileged_userns_clone=1); "
                    "--trust-programs runs a program of your own without a sandbox",
                    "untrusted programs run in a sandbox, and it cannot be set up here: %.150s",
                    said[0] ? said : "bubblewrap ended without a word");
    }
}

hn_status hn_sandbox_check(hn_diag *diag) {
    pthread_once(&tried, try_sandbox);
    if (trouble.status != HN_OK && diag) {
        *diag = trouble;
    }
    return trouble.status;
}

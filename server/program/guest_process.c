// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE // pipe2
#include "program/guest_process.h"

#include "base/clock.h"
#include "program/crash_words.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

extern char **environ;

// [ms] between two looks at the memory; [s] to end after its input has ended
enum { LOOK = 50 };
static const double FAREWELL = 0.5;

// ---- the start ----

static void close_pair(int pair[2]) {
    for (int i = 0; i < 2; i++) {
        if (pair[i] >= 0) {
            close(pair[i]);
        }
    }
}

static int spawn(hn_guest_process *p, char *const *argv, int in[2], int out[2], int err[2],
                 int file) {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    sigset_t none, defaults;
    sigemptyset(&none);
    sigfillset(&defaults);
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_adddup2(&actions, in[0], 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    if (file >= 0) {
        posix_spawn_file_actions_adddup2(&actions, file, HN_GUEST_FILE);
    }

    // a group of its own, to be killed as one; signals as a shell would start it
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK |
                                              POSIX_SPAWN_SETSIGDEF);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &defaults);
    const int failed = posix_spawnp(&p->pid, argv[0], &actions, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return failed;
}

/// Opens a file above the descriptors that the process is given; -1: none, or errno.
static int open_file(const char *name) {
    enum { ABOVE = 10 };
    const int low = name ? open(name, O_RDONLY | O_CLOEXEC | O_NOCTTY | O_NONBLOCK) : -1;
    const int fd = low >= 0 ? fcntl(low, F_DUPFD_CLOEXEC, ABOVE) : -1;
    if (low >= 0) {
        close(low);
    }
    return fd;
}

static const char *base_name(const char *path) {
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/// The program of a command line without a sandbox, or its argument.
static const char *last_word(char *const *argv) {
    const char *word = "";
    for (; *argv; argv++) {
        word = base_name(*argv);
    }
    return word;
}

hn_status hn_guest_process_start(hn_guest_process *p, char *const *argv, const char *file,
                                 const hn_program_limits *limits, hn_diag *diag) {
    int in[2] = {-1, -1}, out[2] = {-1, -1}, err[2] = {-1, -1};
    *p = (hn_guest_process){
        .in = -1, .out = -1, .err = -1, .limits = *limits, .confined = file != NULL};
    snprintf(p->file, sizeof p->file, "%s", file ? base_name(file) : last_word(argv));
    hn_strbuf_init(&p->pending);
    int failed = pipe2(in, O_CLOEXEC) || pipe2(out, O_CLOEXEC) || pipe2(err, O_CLOEXEC) ? errno : 0;
    const int fd = failed ? -1 : open_file(file);
    if (!failed) {
        failed = file && fd < 0 ? errno : spawn(p, argv, in, out, err, fd);
    }
    if (fd >= 0) {
        close(fd);
    }
    if (failed) {
        close_pair(in);
        close_pair(out);
        close_pair(err);
        p->pid = 0;
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "'%.100s' cannot be started: %s", argv[0],
                           strerror(failed));
    }

    // this side of the pipes never blocks
    close(in[0]);
    close(out[1]);
    close(err[1]);
    p->in = in[1];
    p->out = out[0];
    p->err = err[0];
    fcntl(p->in, F_SETFL, O_NONBLOCK);
    fcntl(p->out, F_SETFL, O_NONBLOCK);
    fcntl(p->err, F_SETFL, O_NONBLOCK);
    return HN_OK;
}

// ---- what it uses ----

enum { MOST_PROCESSES = 512 }; ///< of one look: far above what any limit allows

typedef struct use {
    long long bytes;
    double cpu; ///< [s]
    int processes;
    long seen[MOST_PROCESSES]; ///< their numbers
} use;

/// Returns whether a process is looked at for the first time. One whose parent ends during the look
/// is found twice: below its parent, and below the first process, which takes it over.
static bool note(use *sum, long pid) {
    for (int i = 0; i < sum->processes; i++) {
        if (sum->seen[i] == pid) {
            return false;
        }
    }
    if (sum->processes == MOST_PROCESSES) {
        return false;
    }
    sum->seen[sum->processes++] = pid;
    return true;
}

/// The computing time of a process and of its children that have ended [s]: fields 14 to 17 of its
/// stat, counted behind the name in brackets.
static double cpu_of(long pid) {
    char path[64], text[1024];
    snprintf(path, sizeof path, "/proc/%ld/stat", pid);
    FILE *file = fopen(path, "re");
    const size_t n = file ? fread(text, 1, sizeof text - 1, file) : 0;
    if (file) {
        fclose(file);
    }
    text[n] = '\0';
    const char *behind = strrchr(text, ')');
    long ticks[4] = {0};
    if (!behind ||
        sscanf(behind + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %ld %ld %ld %ld",
               &ticks[0], &ticks[1], &ticks[2], &ticks[3]) != 4) {
        return 0;
    }
    return (double)(ticks[0] + ticks[1] + ticks[2] + ticks[3]) / (double)sysconf(_SC_CLK_TCK);
}

/// Adds a process and everything that it started.
static void add_use(use *sum, long pid, int depth) {
    enum { MOST_DEPTH = 40 };
    char path[64], word[32];

    // memory and time of its own
    snprintf(path, sizeof path, "/proc/%ld/statm", pid);
    FILE *file = fopen(path, "re");
    long long whole, resident;
    if (file) {
        if (fscanf(file, "%lld %lld", &whole, &resident) == 2 && note(sum, pid)) {
            sum->bytes += resident * sysconf(_SC_PAGESIZE);
            sum->cpu += cpu_of(pid);
        }
        fclose(file);
    }

    // its children; a process may have ended meanwhile
    snprintf(path, sizeof path, "/proc/%ld/task/%ld/children", pid, pid);
    file = depth < MOST_DEPTH ? fopen(path, "re") : NULL;
    while (file && fscanf(file, "%31s", word) == 1) {
        add_use(sum, strtol(word, NULL, 10), depth + 1);
    }
    if (file) {
        fclose(file);
    }
}

static hn_status check_use(hn_guest_process *p, hn_diag *diag) {
    use sum = {0};
    add_use(&sum, p->pid, 0);
    p->peak = sum.bytes > p->peak ? sum.bytes : p->peak;
    p->cpu = sum.cpu > p->cpu ? sum.cpu : p->cpu;
    if (sum.cpu > p->limits.cpu) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it used up its %g s of computing time",
                           p->limits.cpu);
    }
    if (sum.bytes > p->limits.memory) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it holds more than %lld MB of memory",
                           p->limits.memory >> 20);
    }
    // two processes are bubblewrap's
    if (sum.processes > p->limits.processes + 2) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it runs %d processes; %d are allowed",
                           sum.processes - 2, p->limits.processes);
    }
    return HN_OK;
}

static double read_clocks(const hn_guest_process *p) {
    double sum = 0;
    for (int i = 0; i < p->n_clocks; i++) {
        struct timespec t = {0};
        if (clock_gettime(p->clocks[i], &t) == 0) {
            sum += (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
        }
    }
    return sum;
}

double hn_guest_process_clock_start(hn_guest_process *p) {
    const double now = hn_clock_wall();
    if (p->pid > 0 && (p->n_clocks == 0 || now - p->found > 1e-3 * LOOK)) {
        use sum = {0};
        add_use(&sum, p->pid, 0);
        p->n_clocks = 0;
        for (int i = 0; i < sum.processes && p->n_clocks < HN_GUEST_CLOCKS; i++) {
            p->n_clocks += clock_getcpuclockid((pid_t)sum.seen[i], &p->clocks[p->n_clocks]) == 0;
        }
        p->found = now;
    }
    return read_clocks(p);
}

// one that has ended takes its time with it
double hn_guest_process_clock_stop(const hn_guest_process *p, double begin) {
    return fmax(0, read_clocks(p) - begin);
}

// ---- reading and writing ----

static void read_errors(hn_guest_process *p) {
    char piece[4096];
    ssize_t n;
    while ((n = read(p->err, piece, sizeof piece)) > 0) {
        const int room = p->limits.stderr_kept - 1 - p->n_errors;
        const int kept = n < room ? (int)n : room;
        if (kept > 0) {
            memcpy(p->errors + p->n_errors, piece, (size_t)kept);
            p->n_errors += kept;
        }
    }
}

/// Reads what is there; false: its output has ended.
static bool read_output(hn_guest_process *p) {
    char piece[16384];
    for (;;) {
        const ssize_t n = read(p->out, piece, sizeof piece);
        if (n > 0) {
            hn_strbuf_add_n(&p->pending, piece, (size_t)n);
            // no more than one answer and a bit is kept: the pipe holds the rest back
            if ((long long)p->pending.n > p->limits.line) {
                return true;
            }
            continue;
        }
        return n < 0 && (errno == EAGAIN || errno == EINTR);
    }
}

static hn_status say_end(hn_guest_process *p, hn_diag *diag) {
    const int ended = hn_guest_process_wait(p, FAREWELL);

    // what it wrote to standard error
    char last[320];
    hn_crash_words(hn_guest_process_errors(p), p->file, p->confined, &p->limits, last);

    // a limit that it reached, a signal, or an end of its own
    if (ended == 128 + SIGXCPU || (ended == 128 + SIGKILL && p->cpu >= 0.9 * p->limits.cpu)) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it used up its %g s of computing time",
                           p->limits.cpu);
    }
    if (ended == 128 + SIGXFSZ) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it wrote a file of more than %lld MB",
                           p->limits.files >> 20);
    }
    if (ended > 128) {
        return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "it was ended by signal %d (%s)%s%s",
                           ended - 128, strsignal(ended - 128), last[0] ? ": " : "", last);
    }
    return ended >= 0 ? hn_diag_set(diag, HN_ERR_IO, NULL, NULL,
                                    "it ended with exit status %d instead of an answer%s%s", ended,
                                    last[0] ? ": " : "", last)
                      : hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "it closed its output");
}

/// It may hang because of a limit that it has reached.
static hn_status say_late(hn_guest_process *p, double seconds, hn_diag *diag) {
    char last[320];
    hn_crash_words(hn_guest_process_errors(p), p->file, p->confined, &p->limits, last);
    const bool is_limit = strstr(last, " are allowed") != NULL;
    return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "it did not answer within %g s%s%s", seconds,
                       is_limit ? "; it had written: " : "", is_limit ? last : "");
}

/// Moves the first line of what is pending to `line`; false: there is no whole one.
static bool take_line(hn_guest_process *p, hn_strbuf *line) {
    const char *text = hn_strbuf_text(&p->pending);
    const char *end = p->pending.n > 0 ? memchr(text, '\n', p->pending.n) : NULL;
    if (!end) {
        return false;
    }
    const size_t n = (size_t)(end - text);
    hn_strbuf rest;
    hn_strbuf_init(&rest);
    hn_strbuf_clear(line);
    hn_strbuf_add_n(line, text, n);
    hn_strbuf_add_n(&rest, end + 1, p->pending.n - n - 1);
    hn_strbuf_reset(&p->pending);
    p->pending = rest;
    return true;
}

/// write() without a SIGPIPE where the reader has gone.
static ssize_t write_quietly(int fd, const char *text, size_t n) {
    sigset_t broken, before;
    sigemptyset(&broken);
    sigaddset(&broken, SIGPIPE);
    pthread_sigmask(SIG_BLOCK, &broken, &before);
    const ssize_t wrote = write(fd, text, n);
    const int cause = errno;
    if (wrote < 0 && cause == EPIPE && !sigismember(&before, SIGPIPE)) {
        sigtimedwait(&broken, NULL, &(struct timespec){0});
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    errno = cause;
    return wrote;
}

/// Writes on; *sent grows. A process that does not read is found out by the clock.
static void write_some(hn_guest_process *p, const char *text, size_t n, size_t *sent) {
    const ssize_t wrote = *sent < n ? write_quietly(p->in, text + *sent, n - *sent) : 0;
    if (wrote > 0) {
        *sent += (size_t)wrote;
    } else if (wrote < 0 && errno == EPIPE) {
        *sent = n; // it reads no more: its end is told when its output ends
    }
}

hn_status hn_guest_process_ask(hn_guest_process *p, const char *text, size_t n, double seconds,
                               hn_strbuf *line, hn_diag *diag) {
    const double start = hn_clock_wall();
    double looked = start;
    size_t sent = 0;
    for (;;) {
        // write, read, and an answer is there
        write_some(p, text, n, &sent);
        const bool open = read_output(p);
        read_errors(p);
        if (take_line(p, line)) {
            return HN_OK;
        }
        if (!open) {
            return say_end(p, diag);
        }
        if ((long long)p->pending.n > p->limits.line) {
            return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL,
                               "it wrote more than %lld bytes without an end of line",
                               p->limits.line);
        }

        // limits, at most twenty times a second
        const double now = hn_clock_wall();
        if (now - start > seconds) {
            return say_late(p, seconds, diag);
        }
        if (now - looked > 1e-3 * LOOK) {
            HN_TRY(check_use(p, diag));
            looked = now;
        }
        struct pollfd wait[] = {{.fd = p->out, .events = POLLIN},
                                {.fd = p->err, .events = POLLIN},
                                {.fd = sent < n ? p->in : -1, .events = POLLOUT}};
        poll(wait, 3, LOOK);
    }
}

bool hn_guest_process_has_more(hn_guest_process *p) {
    read_output(p);
    return p->pending.n > 0;
}

// ---- the end ----

int hn_guest_process_wait(hn_guest_process *p, double seconds) {
    const double start = hn_clock_wall();
    const struct timespec nap = {.tv_nsec = 2000000};
    while (p->pid > 0) {
        int state = 0;
        read_errors(p);
        read_output(p);
        if (waitpid(p->pid, &state, WNOHANG) == p->pid) {
            kill(-p->pid, SIGKILL); // what it left behind in its group
            p->pid = 0;
            read_errors(p);
            return WIFEXITED(state) ? WEXITSTATUS(state) : 128 + WTERMSIG(state);
        }
        if (hn_clock_wall() - start > seconds) {
            return -1;
        }
        nanosleep(&nap, NULL);
    }
    return -1;
}

const char *hn_guest_process_errors(hn_guest_process *p) {
    for (int i = 0; i < p->n_errors; i++) {
        const unsigned char c = (unsigned char)p->errors[i];
        p->errors[i] = c == '\n' || (c >= 32 && c < 127) ? (char)c : '?';
    }
    p->errors[p->n_errors] = '\0';
    return p->errors;
}

static void close_one(int *fd) {
    if (*fd >= 0) {
        close(*fd);
        *fd = -1;
    }
}

void hn_guest_process_end(hn_guest_process *p) {
    // what it has used until now; its end takes that with it
    hn_diag ignored;
    if (p->pid > 0 && check_use(p, &ignored) != HN_OK) {
        kill(-p->pid, SIGKILL);
    }
    close_one(&p->in);
    if (p->pid > 0 && hn_guest_process_wait(p, FAREWELL) < 0 && p->pid > 0) {
        kill(-p->pid, SIGKILL);
        kill(p->pid, SIGKILL);
        hn_guest_process_wait(p, 10);
    }
    close_one(&p->out);
    close_one(&p->err);
    hn_strbuf_reset(&p->pending);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/store/journal.h"

#include "base/hash.h"
#include "session/store/stored_json.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// A process that was killed may hold its lock until the kernel has taken it down, and so may a
// child between its fork and its exec: [attempts] of 20 ms each, 2 s in all.
enum { LOCK_ATTEMPTS = 100, LOCK_PAUSE = 20000000 };

/// Passes complete lines to `take`; returns the number of bytes of the accepted lines.
static size_t take_lines(char *text, hn_journal_take take, void *user) {
    size_t used = 0;
    for (char *end; (end = strchr(text + used, '\n')) != NULL;) {
        *end = 0;
        cJSON *line = cJSON_Parse(text + used);
        const int taken = line && take(user, line);
        cJSON_Delete(line);
        if (!taken) {
            break;
        }
        used = (size_t)(end - text) + 1;
    }
    return used;
}

/// Adds size and time of the program's file to the key, so that another build has another key.
static uint64_t add_program(uint64_t key) {
    struct stat program;
    if (stat("/proc/self/exe", &program) == 0) {
        const long long marks[] = {(long long)program.st_size, (long long)program.st_mtim.tv_sec,
                                   (long long)program.st_mtim.tv_nsec};
        key = hn_hash_bytes(key, marks, sizeof marks);
    }
    return hn_hash_mix(key);
}

/// Takes the lock of an open file. Returns false while another program keeps it.
static bool take_lock(int fd) {
    const struct timespec pause = {.tv_nsec = LOCK_PAUSE};
    for (int i = 0; i < LOCK_ATTEMPTS; i++) {
        if (flock(fd, LOCK_EX | LOCK_NB) == 0) {
            return true;
        }
        nanosleep(&pause, NULL);
    }
    return false;
}

/// Opens the file, a regular one of this user's: nothing that stands in its place is followed or
/// waited for. Returns why not, NULL when it is open. No program that this one starts, such as a
/// compiler, inherits the file and its lock (O_CLOEXEC).
static const char *open_own(hn_journal *j) {
    struct stat st;
    const int fd =
        open(j->path, O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0600);
    if (fd < 0) {
        return errno == ELOOP ? "it is a link" : strerror(errno);
    }
    const char *why = fstat(fd, &st) != 0              ? strerror(errno)
                      : !S_ISREG(st.st_mode)           ? "it is not a regular file"
                      : st.st_uid != geteuid()         ? "it belongs to somebody else"
                      : !(j->file = fdopen(fd, "a+b")) ? strerror(errno)
                                                       : NULL;
    if (why) {
        close(fd);
    }
    return why;
}

static hn_status open_file(hn_journal *j, hn_diags *diags) {
    const char *why = open_own(j);
    if (why) {
        return hn_diags_add(diags, HN_ERR_IO, NULL, NULL,
                            "cannot keep unfinished work in '%.200s': %s", j->path, why);
    }
    if (!take_lock(fileno(j->file))) {
        hn_journal_end(j, 0);
        return hn_diags_add(diags, HN_ERR_IO, NULL, "wait until it ends, or ask for another study",
                            "another program is doing the same work");
    }
    return HN_OK;
}

hn_status hn_journal_open(hn_journal *j, const char *folder, const char *kind, uint64_t key,
                          hn_journal_take take, void *user, hn_diags *diags) {
    char hex[17];
    size_t n = 0;
    *j = (hn_journal){0};

    // name the file after the kind and the key; too long a path means no journal
    hn_hash_hex(add_program(key), hex);
    if (snprintf(j->path, sizeof j->path, "%s/%s-%s.ndjson", folder, kind, hex) >=
        (int)sizeof j->path) {
        j->path[0] = 0;
        return HN_OK;
    }

    // another process may hold the lock on the file
    const hn_status status = open_file(j, diags);
    if (status != HN_OK) {
        j->path[0] = 0;
        return status;
    }

    // resume from the lines of an earlier run
    char *text = hn_stored_text_of(j->file, &n);
    const size_t used = text ? take_lines(text, take, user) : 0;
    free(text);
    // drop what was not accepted, so that new lines follow the last accepted one
    j->failed = ftruncate(fileno(j->file), (off_t)used) != 0;
    return HN_OK;
}

void hn_journal_write(hn_journal *j, hn_strbuf *line) {
    hn_json_end_object(line);
    hn_strbuf_add(line, "\n");
    if (j->file && !j->failed) {
        j->failed = line->failed || fwrite(hn_strbuf_text(line), 1, line->n, j->file) != line->n ||
                    fflush(j->file) != 0;
    }
    hn_strbuf_reset(line);
}

void hn_journal_end(hn_journal *j, int whole) {
    if (whole && j->path[0]) {
        remove(j->path);
        j->path[0] = 0;
    }
    if (j->file) {
        fclose(j->file);
        j->file = NULL;
    }
}

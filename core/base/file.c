// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/file.h"

#include "base/bundle.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PIECE = 1 << 14, MOST_NAMES = 100 };

// ---- reading ----

static hn_status unreadable(const char *path, const char *why, hn_diag *diag) {
    return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot read '%.200s': %s", path, why);
}

/// Returns what `mode` is, in words for a message.
static const char *kind_of(mode_t mode) {
    return S_ISDIR(mode)    ? "it is a folder"
           : S_ISFIFO(mode) ? "it is a pipe, not a regular file"
                            : "it is not a regular file";
}

/// Why a path could not be opened, in words for a message. A link where none may be followed gets
/// ELOOP too.
static const char *why_not_open(const char *path, int error, bool own) {
    struct stat info;
    const bool is_link = lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
    return error == ENOENT && is_link ? "it is a link to a file that is not there"
           : error == ELOOP && own    ? "it is a link"
           : error == ELOOP           ? "it is a link that leads back to itself"
                                      : strerror(error);
}

/// Adds the bytes of an open file to `text`, at most `most` + 1 of them. Returns 0 or an errno.
static int add_bytes(int fd, size_t most, hn_strbuf *text) {
    char piece[PIECE];
    size_t left = most + 1;
    while (left > 0) {
        const ssize_t n = read(fd, piece, left < sizeof piece ? left : sizeof piece);
        if (n < 0 && errno == EINTR) {
            continue;
        }
        if (n <= 0) {
            return n < 0 ? errno : 0;
        }
        hn_strbuf_add_n(text, piece, (size_t)n);
        left -= (size_t)n;
    }
    return 0;
}

/// A file inside the program.
static hn_status read_bundled(const char *path, size_t most, hn_strbuf *text, hn_diag *diag) {
    size_t n = 0;
    const void *bytes = hn_bundle_find(path, &n);
    if (!bytes) {
        return unreadable(path, strerror(ENOENT), diag);
    }
    if (n > most) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "'%.200s' has more than %zu bytes", path,
                           most);
    }
    hn_strbuf_add_n(text, bytes, n);
    return text->failed
               ? hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to read '%.200s'", path)
               : HN_OK;
}

/// Reads a file on the disk; `own`: of this user's, and no link.
static hn_status read_disk(const char *path, size_t most, bool own, hn_strbuf *text,
                           hn_diag *diag) {
    struct stat info;

    // without O_NONBLOCK, opening a FIFO would wait for somebody to write to it
    const int fd =
        open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY | (own ? O_NOFOLLOW : 0));
    if (fd < 0) {
        return unreadable(path, why_not_open(path, errno, own), diag);
    }
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
        close(fd);
        return unreadable(path, kind_of(info.st_mode), diag);
    }
    if (own && info.st_uid != geteuid()) {
        close(fd);
        return unreadable(path, "it belongs to somebody else", diag);
    }

    const size_t before = text->n;
    const int error = add_bytes(fd, most, text);
    close(fd);
    if (error != 0) {
        return unreadable(path, strerror(error), diag);
    }
    if (text->failed) {
        return hn_diag_set(diag, HN_ERR_MEMORY, NULL, NULL, "no memory to read '%.200s'", path);
    }
    if (text->n - before > most) {
        return hn_diag_set(diag, HN_ERR_LIMIT, NULL, NULL, "'%.200s' has more than %zu bytes", path,
                           most);
    }
    return HN_OK;
}

hn_status hn_file_read(const char *path, size_t most, hn_strbuf *text, hn_diag *diag) {
    HN_ASSERT(path && text);
    return hn_bundle_is_path(path) ? read_bundled(path, most, text, diag)
                                   : read_disk(path, most, false, text, diag);
}

hn_status hn_file_read_own(const char *path, size_t most, hn_strbuf *text, hn_diag *diag) {
    HN_ASSERT(path && text);
    return read_disk(path, most, true, text, diag);
}

size_t hn_file_begin(const char *path, char *bytes, size_t n) {
    HN_ASSERT(path && bytes);
    hn_strbuf text;
    hn_strbuf_init(&text);
    // one that has more bytes is no fault here
    const hn_status status = read_disk(path, n, false, &text, NULL);
    const size_t found = status == HN_OK || status == HN_ERR_LIMIT ? (text.n < n ? text.n : n) : 0;
    if (found > 0) {
        memcpy(bytes, hn_strbuf_text(&text), found);
    }
    hn_strbuf_reset(&text);
    return found;
}

hn_status hn_file_load(const char *path, size_t most, hn_strbuf *text, hn_diags *diags) {
    hn_diag diag;
    const hn_status status = hn_file_read(path, most, text, &diag);
    return status == HN_OK ? HN_OK : hn_diags_add(diags, status, NULL, NULL, "%s", diag.message);
}

hn_status hn_file_read_stdin(size_t most, hn_strbuf *text, hn_diags *diags) {
    HN_ASSERT(text);
    const size_t before = text->n;
    const int error = add_bytes(STDIN_FILENO, most, text);
    if (error != 0) {
        return hn_diags_add(diags, HN_ERR_IO, NULL, NULL, "cannot read standard input: %s",
                            strerror(error));
    }
    if (text->failed) {
        return hn_diags_add(diags, HN_ERR_MEMORY, NULL, NULL, "no memory to read standard input");
    }
    if (text->n - before > most) {
        return hn_diags_add(diags, HN_ERR_LIMIT, NULL, NULL,
                            "standard input has more than %zu bytes", most);
    }
    return HN_OK;
}

// ---- writing ----

/// Writes all bytes, closes the file. Returns 0 or an errno.
static int put_bytes(int fd, const char *bytes, size_t n, bool sync) {
    int error = 0;
    while (n > 0 && error == 0) {
        const ssize_t wrote = write(fd, bytes, n);
        if (wrote < 0) {
            error = errno == EINTR ? 0 : errno;
        } else {
            bytes += wrote;
            n -= (size_t)wrote;
        }
    }
    if (error == 0 && sync && fsync(fd) != 0) {
        error = errno;
    }
    if (close(fd) != 0 && error == 0) {
        error = errno;
    }
    return error;
}

/// Opens a new file of a unique name beside `target`. Returns its descriptor, or -1 with errno.
static int open_beside(const char *target, hn_strbuf *name) {
    int fd = -1;
    for (int i = 0; i < MOST_NAMES && fd < 0; i++) {
        hn_strbuf_clear(name);
        hn_strbuf_printf(name, "%s.%ld-%d", target, (long)getpid(), i);
        if (name->failed) {
            errno = ENOMEM;
            return -1;
        }
        fd = open(hn_strbuf_text(name), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
        if (fd < 0 && errno != EEXIST) {
            return -1;
        }
    }
    return fd;
}

/// Replaces `target`, or makes it; `old` is what stands there (NULL: nothing). Returns 0 or an
/// errno.
static int replace(const char *target, const struct stat *old, const void *bytes, size_t n,
                   bool sync) {
    hn_strbuf name;
    hn_strbuf_init(&name);
    const int fd = open_beside(target, &name);
    int error = fd < 0 ? errno : 0;
    if (fd >= 0) {
        if (old && fchmod(fd, old->st_mode & 07777) != 0) {
            error = errno;
        }
        const int put = put_bytes(fd, bytes, n, sync);
        error = error ? error : put;
        if (error == 0 && rename(hn_strbuf_text(&name), target) != 0) {
            error = errno;
        }
        if (error != 0) {
            unlink(hn_strbuf_text(&name));
        }
    }
    hn_strbuf_reset(&name);
    return error;
}

/// Writes straight into what is no regular file: a device, a pipe, a socket. Returns 0 or an errno.
static int put_directly(const char *path, const void *bytes, size_t n) {
    // a FIFO that nobody reads is refused (ENXIO) instead of waited for
    const int fd = open(path, O_WRONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) {
        return errno;
    }
    if (fcntl(fd, F_SETFL, fcntl(fd, F_GETFL) & ~O_NONBLOCK) != 0) {
        const int error = errno;
        close(fd);
        return error;
    }
    return put_bytes(fd, bytes, n, false);
}

static int write_bytes(const char *path, const void *bytes, size_t n) {
    struct stat link, target;
    const bool is_there = lstat(path, &link) == 0;
    if (!is_there) {
        return errno == ENOENT ? replace(path, NULL, bytes, n, true) : errno;
    }
    if (stat(path, &target) != 0) {
        return errno; // a link that leads nowhere: ENOENT, or ELOOP
    }
    if (!S_ISREG(target.st_mode)) {
        return S_ISDIR(target.st_mode) ? EISDIR : put_directly(path, bytes, n);
    }
    if (!S_ISLNK(link.st_mode)) {
        return replace(path, &target, bytes, n, true);
    }

    // the file that the link means is replaced, not the link
    char *real = realpath(path, NULL);
    const int error = real ? replace(real, &target, bytes, n, true) : errno;
    free(real);
    return error;
}

static hn_status tell_written(const char *path, int error, hn_diag *diag) {
    return error == 0 ? HN_OK
                      : hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot write '%.200s': %s", path,
                                    error == ENXIO ? "it is a pipe that no program reads"
                                                   : strerror(error));
}

hn_status hn_file_write(const char *path, const void *bytes, size_t n, hn_diag *diag) {
    HN_ASSERT(path && (bytes || n == 0));
    return tell_written(path, write_bytes(path, bytes, n), diag);
}

hn_status hn_file_keep(const char *path, const void *bytes, size_t n, hn_diag *diag) {
    HN_ASSERT(path && (bytes || n == 0));
    return tell_written(path, replace(path, NULL, bytes, n, false), diag);
}

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_BASE_FILE_H
#define HN_BASE_FILE_H
// Files read and written whole. Reading never blocks and never takes more than it was told to;
// writing leaves either the old file or the new one, never a part of it.

#include "base/diag.h"
#include "base/strbuf.h"

#include <stddef.h>

/// Reads the regular file at `path` and adds its bytes to `text` (zero-terminated, as always).
///
/// A folder, a FIFO, a device or a socket is refused without waiting for it; a link is followed.
/// Fails: HN_ERR_IO (missing, not readable, not a regular file), HN_ERR_LIMIT (more than `most`
/// bytes), HN_ERR_MEMORY. `diag` (may be NULL) names the path; `text` then holds no usable bytes.
HN_MUST_CHECK hn_status hn_file_read(const char *path, size_t most, hn_strbuf *text, hn_diag *diag);

/// The same of a file that this program has kept for itself: a link, and a file that belongs to
/// another user, are refused too (HN_ERR_IO).
HN_MUST_CHECK hn_status hn_file_read_own(const char *path, size_t most, hn_strbuf *text,
                                         hn_diag *diag);

/// The same, with the fault added to a list (may be NULL).
HN_MUST_CHECK hn_status hn_file_load(const char *path, size_t most, hn_strbuf *text,
                                     hn_diags *diags);

/// Reads at most n bytes from the start of a regular file on the disk. Returns how many there are;
/// 0 where it cannot be read, or is a folder, a FIFO, a device or a socket.
size_t hn_file_begin(const char *path, char *bytes, size_t n);

/// Reads standard input to its end, waiting for it; at most `most` bytes. Fails like
/// hn_file_load().
HN_MUST_CHECK hn_status hn_file_read_stdin(size_t most, hn_strbuf *text, hn_diags *diags);

/// Writes n bytes to the file at `path`.
///
/// A new or a regular file is replaced as a whole: the bytes go to a file of a unique name in the
/// same folder, to the disk (fsync), and are renamed; an existing file keeps its permissions. On
/// failure the old file is as it was and nothing is left beside it. A link is followed; one that
/// leads nowhere is refused. A device, a FIFO with a reader or a socket takes the bytes directly.
/// Fails: HN_ERR_IO; `diag` (may be NULL) names the path and the reason.
HN_MUST_CHECK hn_status hn_file_write(const char *path, const void *bytes, size_t n, hn_diag *diag);
/// Writes a file that this program keeps for itself and can compute again. Anything in its
/// place is replaced, a link itself and not what it leads to; nobody waits for the disk: a program
/// that is killed loses nothing, a machine that loses its power may leave a file that is cut.
HN_MUST_CHECK hn_status hn_file_keep(const char *path, const void *bytes, size_t n, hn_diag *diag);
#endif

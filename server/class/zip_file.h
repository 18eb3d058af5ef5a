// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_ZIP_FILE_H
#define HN_CLASS_ZIP_FILE_H
// Zip archives, read in memory: what a class hands in. Nothing is unpacked to disk, and no entry
// may
// become larger than the caller allows, whatever the archive says about itself.

#include "base/diag.h"
#include "base/strbuf.h"

#include <stdint.h>

enum { HN_ZIP_NAME = 256, HN_ZIP_MOST = 4096 };

typedef struct hn_zip_entry {
    char name[HN_ZIP_NAME]; ///< with its folders
    uint32_t packed, size, offset;
    int method; ///< 0 stored, 8 deflated
} hn_zip_entry;

/// Lists the files of an archive (n bytes); folders are left out, as are entries beyond
/// HN_ZIP_MOST.
/// *out is owned by the caller. Fails: HN_ERR_INPUT for what is no archive.
HN_MUST_CHECK hn_status hn_zip_list(const char *bytes, size_t n, hn_zip_entry **out, int *n_entries,
                                    hn_diag *diag);
/// Adds the contents of an entry to `text`. Fails: HN_ERR_INPUT (broken, encrypted, a method that
/// is
/// not read), HN_ERR_LIMIT (more than `most` bytes).
HN_MUST_CHECK hn_status hn_zip_read(const char *bytes, size_t n, const hn_zip_entry *entry,
                                    size_t most, hn_strbuf *text, hn_diag *diag);

#endif

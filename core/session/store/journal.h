// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_JOURNAL_H
#define HN_SESSION_JOURNAL_H
// The journal of unfinished work: a file with one JSON object per line, one line for each finished
// piece. After a crash the program reads the file up to its last complete line and appends there,
// so it loses at most the piece that was under way. A lock admits one program at a time.

#include "base/diag.h"
#include "base/strbuf.h"

#include <cjson/cJSON.h>
#include <stdint.h>
#include <stdio.h>

typedef struct hn_journal {
    FILE *file;     ///< NULL: nothing is kept
    char path[512]; ///< "" while there is none
    int failed;     ///< 1: a line could not be written; no more are
} hn_journal;

/// Takes one line. Returns 0 when the line does not fit the work; this line and all later ones are
/// then dropped, and their pieces computed again.
typedef int (*hn_journal_take)(void *user, const cJSON *line);

/// Opens FOLDER/KIND-HASH.ndjson, creates it if needed, and passes its complete lines to `take` in
/// order.
/// key  hash of everything that determines the pieces. The program's own file is added to it, so
/// that another build does not continue this journal.
/// A path that is too long turns the journal off: nothing is kept, and HN_OK is returned.
/// Fails, reported in diags, with the journal closed: HN_ERR_IO when the file cannot be written, is
/// a link, no regular file or somebody else's, or when another program has held it for two seconds.
HN_MUST_CHECK hn_status hn_journal_open(hn_journal *journal, const char *folder, const char *kind,
                                        uint64_t key, hn_journal_take take, void *user,
                                        hn_diags *diags);
/// Ends the object in `line`, appends it to the file and resets `line`. Writes nothing without a
/// file or after a failure.
void hn_journal_write(hn_journal *journal, hn_strbuf *line);
/// Closes the journal. whole = 1: the work is complete, and the file is deleted, even if the
/// journal was closed before. whole = 0: the file stays. A second call is harmless.
void hn_journal_end(hn_journal *journal, int whole);

#endif

// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SESSION_JOURNAL_H
#define HN_SESSION_JOURNAL_H
// The journal of unfinished work: a file of lines, a JSON object for each piece that is done. It is
// read up to its last whole line and written on behind that, so a program that is killed at any
// moment loses the piece it was at and no more. One program at a time has it.

#include "base/diag.h"
#include "base/strbuf.h"

#include <cjson/cJSON.h>
#include <stdint.h>
#include <stdio.h>

typedef struct hn_journal {
    FILE *file;     ///< NULL: nothing is kept
    char path[512]; ///< "" while there is none
    int failed;     ///< a line could not be written: nothing more is
} hn_journal;

/// One line; 0 when it does not fit the work: it and all that follows is dropped, and done again.
typedef int (*hn_journal_take)(void *user, const cJSON *line);

/// Opens FOLDER/KIND-HASH.ndjson, made where it is missing, and hands its whole lines to `take` in
/// order. `key`: hash of all that decides what the pieces are, but for the program: what another
/// build of it has done is not gone on with. Where the path would be too long nothing is kept.
/// Fails: HN_ERR_IO, told in diags: it cannot be written, or another program has it; the journal is
/// then closed.
HN_MUST_CHECK hn_status hn_journal_open(hn_journal *journal, const char *folder, const char *kind,
                                        uint64_t key, hn_journal_take take, void *user,
                                        hn_diags *diags);
/// Ends the object in `line` and puts it behind the others; `line` is reset. Without a file, or
/// after a failure, nothing is written.
void hn_journal_write(hn_journal *journal, hn_strbuf *line);
/// Closes it. Of a whole work the file is removed, a closed one's too; else what is in it stays.
/// May be called again.
void hn_journal_end(hn_journal *journal, int whole);

#endif

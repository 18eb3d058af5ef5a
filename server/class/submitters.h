// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLASS_SUBMITTERS_H
#define HN_CLASS_SUBMITTERS_H
// Whose the folders of a Gradescope export are: its submission_metadata.yml names the submitters.
//
//   submission_4711:
//     :submitters:
//     - :name: Ada Lovelace
//       :sid: '1815'
//       :email: ada@example.org
//     :created_at: ...
//
// The mail address names the student, as in the autograder's bundle (deploy/bundle.py): it chooses
// the same variant. Of a group it is that of the first member. Without an address the name does.

#include "base/diag.h"
#include "base/strbuf.h"

#include <stdbool.h>

enum { HN_SUBMITTER_NAME = 80 };

typedef struct hn_submitter {
    char entry[HN_SUBMITTER_NAME]; ///< name of a folder or file of the export
    char student[HN_SUBMITTER_NAME];
    bool has_mail;
} hn_submitter;

typedef struct hn_submitters {
    int n, cap;
    hn_submitter *list;
} hn_submitters;

/// Reads the file of a folder; none where there is no such file. Lines in another form are passed
/// over. Fails as hn_file_read(). hn_submitters_reset()
/// in any case.
HN_MUST_CHECK hn_status hn_submitters_read(hn_submitters *s, const char *folder, hn_diag *diag);
/// Returns the student of a folder or file of the export, NULL: it is not listed.
const char *hn_submitters_find(const hn_submitters *s, const char *entry);
void hn_submitters_reset(hn_submitters *s);

#endif

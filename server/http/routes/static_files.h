// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_HTTP_STATIC_FILES_H
#define HN_HTTP_STATIC_FILES_H
// The files of the page. They are listed once, at start; an address is looked up in that list and
// never becomes a path.

#include "http/request/request.h"

#include <stdbool.h>

typedef struct hn_static_files hn_static_files;

/// Lists `folder` (node_modules, names that begin with a dot, package*.json and symbolic links are
/// left out). HN_ERR_IO when it cannot be read, HN_ERR_LIMIT with too many files.
HN_MUST_CHECK hn_status hn_static_files_create(const char *folder, hn_static_files **out,
                                               hn_diag *diag);
void hn_static_files_free(hn_static_files *files); ///< NULL is legal
/// The content security policy of the page: nothing inline but the import maps that the page holds.
const char *hn_static_files_policy(const hn_static_files *files);
/// Answers with the file of that address ("/" is index.html): 200, 304, or 0 when there is none (no
/// reply is made then).
int hn_static_files_reply(hn_static_files *files, hn_request *r, const char *address);
/// Returns whether there is a file of that address.
bool hn_static_files_has(hn_static_files *files, const char *address);
/// An address of the list near to this one, or NULL.
const char *hn_static_files_nearest(const hn_static_files *files, const char *address);
#endif

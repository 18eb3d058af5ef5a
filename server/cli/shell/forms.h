// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_FORMS_H
#define HN_CLI_FORMS_H
// What a piece of work can be written as: a file whose name ends in a form's suffix (--out), JSON
// or CSV on standard output (--json, --csv), or text for people.

#include "cli/shell/args.h"

enum { HN_FORMS = 6 };

typedef struct hn_forms {
    struct {
        const char *suffix; ///< ".html"; NULL behind the last
        void (*put)(hn_strbuf *b, const void *work);
    } form[HN_FORMS];
    void (*text)(hn_strbuf *b, const void *work);
} hn_forms;

/// Defines put_NAME(b, work), a writer of `type` as a form.
#define HN_FORM(name, type, writer)                          \
    static void put_##name(hn_strbuf *b, const void *work) { \
        writer(b, (const type *)work);                       \
    }

/// Faults of --out, --json and --csv, told before anything is computed. HN_ERR_INPUT.
HN_MUST_CHECK hn_status hn_forms_check(const hn_forms *forms, const hn_args *args, hn_diags *diags);
/// Where these options say; into the file first, so that a broken pipe does not cost it.
hn_exit hn_forms_write(const hn_forms *forms, const hn_args *args, const void *work);
/// Returns 1 when the path ends in the suffix, in small or capital letters, and has a name before it.
int hn_path_ends_in(const char *path, const char *suffix);
#endif

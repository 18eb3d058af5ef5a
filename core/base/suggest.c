// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/suggest.h"

#include <stdio.h>
#include <string.h>

const char *hn_suggest(char hint[HN_DIAG_HINT], const char *word, const char *const *names, int n,
                       const char *otherwise) {
    const char *near = hn_nearest_name(word, names, n);
    if (near) {
        (void)snprintf(hint, HN_DIAG_HINT, "did you mean '%.80s'?", near);
    } else {
        (void)snprintf(hint, HN_DIAG_HINT, "%s", otherwise ? otherwise : "");
    }
    return hint;
}

const char *hn_suggest_or_list(char hint[HN_DIAG_HINT], const char *word, const char *const *names,
                               int n, const char *before) {
    if (hn_nearest_name(word, names, n)) {
        return hn_suggest(hint, word, names, n, NULL);
    }
    (void)snprintf(hint, HN_DIAG_HINT, "%s", before);
    for (int i = 0; i < n; i++) {
        const size_t used = strlen(hint);
        (void)snprintf(hint + used, HN_DIAG_HINT - used, "%s%s", i ? ", " : "", names[i]);
    }
    return hint;
}

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/word_list.h"

#include <stdio.h>
#include <string.h>

const char *hn_word_joint(int i, int n, const char *last) {
    if (i == 0) {
        return "";
    }
    return i + 1 == n ? last : ", ";
}

void hn_word_list(hn_strbuf *b, const char *const *words, int n, const char *last) {
    for (int i = 0; i < n; i++) {
        hn_strbuf_add(b, hn_word_joint(i, n, last));
        hn_strbuf_add(b, words[i]);
    }
}

bool hn_word_next(const char **list, char *out, size_t size) {
    const char *word = *list + strspn(*list, " ");
    const size_t n = strcspn(word, " ");
    if (n == 0) {
        return false;
    }
    (void)snprintf(out, size, "%.*s", (int)n, word);
    *list = word + n;
    return true;
}

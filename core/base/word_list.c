// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/word_list.h"

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

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/strbuf.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { FIRST_CAP = 128 };

void hn_strbuf_init(hn_strbuf *b) {
    memset(b, 0, sizeof *b);
}

void hn_strbuf_reset(hn_strbuf *b) {
    free(b->text);
    hn_strbuf_init(b);
}

void hn_strbuf_clear(hn_strbuf *b) {
    char *text = b->text;
    const size_t cap = b->cap;
    hn_strbuf_init(b);
    b->text = text;
    b->cap = cap;
    if (text != NULL) {
        text[0] = '\0';
    }
}

char *hn_strbuf_take(hn_strbuf *b) {
    if (b->text == NULL) {
        hn_strbuf_add_n(b, "", 0);
    }
    if (b->failed) {
        hn_strbuf_reset(b);
        return NULL;
    }
    char *text = b->text;
    hn_strbuf_init(b);
    return text;
}

const char *hn_strbuf_text(const hn_strbuf *b) {
    return b->text != NULL ? b->text : "";
}

/// Room for `more` bytes and the zero; 0 (and the flag) when memory is out.
static bool reserve(hn_strbuf *b, size_t more) {
    if (b->failed) {
        return false;
    }
    if (b->text != NULL && more < b->cap - b->n) {
        return true;
    }

    // sizes that would overflow count as out of memory
    if (more > SIZE_MAX / 4 || b->n > SIZE_MAX / 4) {
        b->failed = 1;
        return false;
    }
    size_t cap = b->cap > 0 ? 2 * b->cap : FIRST_CAP;
    if (cap < b->n + more + 1) {
        cap = b->n + more + 1;
    }

    char *text = realloc(b->text, cap);
    if (text == NULL) {
        b->failed = 1;
        return false;
    }
    b->text = text;
    b->cap = cap;
    return true;
}

void hn_strbuf_add_n(hn_strbuf *b, const char *bytes, size_t n) {
    if (!reserve(b, n)) {
        return;
    }
    if (n > 0) {
        memcpy(b->text + b->n, bytes, n);
    }
    b->n += n;
    b->text[b->n] = '\0';
}

void hn_strbuf_add(hn_strbuf *b, const char *text) {
    hn_strbuf_add_n(b, text, strlen(text));
}

void hn_strbuf_printf(hn_strbuf *b, const char *format, ...) {
    va_list args;
    va_start(args, format);
    va_list again;
    va_copy(again, args);
    const int n = vsnprintf(NULL, 0, format, args);
    va_end(args);
    HN_ASSERT(n >= 0);
    if (reserve(b, (size_t)n)) {
        vsnprintf(b->text + b->n, (size_t)n + 1, format, again);
        b->n += (size_t)n;
    }
    va_end(again);
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON half of strbuf.h: where commas go, how numbers and texts are written.
#include "base/strbuf.h"

#include "base/diag.h"
#include "base/shortest.h"

#include <math.h>
#include <string.h>

enum { MAX_DEPTH = 63 };

/// The comma before a value, unless it is the first one or follows its key.
static void begin_value(hn_strbuf *b) {
    const uint64_t bit = 1ull << b->depth;
    if (b->after_key) {
        b->after_key = 0;
    } else if (b->has_item & bit) {
        hn_strbuf_add_n(b, ",", 1);
    }
    b->has_item |= bit;
}

static void open_nest(hn_strbuf *b, const char *bracket) {
    HN_ASSERT(b->depth < MAX_DEPTH);
    begin_value(b);
    hn_strbuf_add(b, bracket);
    b->depth++;
    b->has_item &= ~(1ull << b->depth);
}

static void close_nest(hn_strbuf *b, const char *bracket) {
    HN_ASSERT(b->depth > 0 && !b->after_key);
    b->depth--;
    hn_strbuf_add(b, bracket);
}

void hn_json_object(hn_strbuf *b) {
    open_nest(b, "{");
}

void hn_json_end_object(hn_strbuf *b) {
    close_nest(b, "}");
}

void hn_json_array(hn_strbuf *b) {
    open_nest(b, "[");
}

void hn_json_end_array(hn_strbuf *b) {
    close_nest(b, "]");
}

/// Length of the well-formed UTF-8 sequence at s, 0 if there is none (RFC 3629, section 4: no
/// overlong forms, no surrogates, nothing above U+10FFFF).
static size_t utf8_length(const unsigned char *s) {
    const unsigned char lead = s[0];
    if (lead < 0x80) {
        return 1;
    }
    const size_t n = lead >= 0xc2 && lead <= 0xdf   ? 2
                     : (lead & 0xf0) == 0xe0        ? 3
                     : lead >= 0xf0 && lead <= 0xf4 ? 4
                                                    : 0;
    for (size_t i = 1; i < n; i++) {
        if ((s[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const int overlong = (lead == 0xe0 && s[1] < 0xa0) || (lead == 0xf0 && s[1] < 0x90);
    const int outside = (lead == 0xed && s[1] > 0x9f) || (lead == 0xf4 && s[1] > 0x8f);
    return overlong || outside ? 0 : n;
}

static void write_escape(hn_strbuf *b, unsigned char c) {
    static const char from[] = "\"\\\b\f\n\r\t", to[] = "\"\\bfnrt";
    const char *found = strchr(from, c);
    if (found != NULL) {
        const char pair[2] = {'\\', to[found - from]};
        hn_strbuf_add_n(b, pair, 2);
    } else {
        hn_strbuf_printf(b, "\\u%04x", (unsigned)c);
    }
}

static void write_text(hn_strbuf *b, const char *text) {
    const unsigned char *s = (const unsigned char *)text;
    hn_strbuf_add_n(b, "\"", 1);
    while (*s != '\0') {
        const size_t n = utf8_length(s);
        if (n == 0) {
            hn_strbuf_add(b, "\xef\xbf\xbd");
            s++;
        } else if (*s < 0x20 || *s == '"' || *s == '\\') {
            write_escape(b, *s++);
        } else {
            hn_strbuf_add_n(b, (const char *)s, n);
            s += n;
        }
    }
    hn_strbuf_add_n(b, "\"", 1);
}

void hn_json_key(hn_strbuf *b, const char *key) {
    HN_ASSERT(b->depth > 0 && !b->after_key);
    begin_value(b);
    write_text(b, key);
    hn_strbuf_add_n(b, ":", 1);
    b->after_key = 1;
}

void hn_json_number(hn_strbuf *b, double value) {
    if (!isfinite(value)) {
        hn_json_null(b);
        return;
    }
    begin_value(b);

    // the fewest digits that read back to the same double
    char text[HN_SHORTEST_TEXT];
    const int n = hn_shortest_write(value, text);
    hn_strbuf_add_n(b, text, (size_t)n);
}

void hn_json_int(hn_strbuf *b, long long value) {
    begin_value(b);
    hn_strbuf_printf(b, "%lld", value);
}

void hn_json_bool(hn_strbuf *b, int value) {
    hn_json_raw(b, value ? "true" : "false");
}

void hn_json_null(hn_strbuf *b) {
    hn_json_raw(b, "null");
}

void hn_json_string(hn_strbuf *b, const char *text) {
    if (text == NULL) {
        hn_json_null(b);
        return;
    }
    begin_value(b);
    write_text(b, text);
}

void hn_json_raw(hn_strbuf *b, const char *json) {
    begin_value(b);
    hn_strbuf_add(b, json);
}

void hn_json_numbers(hn_strbuf *b, const double *values, size_t n) {
    hn_json_array(b);
    for (size_t i = 0; i < n; i++) {
        hn_json_number(b, values[i]);
    }
    hn_json_end_array(b);
}

void hn_json_strings(hn_strbuf *b, const char *const *values, size_t n) {
    hn_json_array(b);
    for (size_t i = 0; i < n; i++) {
        hn_json_string(b, values[i]);
    }
    hn_json_end_array(b);
}

void hn_json_put_number(hn_strbuf *b, const char *key, double value) {
    hn_json_key(b, key);
    hn_json_number(b, value);
}

void hn_json_put_int(hn_strbuf *b, const char *key, long long value) {
    hn_json_key(b, key);
    hn_json_int(b, value);
}

void hn_json_put_bool(hn_strbuf *b, const char *key, int value) {
    hn_json_key(b, key);
    hn_json_bool(b, value);
}

void hn_json_put_string(hn_strbuf *b, const char *key, const char *text) {
    hn_json_key(b, key);
    hn_json_string(b, text);
}

void hn_json_put_numbers(hn_strbuf *b, const char *key, const double *values, size_t n) {
    hn_json_key(b, key);
    hn_json_numbers(b, values, n);
}

static void put_diag(hn_strbuf *b, const struct hn_diag *d) {
    hn_json_object(b);
    hn_json_put_string(b, "status", hn_status_name(d->status));
    hn_json_put_string(b, "pointer", d->pointer);
    hn_json_put_string(b, "detail", d->message);
    hn_json_put_string(b, "hint", d->hint);
    if (d->column > 0) {
        hn_json_put_int(b, "column", d->column);
    }
    hn_json_end_object(b);
}

void hn_json_diags(hn_strbuf *b, const struct hn_diags *d) {
    hn_json_array(b);
    for (int i = 0; i < d->n; i++) {
        put_diag(b, &d->item[i]);
    }
    hn_json_end_array(b);
}
